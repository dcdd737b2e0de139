// The page before the mock server: roles and names of its contract, what it says when something is refused or lost,
// keys, sizes, accessibility. What needs a drive that moves is in plant.test.mjs.
import assert from "node:assert";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { after, before, test } from "node:test";

import { startMock } from "../mock/server.mjs";
import { desktop, launch, missing, openPage, phone, tab_names } from "./browser.mjs";

const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const skip = missing ?? false;
let browser;

before(async () => {
  if (!skip) browser = await launch();
});
after(() => browser?.close());

// A mock server of its own and a page before it; the page must have nothing against us.
async function meet(use, { server, ...options } = {}) {
  const mock = await startMock(server);
  const opened = await openPage(browser, mock.address, options);
  try {
    await opened.page.getByRole("switch", { name: "saw DI00" }).waitFor();
    await use(opened.page, mock);
    assert.deepStrictEqual(opened.errors.filter((text) => !text.includes("WebSocket")), []);
  } finally {
    await opened.close();
    await mock.stop();
  }
}

const until = async (what, text) => {
  for (let n = 0; n < 100; ++n) {
    if (await what()) return;
    await new Promise((done) => setTimeout(done, 50));
  }
  assert.fail(text);
};

test("one document, and no other request", { skip }, () =>
  meet(async (page, mock) => {
    for (const name of tab_names) await page.getByRole("tab", { name }).click();
    assert.deepStrictEqual(mock.requests, ["/"]);
  }),
);

test("seven tabs, one panel at a time, time and its buttons on each", { skip }, () =>
  meet(async (page) => {
    assert.deepStrictEqual(await page.getByRole("tablist").getByRole("tab").allTextContents(), tab_names);
    for (const name of tab_names) {
      await page.getByRole("tab", { name }).click();
      assert.strictEqual(await page.getByRole("tabpanel").count(), 1);
      assert.strictEqual(await page.locator('[role="tabpanel"][hidden]').count(), 6);
      for (const button of ["Run", "Pause", "Step"])
        assert.strictEqual(await page.getByRole("button", { name: button }).count(), 1, `${button} on ${name}`);
      assert.strictEqual(await page.getByRole("timer", { name: "Time" }).textContent(), "0.000 s");
    }
  }),
);

test("arrows move between the tabs", { skip }, () =>
  meet(async (page) => {
    await page.getByRole("tab", { name: "Plant" }).focus();
    await page.keyboard.press("ArrowRight");
    assert.strictEqual(await page.getByRole("tab", { selected: true }).textContent(), "Watch");
    await page.keyboard.press("End");
    assert.strictEqual(await page.getByRole("tab", { selected: true }).textContent(), "Journal");
  }),
);

test("switches switch, lamps say on and off", { skip }, () =>
  meet(async (page, mock) => {
    const lamp = page.getByRole("status", { name: "saw DB00" });
    assert.strictEqual(await lamp.textContent(), "off");
    for (const name of ["DI00", "DI01", "DI03"]) await page.getByRole("switch", { name: `saw ${name}` }).click();
    await until(async () => (await lamp.textContent()) === "on", "the lamp stays dark");
    assert.strictEqual(mock.plant.stations.saw.in, 11);
    assert.strictEqual(await page.getByRole("switch", { name: "saw DI01" }).getAttribute("aria-checked"), "true");
    await page.getByRole("button", { name: "Force saw DI00" }).click();
    await until(async () => mock.plant.stations.saw.forced === 1, "nothing is forced");
  }),
);

test("a click on a tap cuts it, another one joins it again", { skip }, () =>
  meet(async (page, mock) => {
    const tap = page.getByRole("button", { name: "Cut saw from sbus" });
    await tap.press("Enter");
    await until(async () => (await tap.getAttribute("aria-pressed")) === "true", "not cut");
    assert.deepStrictEqual(mock.plant.faults, [{ kind: "cut", station: "saw" }]);
    await tap.press("Enter");
    await until(async () => (await tap.getAttribute("aria-pressed")) === "false", "still cut");
  }),
);

test("the watch has a row a variable; Enter sets, F forces", { skip }, () =>
  meet(async (page) => {
    await page.getByRole("tab", { name: "Watch" }).click();
    const row = page.getByRole("table", { name: "Watch" }).getByRole("row", { name: "lift.lWrong" });
    await row.getByRole("textbox").fill("7");
    await row.getByRole("textbox").press("Enter");
    await until(async () => (await row.getByRole("cell").first().textContent()) === "7", "the value is not there");
    await row.getByRole("button", { name: "Force lift.lWrong" }).click();
    await until(async () => (await row.getByRole("button", { name: "Force lift.lWrong" }).getAttribute("aria-pressed")) === "true", "not forced");
  }),
);

test("a parameter is set with Enter; a refusal is an alert in the drive's words", { skip }, () =>
  meet(async (page) => {
    await page.getByRole("tab", { name: "Parameters" }).click();
    await page.getByRole("combobox", { name: "Station" }).selectOption("lift");
    const table = page.getByRole("table", { name: "Parameters" });
    const ramp = table.getByRole("row", { name: "P130" });
    await ramp.getByRole("textbox").fill("2.5");
    await ramp.getByRole("textbox").press("Enter");
    await until(async () => (await ramp.textContent()).includes("2.500"), "the ramp is as before");
    const rate = table.getByRole("row", { name: "P816" });
    await rate.getByRole("textbox").fill("9");
    await rate.getByRole("textbox").press("Enter");
    await page.getByRole("alert").waitFor();
    assert.strictEqual(await page.getByRole("alert").textContent(), "Refused: read access only");
    await page.getByRole("searchbox").fill("baud");
    assert.strictEqual(await table.getByRole("row").count(), 2);
  }),
);

test("the bus table has identifiers in decimal and hexadecimal, changed bytes marked", { skip }, () =>
  meet(async (page) => {
    await page.getByRole("tab", { name: "Bus" }).click();
    const row = page.getByRole("table", { name: "Bus" }).getByRole("row", { name: "524 (20Ch)" });
    await row.waitFor();
    assert.deepStrictEqual(await row.locator(".byte.new").allTextContents(), ["88"]);
  }),
);

test("the scope draws, keeps still where it is zoomed, and gives files", { skip }, () =>
  meet(async (page, mock) => {
    mock.plant.us = 3_000_000;
    await page.getByRole("button", { name: "Run" }).click();
    await page.getByRole("tab", { name: "Scope" }).click();
    const figure = page.getByRole("figure", { name: "Scope" });
    for (const name of ["Trigger", "Single", "CSV"])
      assert.strictEqual(await figure.getByRole("button", { name }).count(), 1, name);
    await page.keyboard.press("z");
    await page.keyboard.press("a");
    const at = page.getByRole("table", { name: "Readings" }).getByRole("row", { name: "saw.speed" }).getByRole("cell").nth(1);
    // The mock's sine at the time of the cursor, by our own calculation.
    await until(async () => (await at.textContent()) !== "–", "no value at the cursor");
    const time = await page.getByRole("table", { name: "Readings" }).getByRole("row", { name: "time" }).getByRole("cell").nth(1).textContent();
    const expected = Math.sin((Number.parseFloat(time) * 1e6) / 3e5) * 1500;
    assert.ok(Math.abs(Number(await at.textContent()) - expected) < 0.06, `${await at.textContent()} for ${expected}`);
    const views = () => mock.received.filter((one) => one.do === "scope.view" && one.points > 1);
    await until(async () => views().length > 0, "no view with points was asked for");
    await page.keyboard.press("p");
    const download = page.waitForEvent("download");
    await figure.getByRole("button", { name: "CSV" }).click();
    assert.strictEqual((await download).suggestedFilename(), "scope.csv");
    const picture = page.waitForEvent("download");
    await figure.getByRole("button", { name: "PNG" }).click();
    const file = readFileSync(await (await picture).path());
    assert.strictEqual(file.subarray(1, 4).toString(), "PNG");
  }),
);

test("an entry of the journal leads to its time in the scope", { skip }, () =>
  meet(async (page) => {
    await page.getByRole("tab", { name: "Journal" }).click();
    const log = page.getByRole("log");
    await log.getByText("F01 overcurrent").waitFor();
    await page.getByRole("checkbox", { name: "faults" }).uncheck();
    assert.strictEqual(await log.getByText("F01 overcurrent").count(), 0);
    await log.getByRole("button", { name: "Show 0.001 s in the scope" }).click();
    assert.strictEqual(await page.getByRole("tab", { selected: true }).textContent(), "Scope");
    assert.match(await page.getByRole("table", { name: "Readings" }).getByRole("row", { name: "time" }).textContent(), /0\.001 s/);
  }),
);

test("a place that the journal names leads to its line", { skip }, () =>
  meet(async (page) => {
    await page.getByRole("tab", { name: "Journal" }).click();
    await page.getByRole("log").getByRole("button", { name: "SAW.IPC:9:3" }).click();
    assert.strictEqual(await page.getByRole("tab", { selected: true }).textContent(), "Program");
    await page.locator(".cm-activeLine").waitFor();
    const lineOf = () => page.locator(".cm-activeLine").evaluate((one) => [...one.parentElement.children].indexOf(one) + 1);
    await until(async () => (await lineOf()) === 9, "it is another line");
  }),
);

test("a breakpoint is set and cleared at the edge of its line", { skip }, () =>
  meet(async (page, mock) => {
    await page.getByRole("tab", { name: "Program" }).click();
    const point = page.getByRole("button", { name: "Breakpoint in line 9" });
    await point.click();
    await until(async () => (await point.getAttribute("aria-pressed")) === "true", "not set");
    assert.strictEqual(mock.plant.breakpoints[0].line, 9);
    await point.click();
    await until(async () => (await point.getAttribute("aria-pressed")) === "false", "not cleared");
    assert.strictEqual(await page.locator(".editor .missed").count(), 2);
  }),
);

test("a lost server is an alert, and the page comes back by itself", { skip }, () =>
  meet(async (page, mock) => {
    const { port } = mock;
    await mock.stop();
    await page.getByRole("alert").waitFor();
    assert.match(await page.getByRole("alert").textContent(), /connection to the server is lost/);
    const again = await startMock({ port });
    try {
      await page.getByRole("alert").waitFor({ state: "detached", timeout: 10_000 });
      await page.getByRole("switch", { name: "saw DI00" }).click();
      await until(async () => again.plant.stations.saw.in === 1, "the new server hears nothing");
    } finally {
      await again.stop();
    }
  }),
);

test("keys: run, step, tabs, search, help; none while one types", { skip }, () =>
  meet(async (page, mock) => {
    await page.keyboard.press("s");
    await until(async () => mock.plant.us === 1000, "no step");
    await page.keyboard.press(" ");
    await until(async () => mock.plant.running, "it does not run");
    await page.keyboard.press("p");
    await until(async () => !mock.plant.running, "it runs on");
    await page.keyboard.press("2");
    await page.keyboard.press("/");
    await page.keyboard.type("rpsr");
    assert.strictEqual(await page.getByRole("searchbox").inputValue(), "rpsr");
    assert.strictEqual(mock.plant.running, false);
    await page.keyboard.press("Escape");
    await page.keyboard.press("?");
    const sheet = page.getByRole("dialog", { name: "Keys" });
    await sheet.waitFor();
    await sheet.getByRole("button", { name: "Licences" }).click();
    await sheet.getByText("licences of cardboard").waitFor();
    await page.keyboard.press("Escape");
    assert.strictEqual(await page.getByRole("dialog", { name: "Keys" }).count(), 0);
  }),
);

test("a stop that the drive has not answered is red on every tab", { skip }, () =>
  meet(
    async (page, mock) => {
      await page.getByRole("button", { name: "Allow writing" }).waitFor();
      const left = "P100 Setpoint source is RS-485 in place of TERMINALS";
      mock.announce({ event: "manual", moves: false, alarm: "The drive has not answered the stop.", left: [left] });
      for (const name of ["Plant", "Watch", "Scope", "Parameters", "Bus", "Program", "Journal"]) {
        await page.getByRole("tab", { name }).click();
        const alert = page.getByRole("alert").filter({ hasText: "The drive has not answered the stop." });
        await alert.waitFor();
        assert.ok(await alert.evaluate((element) => getComputedStyle(element.parentElement).borderTopWidth === "3px"));
        await page.getByText(left).waitFor();
      }
      mock.announce({ event: "manual", moves: false, alarm: "", left: [] });
      await until(async () => (await page.getByRole("alert").count()) === 0, "the alarm stays");
    },
    { server: { mode: "device" } },
  ),
);

test("a real drive is written only after a confirmation", { skip }, () =>
  meet(
    async (page, mock) => {
      const jog = page.getByRole("button", { name: "Hold for CW" });
      assert.ok(await jog.isDisabled());
      page.on("dialog", (dialog) => dialog.accept());
      await page.getByRole("button", { name: "Allow writing" }).click();
      await until(async () => !(await jog.isDisabled()), "still locked");
      await jog.hover();
      await page.mouse.down();
      await until(async () => mock.received.filter((one) => one.do === "jog").length >= 3, "it does not repeat");
      await page.mouse.up();
      await until(async () => mock.received.at(-1).direction === "stop", "it does not stop");
      assert.ok(await page.getByRole("button", { name: "Run" }).isDisabled());
      await page.getByRole("tab", { name: "Watch" }).click();
      await page.getByRole("row", { name: "P008" }).waitFor();
      await page.getByRole("tab", { name: "Scope" }).click();
      const kinds = page.getByRole("group", { name: "Trigger" }).locator("select").first();
      await kinds.waitFor();
      assert.deepEqual(await kinds.locator("option").allTextContents(), ["none", "level", "edge"]);
      await page.getByRole("tab", { name: "Program" }).click();
      await page.getByText("A real drive does not give its source away").waitFor();
      await page.getByRole("tab", { name: "Journal" }).click();
      await page.getByText("Only simulated drives keep a journal").waitFor();
    },
    { server: { mode: "device" } },
  ),
);

for (const { name, viewport, colorScheme } of [
  { name: "desktop", viewport: desktop, colorScheme: "dark" },
  { name: "phone", viewport: phone, colorScheme: "light" },
])
  test(`${name}, ${colorScheme}: nothing is cut off, axe-core finds nothing serious`, { skip }, () =>
    meet(
      async (page) => {
        await page.getByRole("button", { name: "Step" }).click();
        await page.evaluate(axe);
        for (const tab of tab_names) {
          await page.getByRole("tab", { name: tab }).click();
          await page.waitForTimeout(150);
          const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
          assert.ok(wide <= 0, `${tab} is ${wide} pixels too wide`);
          const found = await page.evaluate(() => window.axe.run(document));
          const serious = found.violations.filter((one) => one.impact === "serious" || one.impact === "critical");
          const text = (one) => `${tab}: ${one.id} ${one.nodes.map((node) => node.html.slice(0, 160))}`;
          assert.deepStrictEqual(serious.map(text), []);
        }
      },
      { viewport, colorScheme },
    ),
  );
