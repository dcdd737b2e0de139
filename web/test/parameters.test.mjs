// The parameters before the real server: lists, range, factory setting, changed ones, comparison with a station and with
// files, lines for a plant file. On a wide page and on a phone, with axe-core.
//   IPOS_PROGRAM=.../ipos node --test test/parameters.test.mjs
import assert from "node:assert";
import { execFileSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { after, before, test } from "node:test";

import { desktop, launch, missing, openPage, phone } from "./browser.mjs";
import { folderOf, program, serve } from "./serve.mjs";

const skip = missing ?? (program ? false : "IPOS_PROGRAM does not name the ipos to test");
const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");

const head = '[[bus]]\nname = "sbus"\nkind = "can"\n';
const belt = '[[station]]\nname = "belt"\nunit = "mdxb"\nsbus = "sbus"\n';
const gate = '[[station]]\nname = "gate"\nunit = "mdxb"\nsbus = "sbus"\n[station.parameters]\nP881 = 2\n';
const plant_text = `${head}${belt}[station.parameters]\nP130 = "1.5 s"\nP600 = "NO FUNCTION"\nP881 = 1\n${gate}`;

let browser;
let place;
before(async () => {
  if (skip) return;
  browser = await launch();
  place = folderOf({ "plant.toml": plant_text, "other.toml": `${head}${belt}[station.parameters]\nP130 = "3 s"\nP881 = 1\n` });
});
after(async () => {
  await browser?.close();
  place?.remove();
});

async function until(condition, what) {
  for (const end = Date.now() + 20_000; !(await condition()); ) {
    assert.ok(Date.now() < end, what);
    await new Promise((done) => setTimeout(done, 50));
  }
}

async function meet(viewport, act) {
  const server = await serve("plant.toml", [], place.folder);
  const opened = await openPage(browser, server.address, { viewport });
  try {
    await opened.page.getByRole("tab", { name: "Parameters" }).click();
    await opened.page.getByRole("combobox", { name: "Station", exact: true }).selectOption("belt");
    await act(opened.page);
    assert.deepStrictEqual(opened.errors.filter((text) => !text.includes("WebSocket")), []);
  } finally {
    await opened.close();
    await server.stop();
  }
}

async function findings(page) {
  await page.evaluate(axe);
  const found = await page.evaluate(() => window.axe.run(document));
  return found.violations.filter((one) => ["serious", "critical"].includes(one.impact)).map((one) => `${one.id}: ${one.nodes.map((node) => node.html.slice(0, 120))}`);
}

async function saved(page, name) {
  const download = page.waitForEvent("download");
  await page.getByRole("button", { name, exact: true }).click();
  const file = await download;
  return { name: file.suggestedFilename(), text: readFileSync(await file.path(), "utf8") };
}

const table = (page) => page.getByRole("table", { name: "Parameters" });
const rowOf = (page, number) => table(page).getByRole("row", { name: new RegExp(`^${number} `) });
const cell = (page, number, column) => rowOf(page, number).locator(`td.${column}`);
const numbers = async (page) => (await table(page).locator("tbody th").allTextContents()).map((text) => text.trim());

// P130 is 2 s as delivered, 0 to 2000 s (1053 1610 p. 70); P600 has 26 texts (p. 76); P031 shows P600.
test("parameters: lists, range, factory setting, changed ones, comparison, files", { skip }, () =>
  meet(desktop, async (page) => {
    await rowOf(page, "P130").waitFor();
    assert.strictEqual(await cell(page, "P130", "value").textContent(), "1.500");
    assert.strictEqual(await cell(page, "P130", "range").textContent(), "0.000 s … 2000.000 s");
    assert.strictEqual(await cell(page, "P130", "factory").textContent(), "2.000 s");
    assert.match(await rowOf(page, "P031").textContent(), /shows P600/);
    const all = await numbers(page);
    const named = all.filter((text) => text.startsWith("P"));
    assert.ok(all.length > 300 && all.slice(0, named.length).every((text) => text.startsWith("P")), "indices of the system come behind");
    assert.deepStrictEqual(named, [...named].sort());

    // A list has the texts; a choice is set at once, a refusal is an alert and changes nothing.
    const list = page.getByRole("combobox", { name: "Texts of P600" });
    assert.strictEqual(await list.locator("option").count(), 26);
    assert.strictEqual(await list.inputValue(), "NO FUNCTION");
    await list.selectOption("IPOS INPUT");
    await until(async () => (await cell(page, "P600", "value").textContent()) === "IPOS INPUT", "not set");
    await rowOf(page, "P130").getByRole("textbox").fill("9999 s");
    await rowOf(page, "P130").getByRole("textbox").press("Enter");
    await page.getByRole("alert").waitFor();
    assert.strictEqual(await cell(page, "P130", "value").textContent(), "1.500");
    await page.getByRole("button", { name: "Close message" }).click();

    // Settings that are not the factory's, and no display value among them.
    await page.getByRole("checkbox", { name: "only changed ones" }).check();
    await until(async () => (await numbers(page)).length < 10, "all are there");
    assert.deepStrictEqual(await numbers(page), ["P130", "P600", "P881"]);
    await page.getByRole("checkbox", { name: "only changed ones" }).uncheck();

    // The lines for the plant file make a plant with the same settings.
    const toml = await saved(page, "Save as TOML");
    assert.strictEqual(toml.name, "belt.toml");
    assert.match(toml.text, /^\[station\.parameters\]\nP130 = "1\.500 s" {2}# /);
    writeFileSync(join(place.folder, "made.toml"), `${head}${belt}${toml.text}`);
    const read = execFileSync(program, ["param", "get", "made.toml", "P130", "P600"], { cwd: place.folder, encoding: "utf8" });
    assert.match(read, /1\.500 s/);
    assert.match(read, /IPOS INPUT/);

    // Another station: only what differs; one copied, then all.
    const compare = page.getByRole("combobox", { name: "Compare with" });
    await compare.selectOption("gate");
    await page.getByText("3 differences").waitFor();
    assert.deepStrictEqual(await numbers(page), ["P130", "P600", "P881"]);
    assert.match(await cell(page, "P130", "other").textContent(), /^2\.000 s/);
    await page.getByRole("button", { name: "Copy P130" }).click();
    await page.getByText("2 differences").waitFor();
    assert.deepStrictEqual(await findings(page), []);
    await page.getByRole("button", { name: "Copy all to belt" }).click();
    await page.getByText("No difference.").waitFor();

    // A plant file: its station, with the factory settings where it says nothing.
    const chooser = page.waitForEvent("filechooser");
    await compare.selectOption("a file …");
    await (await chooser).setFiles(join(place.folder, "other.toml"));
    await until(async () => (await numbers(page)).join() === "P130,P881", "not the differences to the file");
    await page.getByRole("button", { name: "Copy all to belt" }).click();
    await page.getByText("No difference.").waitFor();
    await compare.selectOption("nobody");
    await until(async () => (await cell(page, "P130", "value").textContent()) === "3.000", "not taken from the file");
  }),
);

test("parameters on a phone: the field lies inside the box and sets", { skip }, () =>
  meet(phone, async (page) => {
    await rowOf(page, "P130").waitFor();
    const box = page.getByRole("group", { name: "List of parameters" });
    const { inner, outer } = await box.evaluate((element) => ({ inner: element.scrollWidth, outer: element.clientWidth }));
    assert.ok(inner <= outer, `${inner} in ${outer}`);
    for (const number of ["P130", "P600"]) {
      const field = rowOf(page, number).getByRole("textbox");
      await field.scrollIntoViewIfNeeded();
      const { x, width } = await field.boundingBox();
      const around = await box.boundingBox();
      assert.ok(x >= around.x && x + width <= around.x + around.width && width > 60, `${number}: ${x} ${width}`);
    }
    await rowOf(page, "P130").getByRole("textbox").fill("2.5");
    await rowOf(page, "P130").getByRole("textbox").press("Enter");
    await until(async () => (await cell(page, "P130", "value").textContent()) === "2.500", "not set");
    await page.getByRole("combobox", { name: "Compare with" }).selectOption("gate");
    await page.getByRole("button", { name: "Copy P130" }).waitFor();
    assert.ok((await box.evaluate((element) => element.scrollWidth - element.clientWidth)) <= 0);
    assert.deepStrictEqual(await findings(page), []);
  }),
);
