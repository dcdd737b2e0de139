// Without a plant there is the gallery: an example is opened as a copy, and a plant of three stations on one SBus that
// exchange a telegram is made by the keyboard alone, without a word of TOML.
import assert from "node:assert";
import { existsSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";

import { desktop, launch, missing, openPage, phone } from "./browser.mjs";
import { choose, press, type } from "./keyboard.mjs";
import { program, serve } from "./serve.mjs";

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

async function inEmptyFolder(use) {
  const folder = mkdtempSync(join(tmpdir(), "ipos-gallery-"));
  const server = await serve(undefined, ["--port", "0"], folder);
  try {
    const opened = await openPage(browser, server.address);
    await opened.page.getByRole("region", { name: "Gallery" }).waitFor();
    await use(opened.page, folder);
    assert.deepStrictEqual(opened.errors.filter((text) => !text.includes("WebSocket")), []);
    await opened.close();
  } finally {
    await server.stop();
    rmSync(folder, { recursive: true });
  }
}

test("an example is opened as a copy, never over a file", { skip }, () =>
  inEmptyFolder(async (page, folder) => {
    for (const size of [phone, desktop]) {
      await page.setViewportSize(size);
      await page.getByRole("link", { name: "hoist", exact: true }).waitFor();
      assert.deepStrictEqual(await findings(page), []);
      assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), "it is wider than the window");
    }
    assert.ok((await page.getByRole("link").count()) >= 22);
    await page.getByRole("link", { name: "hoist", exact: true }).click();
    const dialog = page.getByRole("dialog", { name: "Open hoist" });
    assert.strictEqual(await dialog.getByRole("textbox", { name: "Folder" }).inputValue(), "./hoist");
    assert.deepStrictEqual(await findings(page), []);
    await dialog.getByRole("button", { name: "Open" }).click();
    await page.getByRole("switch", { name: "hoist DI10" }).waitFor();
    assert.ok(existsSync(join(folder, "hoist", "HOIST.IPC")));
    await page.getByRole("region", { name: "Program" }).waitFor();
  }),
);

test("three stations exchange a telegram, by the keyboard alone", { skip }, () =>
  inEmptyFolder(async (page, folder) => {
    await press(page, "New plant");
    await page.getByRole("dialog", { name: "New plant" }).getByRole("checkbox", { name: "sbus (sbus)" }).waitFor();
    await type(page, "Name", "leader");
    await choose(page, "Program", "new, from LEADER.IPC");
    await press(page, "sbus (sbus)", "Space");
    await press(page, "Make plant");
    await page.getByRole("switch", { name: "leader DI10" }).waitFor();
    for (const name of ["north", "south"]) {
      await press(page, "New station");
      await page.getByRole("dialog", { name: "New station" }).getByRole("checkbox", { name: "sbus (sbus)" }).waitFor();
      await type(page, "Name", name);
      await choose(page, "Program", "new, from FOLLOWER.IPC");
      await press(page, "sbus (sbus)", "Space");
      await press(page, "Insert");
      await page.getByRole("combobox", { name: "Station" }).first().locator("option", { hasText: name }).waitFor({ state: "attached" });
    }
    const plant = readFileSync(join(folder, "plant.toml"), "utf8");
    assert.ok(plant.startsWith("# A plant made on the page."));
    assert.deepStrictEqual(plant.match(/P881 = "?\d+/g)?.map((row) => row.replace(/\D*881 = "?/, "")), ["1", "2", "3"]);
    await page.keyboard.press("r");
    await page.keyboard.press("5");
    await page.getByRole("table", { name: "Bus" }).getByRole("row", { name: /1100/ }).first().waitFor();
  }),
);
