// The element <ipos-plant> in Chromium: in a page of a folder, with its files inside and without a network; and of a server, with
// the files beside the page. Run where playwright-core is.
//   node element.mjs PACKAGE PROJECT
import assert from "node:assert/strict";
import { copyFileSync, cpSync, mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { extname, join } from "node:path";
import { pathToFileURL } from "node:url";

const [folder, project] = process.argv.slice(2);
const { launch } = await import(pathToFileURL(join(process.cwd(), "test/browser.mjs")));
const work = mkdtempSync(join(tmpdir(), "ipos-element-"));
for (const name of ["hoist.toml", "HOIST.IPC"]) copyFileSync(join(project, "examples/hoist", name), join(work, name));
const files = Object.fromEntries(["hoist.toml", "HOIST.IPC"].map((name) => [name, readFileSync(join(work, name), "utf8")]));
cpSync(folder, join(work, "ipos-wasm"), { recursive: true });
const element = (inside, more = "") => `<ipos-plant src="hoist.toml" signals="hoist.torque" ${more}>${inside}</ipos-plant>`;
const json = `<script type="application/json">${JSON.stringify(files).replaceAll("<", "\\u003c")}</script>`;
writeFileSync(join(work, "alone.html"), `<!doctype html><script src="ipos-wasm/ipos-plant.js"></script>${element(json)}`);
writeFileSync(join(work, "served.html"), `<!doctype html><script type="module" src="ipos-wasm/element.js"></script>${element("", "run")}`);
writeFileSync(join(work, "wrong.html"), `<!doctype html><script type="module" src="ipos-wasm/element.js"></script><ipos-plant src="none.toml"></ipos-plant>`);

const types = { ".html": "text/html", ".js": "text/javascript", ".wasm": "application/wasm" };
const server = createServer((asked, answer) => {
  try {
    const path = join(work, new URL(asked.url, "http://x").pathname);
    answer.setHeader("content-type", types[extname(path)] ?? "text/plain");
    answer.end(readFileSync(path));
  } catch {
    answer.statusCode = 404;
    answer.end();
  }
});
await new Promise((done) => server.listen(0, "127.0.0.1", done));
const browser = await launch();
try {
  const context = await browser.newContext();
  const page = await context.newPage();
  const errors = [];
  page.on("pageerror", (error) => errors.push(String(error)));
  const time = () => page.locator("ipos-plant output").textContent();

  await context.setOffline(true);
  await page.goto(pathToFileURL(join(work, "alone.html")).href);
  await page.waitForFunction(() => document.querySelector("ipos-plant").plant !== undefined);
  assert.equal(await time(), "0.00 s");
  await page.getByRole("button", { name: "Step 10 ms" }).click();
  await page.getByRole("button", { name: "Step 10 ms" }).click();
  assert.equal(await time(), "0.02 s");
  const spokes = () => page.locator("ipos-plant svg g").getAttribute("transform");
  const before = await spokes();
  await page.getByRole("button", { name: "Run" }).click();
  await page.waitForFunction(() => document.querySelector("ipos-plant").plant.time > 700);
  await page.getByRole("button", { name: "Pause" }).click();
  assert.notEqual(await spokes(), before);
  const stands = await time();
  await page.waitForTimeout(100);
  assert.equal(await time(), stands);
  const shown = await page.locator("ipos-plant dl").textContent();
  for (const word of ["hoist", "speed", "rpm", "position", "torque"]) assert.ok(shown.includes(word), shown);
  await page.getByRole("button", { name: "Restart" }).click();
  await page.waitForFunction(() => document.querySelector("ipos-plant").plant.time === 0);

  await context.setOffline(false);
  const address = `http://127.0.0.1:${server.address().port}`;
  await page.goto(`${address}/served.html`);
  await page.waitForFunction(() => document.querySelector("ipos-plant").plant?.time > 200);
  await page.goto(`${address}/wrong.html`);
  await page.getByRole("alert").waitFor();
  assert.match(await page.getByRole("alert").textContent(), /none\.toml: 404/);
  assert.deepEqual(errors, []);
  console.log("the element runs, pauses, steps and restarts");
} finally {
  await browser.close();
  server.close();
}
