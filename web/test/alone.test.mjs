// The page without a server: ipos.html from a file and with the network off, its files, its links, and the site.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";

import { address, built, microseconds, moves, opened, options } from "./alone.mjs";
import { launch } from "./browser.mjs";
import { examples, program } from "./serve.mjs";

const most_bytes = 2_500_000;

let browser;
before(async () => {
  if (!options.skip) browser = await launch();
});
after(() => browser?.close());

function nativeHash(us, plant = join(examples, "hoist/hoist.toml")) {
  const { stderr } = spawnSync(program, ["run", plant, "--for", `${us}us`, "--trace-hash"], { encoding: "utf8" });
  return /trace hash ([0-9a-f]{16})/.exec(stderr)?.[1];
}

test("the file is small enough, opens without any request, and the hoist moves", options, async () => {
  assert.ok(readFileSync(join(built, "ipos.html")).length <= most_bytes);
  const began = Date.now();
  const { page, told, context } = await opened(browser);
  await page.getByRole("switch", { name: "hoist DI10" }).waitFor();
  console.log(`# first plant on screen: ${Date.now() - began} ms`);
  await moves(page);
  assert.match(await page.title(), /hoist\.toml/);
  assert.deepEqual(
    told.requests.filter((url) => !url.startsWith("blob:")),
    [address()],
  );
  assert.deepEqual(told.errors, []);
  await context.close();
});

test("its hash is that of the native program at the same time", options, async () => {
  const { page, context } = await opened(browser);
  await moves(page);
  await page.getByRole("button", { name: "Pause", exact: true }).click();
  await page.waitForFunction(() => document.querySelector(".pace")?.textContent === "paused");
  const us = await microseconds(page);
  assert.equal(await page.evaluate(() => window.ipos.hash()), nativeHash(us));
  assert.match(await page.evaluate(() => window.ipos.version), /^\d+\.\d+\.\d+/);
  await context.close();
});

test("tests of the open plant run, and an archive of its files can be opened again", options, async () => {
  const { page, told, context } = await opened(browser);
  await moves(page);
  await page.getByRole("button", { name: "Files" }).click();
  await page.getByRole("button", { name: "Test all" }).click();
  await page.getByRole("status", { name: "Test report" }).filter({ hasText: "4 tests, 4 passed" }).waitFor();
  const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: "Save archive" }).click()]);
  assert.equal(download.suggestedFilename(), "hoist.zip");
  const archive = await download.path();
  const listed = spawnSync("python3", ["-m", "zipfile", "-l", archive], { encoding: "utf8" }).stdout;
  for (const name of ["HOIST.IPC", "hoist.toml", "hoist.test.toml"]) assert.ok(listed.includes(name), listed);
  // Another plant has a page of its own.
  const loaded = page.waitForEvent("load");
  await page.getByLabel("Open archive").setInputFiles({ name: "again.zip", mimeType: "application/zip", buffer: readFileSync(archive) });
  await loaded;
  await page.getByRole("button", { name: "Files" }).click();
  await page.getByRole("button", { name: "again/hoist.toml" }).waitFor();
  assert.deepEqual(told.errors, []);
  await context.close();
});

test("files and settings are there after a reload", options, async () => {
  const { page, context } = await opened(browser);
  await moves(page);
  await page.getByRole("button", { name: "Files" }).click();
  await page.getByRole("button", { name: "hoist/hoist.toml" }).waitFor();
  await page.reload();
  await page.waitForFunction(() => document.title.includes("hoist.toml"));
  await page.getByRole("button", { name: "Files" }).click();
  await page.getByRole("button", { name: "hoist/hoist.toml" }).waitFor();
  assert.equal(await page.getByRole("list", { name: "Plants" }).getByRole("listitem").count(), 2);  // hoist.toml and real.toml, not the campaign
  await context.close();
});

// On a slow machine the page is there long before its worker.
test("who opens the list of files before the worker is there sees them, and what a link brings along", options, async () => {
  const context = await browser.newContext({ offline: true });
  await context.addInitScript(() => {
    const post = Worker.prototype.postMessage;
    Worker.prototype.postMessage = function (message, transfer) {
      if (message.kind === "start") setTimeout(() => post.call(this, message, transfer), 1000);
      else post.call(this, message, transfer);
    };
  });
  const { page, told } = await opened(browser, `${address()}#example=gateway`, context);
  await page.getByRole("button", { name: "Files" }).click();
  await page.getByRole("dialog", { name: "Files" }).getByRole("button", { name: "gateway/gateway.toml" }).waitFor();
  assert.deepEqual(told.errors, []);
  await context.close();
});

// By another program: tests/docs/plant_link.py.
function linkHas(link, folder, more) {
  const { status, stdout, stderr } = spawnSync("python3", [join(examples, "../tests/docs/plant_link.py"), folder], { input: link, encoding: "utf8" });
  assert.equal(status, 0, stdout + stderr);
  for (const line of more) assert.match(stdout, line);
}

test("a link has the plant in its fragment and runs in a fresh profile", options, async () => {
  const first = await opened(browser);
  await moves(first.page);
  await first.page.getByRole("button", { name: "Share" }).click();
  const box = first.page.getByRole("textbox", { name: "Link" });
  const link = await box.inputValue();
  assert.ok(link.startsWith(`${address()}#`) && link.length < 8192, `${link.length}`);
  linkHas(link, join(examples, "hoist"), [/^name hoist, plant shared\.ipos$/m, /^besides shared\.ipos, \d{3,} bytes$/m]);
  await first.page.getByRole("checkbox", { name: "With what was done" }).uncheck();
  await first.page.waitForFunction((before) => document.querySelector("[aria-label=Link]").value !== before, link);
  const plain = await box.inputValue();
  linkHas(plain, join(examples, "hoist"), [/^name hoist, plant hoist\.toml$/m]);
  assert.ok(plain.length < link.length);
  await first.context.close();
  const { page, told, context } = await opened(browser, link);
  await moves(page);
  assert.match(await page.title(), /hoist\.toml/);
  assert.deepEqual(told.errors, []);
  await context.close();
});

test("bytes that are no UTF-8, a byte order mark and ends of lines stay what they are in a link", options, async () => {
  const folder = mkdtempSync(join(tmpdir(), "ipos-link-"));
  writeFileSync(join(folder, "P.IPC"), Buffer.from("// Gr\xf6\xdfe\r\nlong a;\r\nmain() { while (1) a++; }\r\n", "latin1"));
  writeFileSync(join(folder, "p.toml"), '\ufeff# \u0434\u0432\u0430\n[[station]]\nname = "a"\nunit = "mdxb"\nprogram = "P.IPC"\n');
  writeFileSync(join(folder, "empty.toml.txt"), "");
  const archive = join(mkdtempSync(join(tmpdir(), "ipos-zip-")), "bytes.zip");
  assert.equal(spawnSync("python3", ["-m", "zipfile", "-c", archive, "P.IPC", "p.toml", "empty.toml.txt"], { cwd: folder }).status, 0);
  const { page, context } = await opened(browser);
  await moves(page);
  await page.getByRole("button", { name: "Files" }).click();
  await page.getByLabel("Open archive").setInputFiles(archive);
  await page.waitForFunction(() => document.title.includes("p.toml"));
  await page.getByRole("button", { name: "Share" }).click();
  linkHas(await page.getByRole("textbox", { name: "Link" }).inputValue(), folder, [/^3 of 3 files equal$/m]);
  await context.close();
});

test("links of the guides open and run", options, async () => {
  const guide = readFileSync(join(examples, "../docs/guide/tutorial.md"), "utf8");
  const [, fragment] = /\[Try it\]\([^)#]*(#plant=[^)]*)\)/.exec(guide);
  const { page, told, context } = await opened(browser, address() + fragment);
  await moves(page);
  assert.match(await page.title(), /line\.toml/);
  await page.getByRole("switch", { name: "leader DI10" }).waitFor();
  assert.deepEqual(told.errors, []);
  await context.close();
});

test("the site has ipos.wasm beside the page and asks for nothing else", options, async () => {
  const types = { "index.html": "text/html", "ipos.wasm": "application/wasm" };
  const server = createServer((request, answer) => {
    const name = request.url === "/" ? "index.html" : request.url.slice(1);
    if (!(name in types)) return answer.writeHead(404).end();
    answer.writeHead(200, { "content-type": types[name] }).end(readFileSync(join(built, "site", name)));
  });
  await new Promise((done) => server.listen(0, "127.0.0.1", done));
  const place = `http://127.0.0.1:${server.address().port}/`;
  const context = await browser.newContext();
  const { page, told } = await opened(browser, place, context);
  await moves(page);
  assert.deepEqual(told.requests.filter((url) => !url.startsWith("blob:")), [place, `${place}ipos.wasm`]);
  assert.deepEqual(told.errors, []);
  await context.close();
  server.close();
});
