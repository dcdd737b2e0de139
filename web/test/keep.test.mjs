// Clicks become a test that is green at once and red when one of its values is changed, and a session that stands at the same
// moment when it is opened.
import assert from "node:assert";
import { cpSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";

import { desktop, launch, missing, openPage, phone } from "./browser.mjs";
import { examples, program, serve, standAt } from "./serve.mjs";

const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const skip = missing ?? (program ? false : "IPOS_PROGRAM does not name the ipos to test");
let browser;

before(async () => {
  if (!skip) browser = await launch();
});
after(() => browser?.close());

const findings = async (page) => {
  await page.evaluate(axe);
  const { violations } = await page.evaluate(() => window.axe.run(document, { resultTypes: ["violations"] }));
  return violations.map((one) => `${one.id}: ${one.nodes.map((node) => node.html).join(" ")}`);
};

const time = (page) => page.getByRole("timer", { name: "Time" }).textContent();

const until = async (what, text) => {
  for (let n = 0; n < 200; ++n) {
    if (await what()) return;
    await new Promise((done) => setTimeout(done, 50));
  }
  assert.fail(text);
};

// The editor shows the file, with the cursor in that line.
async function standsAt(page, file, line) {
  const chosen = page.getByRole("combobox", { name: "File" }).locator("option:checked");
  await until(async () => (await chosen.textContent()) === file, `${file} is not opened`);
  await until(async () => {
    const at = await page.locator(".cm-activeLine").evaluate((active) => {
      const y = active.getBoundingClientRect().top;
      const number = [...document.querySelectorAll(".cm-lineNumbers .cm-gutterElement")].find((one) => one.offsetHeight > 0 && Math.abs(one.getBoundingClientRect().top - y) < 3);
      return Number(number?.textContent);
    });
    return at === line;
  }, `it does not stand at line ${line}`);
}

const red_test = `plant = "hoist.toml"

[[expect]]
at = "5ms"
variable = "lFloor"
equals = 7

[[step]]
until = "1s"
`;

test("a check of a test that is not met is a mark that leads to its line", { skip }, async () => {
  const folder = mkdtempSync(join(tmpdir(), "ipos-keep-"));
  cpSync(join(examples, "hoist"), folder, { recursive: true });
  writeFileSync(join(folder, "red.test.toml"), red_test);
  const server = await serve("red.test.toml", ["--port", "0"], folder);
  try {
    const { page, errors, close } = await openPage(browser, server.address);
    await page.getByRole("switch", { name: "hoist DI10" }).waitFor();
    await standAt(server, page, 20);
    const mark = page.getByRole("list", { name: "Marks" }).getByRole("listitem").filter({ hasText: "red.test.toml:3" });
    await mark.first().waitFor();
    await mark.first().getByRole("button", { name: "red.test.toml:3" }).click();
    await standsAt(page, "red.test.toml", 3);
    assert.deepStrictEqual(await findings(page), []);
    assert.deepStrictEqual(errors, []);
    await close();
  } finally {
    await server.stop();
    rmSync(folder, { recursive: true });
  }
});

// The test lies in a folder beside that of the plant, whose program includes a file from a third one.
test("a session holds what lies outside of the plant's folder", { skip }, async () => {
  const folder = mkdtempSync(join(tmpdir(), "ipos-keep-"));
  for (const name of ["plant", "tests", "common"]) mkdirSync(join(folder, name));
  cpSync(join(examples, "hoist", "hoist.toml"), join(folder, "plant", "hoist.toml"));
  const source = readFileSync(join(examples, "hoist", "HOIST.IPC"), "utf8");
  writeFileSync(join(folder, "common", "floors.h"), "#define UPPER 60000\n");
  writeFileSync(join(folder, "plant", "HOIST.IPC"), source.replace(/#define UPPER.*/, '#include "../common/floors.h"'));
  writeFileSync(join(folder, "tests", "red.test.toml"), red_test.replace("hoist.toml", "../plant/hoist.toml"));
  let server = await serve(join("tests", "red.test.toml"), ["--port", "0"], folder);
  try {
    const { page, close } = await openPage(browser, server.address);
    await page.getByRole("switch", { name: "hoist DI10" }).waitFor();
    await standAt(server, page, 20);
    await page.getByRole("button", { name: "Save session" }).click();
    const session = page.getByRole("dialog", { name: "Save session" });
    await session.getByRole("textbox", { name: "File" }).fill("far.ipos");
    await session.getByRole("button", { name: "Save" }).click();
    await session.getByText("ipos serve").waitFor();
    const place = /ipos serve (\S+)/.exec(await session.textContent())[1];
    await close();
    await server.stop();
    server = await serve(place, ["--port", "0"], folder);
    const again = await openPage(browser, server.address);
    await until(async () => (await time(again.page)) === "0.020 s", "the session stands at another moment");
    await again.page.getByRole("list", { name: "Marks" }).getByText(/^0\.005 s/).first().waitFor();
    await again.close();
  } finally {
    await server.stop();
    rmSync(folder, { recursive: true });
  }
});

test("clicks become a green test, a red one after a change, and a session of the same moment", { skip }, async () => {
  const folder = mkdtempSync(join(tmpdir(), "ipos-keep-"));
  cpSync(join(examples, "hoist"), folder, { recursive: true });
  let server = await serve("hoist.toml", ["--port", "0"], folder);
  try {
    const { page, errors, close } = await openPage(browser, server.address);
    await page.getByRole("switch", { name: "hoist DI10" }).waitFor();
    // At 0 s there is nothing to keep.
    await page.getByRole("button", { name: "Keep as test" }).click();
    const dialog = page.getByRole("dialog", { name: "Keep as test" });
    await dialog.getByRole("alert").getByText("nothing has run yet").waitFor();
    await page.keyboard.press("Escape");

    const step = page.getByRole("button", { name: "Step", exact: true });
    for (let n = 0; n < 5; ++n) await step.click();
    await page.getByRole("switch", { name: "hoist DI10" }).click();
    for (let n = 0; n < 5; ++n) await step.click();
    await until(async () => (await time(page)) === "0.010 s", "it does not step");
    await page.getByRole("tab", { name: "Watch" }).click();
    await page.getByRole("searchbox", { name: "Search names" }).fill("hoist.setpoint");
    await page.getByRole("button", { name: "Pin hoist.setpoint", exact: true }).click();

    await page.getByRole("button", { name: "Keep as test" }).click();
    const text = dialog.getByRole("textbox", { name: "Test" });
    await until(async () => (await text.inputValue()).includes("[[expect]]"), "no test comes");
    const kept = await text.inputValue();
    for (const row of ['plant = "hoist.toml"', 'at = "5ms"', 'input = "DI10"', 'signal = "setpoint"', 'at = "10ms"'])
      assert.ok(kept.includes(row), `${row} in ${kept}`);
    for (const size of [desktop, phone]) {
      await page.setViewportSize(size);
      assert.deepStrictEqual(await findings(page), []);
      const box = await dialog.boundingBox();
      assert.ok(box.x >= 0 && box.x + box.width <= size.width);
    }
    await page.setViewportSize(desktop);
    await dialog.getByRole("textbox", { name: "File" }).fill("clicks.test.toml");
    await dialog.getByRole("button", { name: "Save" }).click();
    await dialog.getByText("Saved as").waitFor();
    assert.strictEqual(readFileSync(join(folder, "clicks.test.toml"), "utf8"), kept);

    await dialog.getByRole("button", { name: "Run tests" }).click();
    const row = dialog.getByRole("table", { name: "Tests" }).getByRole("row", { name: /^clicks / });
    await row.getByText("passed").waitFor();
    writeFileSync(join(folder, "clicks.test.toml"), kept.replace(/equals = .*\n$/, "equals = 12345\n"));
    await dialog.getByRole("button", { name: "Run tests" }).click();
    await row.getByText("failed").waitFor();
    assert.match(await row.textContent(), /clicks\.test\.toml:\d+/);
    // What was wrong leads to its line in the editor.
    const [, place_line] = /clicks\.test\.toml:(\d+)/.exec(await row.textContent());
    await row.getByRole("button", { name: /clicks\.test\.toml:\d+/ }).first().click();
    await standsAt(page, "clicks.test.toml", Number(place_line));

    await page.getByRole("button", { name: "Save session" }).click();
    const session = page.getByRole("dialog", { name: "Save session" });
    await session.getByRole("button", { name: "Save" }).click();
    await session.getByText("ipos serve").waitFor();
    assert.deepStrictEqual(errors, []);
    await close();
    assert.strictEqual(await server.stop(), 0);

    server = await serve("hoist.ipos", ["--port", "0"], folder);
    const again = await openPage(browser, server.address);
    await again.page.getByRole("switch", { name: "hoist DI10" }).waitFor();
    await until(async () => (await time(again.page)) === "0.010 s", "the session stands at another moment");
    await until(
      async () => (await again.page.getByRole("switch", { name: "hoist DI10" }).getAttribute("aria-checked")) === "true",
      "the input is not held as in the session",
    );
    await again.page.getByRole("tab", { name: "Watch" }).click();
    await again.page.getByRole("row", { name: /hoist\.setpoint/ }).first().waitFor();
    assert.deepStrictEqual(again.errors, []);
    await again.close();
  } finally {
    await server.stop();
    rmSync(folder, { recursive: true });
  }
});
