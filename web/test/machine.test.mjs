// The machine that one sees move, and the tab Plant of a plant with many stations, before the real server and, where the
// motion itself is looked at, before the mock.
//   IPOS_PROGRAM=.../ipos node --test test/machine.test.mjs
import assert from "node:assert";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { after, before, test } from "node:test";

import { startMock } from "../mock/server.mjs";
import { desktop, launch, missing, openPage, phone } from "./browser.mjs";
import { examples, folderOf, program, serve, standAt } from "./serve.mjs";

const skip = missing ?? (program ? false : "IPOS_PROGRAM does not name the ipos to test");
const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");

// 4.096 mm a turn: an increment is a thousandth of a millimetre. Parts come every 20 mm and are 5 mm long. n11 = 1500 rpm, and
// no ramp.
const belt_text = `
[[station]]
name = "belt"
unit = "mdxb"
[station.parameters]
P130 = 0
P160 = 1500000
[station.inputs]
DI00 = 1
DI01 = 1
DI03 = 1
DI04 = 1
[station.machine]
kind = "conveyor"
unit = "mm"
per_turn = 4.096
from = 0
to = 100
parts = [45]
part_length = 5
[[switch]]
station = "belt"
input = "DI10"
part_at = 50
[[station]]
name = "blower"
unit = "mdxb"
[station.machine]
kind = "fan"
[[station]]
name = "reel"
unit = "mdxb"
[station.machine]
kind = "winder"
[[station]]
name = "table"
unit = "mdxb"
[station.parameters]
P960 = 2
P963 = 4096
`;
// Nobody orders any of them to run but the 40th; the 50th has an external fault (DI05 without voltage, F26). Its lines are silent.
const many_text = `
[[bus]]
name = "sbus"
kind = "can"
${Array.from({ length: 64 }, (_, n) => {
  const number = String(n + 1).padStart(2, "0");
  return `[[station]]
name = "axis${number}"
unit = "mdxb"
${n === 0 ? 'sbus = "sbus"' : ""}
[station.parameters]
P881 = ${n}
${n === 49 ? 'P604 = "/EXT. ERROR"' : ""}
[station.inputs]
DI05 = ${n === 49 ? 0 : 1}
DI01 = ${n === 39 ? 1 : 0}
`;
}).join("")}`;

let browser;
let place;

before(async () => {
  if (skip) return;
  browser = await launch();
  place = folderOf({ "belt.toml": belt_text, "many.toml": many_text });
});
after(async () => {
  await browser?.close();
  place?.remove();
});

async function meet(file, use, options = {}) {
  const server = await serve(file, [], place.folder);
  const opened = await openPage(browser, server.address, options);
  try {
    await use(opened.page, server);
    assert.deepStrictEqual(opened.errors.filter((text) => !text.includes("WebSocket")), []);
  } finally {
    await opened.close();
    await server.stop();
  }
}

async function until(what, text) {
  for (let n = 0; n < 300; ++n) {
    if (await what()) return;
    await new Promise((done) => setTimeout(done, 50));
  }
  assert.fail(text);
}

const button = (page, name) => page.getByRole("button", { name, exact: true });
const figure = (page, name) => page.getByRole("figure", { name: `Machine ${name}`, exact: true });
const timeOf = async (page) => Math.round(Number.parseFloat(await page.getByRole("timer", { name: "Time" }).textContent()) * 1000);
const numberOf = async (locator) => Number.parseFloat(await locator.textContent());

async function hasNoFindings(page, what) {
  await page.evaluate(axe);
  const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
  assert.ok(wide <= 0, `${what} is ${wide} pixels too wide`);
  const found = await page.evaluate(() => window.axe.run(document));
  assert.deepStrictEqual(found.violations.map((one) => `${what}: ${one.id} ${one.nodes.map((node) => node.html.slice(0, 160))}`), []);
}

// The upper floor is 60000 increments from zero; 150 mm a turn of 4096 increments.
test("a hoist stands at its floor, in the user's unit; its cage, switches and limits are where they are", { skip }, () =>
  meet(`${examples}/hoist/hoist.toml`, async (page, server) => {
    const hoist = figure(page, "hoist");
    await hoist.waitFor();
    assert.strictEqual(await numberOf(hoist), 0);
    assert.match(await hoist.textContent(), /^0\.00 mm/);
    const status = await page.locator(".words").first().textContent();
    assert.match(status, /power-on/, "at 0 s nothing has been looked at");
    await standAt(server, page, 5500);
    const ms = await timeOf(page);
    await page.getByRole("tab", { name: "Watch" }).click();
    await page.getByRole("searchbox").fill("ActPos_Mot");
    const row = page.getByRole("table", { name: "Watch" }).getByRole("row", { name: "hoist.ActPos_Mot" });
    await row.waitFor();
    await until(async () => Number.isFinite(await numberOf(row.getByRole("cell").first())), "no value of H511");
    const count = await numberOf(row.getByRole("cell").first());
    await page.getByRole("tab", { name: "Plant" }).click();
    assert.strictEqual(await timeOf(page), ms);
    const mm = Number(((count * 150) / 4096).toFixed(2));
    await until(async () => (await numberOf(hoist)) === mm, `it is not at ${mm} mm`);
    // The example has the second call at 6 s; whether the run stops before it is the clock's matter.
    if (ms < 6000) assert.strictEqual(mm, 2197.27);
    // The cage is drawn between 0 mm and 2500 mm as the text says: the scale is in the picture, too.
    const places = () => hoist.evaluate((element) => {
      const place = (text) => {
        const label = [...element.querySelectorAll("text.small")].find((one) => one.textContent === text);
        return label.getBoundingClientRect().top + label.getBoundingClientRect().height / 2;
      };
      const cage = element.querySelector(".car rect").getBoundingClientRect();
      const zones = [...element.querySelectorAll(".mark.switch .zone")].map((one) => one.getBoundingClientRect());
      return { zero: place("0"), top: place("2500"), cage: cage.bottom, lower: zones.sort((a, b) => b.top - a.top)[0].top };
    });
    // The reference travel has made the edge of the lower limit switch the zero (P903 = 4), 8000 increments below power-on.
    await until(async () => {
      const { zero, top, cage, lower } = await places();
      const expected = zero - ((zero - top) * mm) / 2500;
      return Math.abs(lower - zero) < 4 && Math.abs(cage - expected) < 4;
    }, `the cage or the lower switch is drawn elsewhere: ${JSON.stringify(await places())}`);
    // A limit switch that is reached is seen.
    assert.strictEqual(await hoist.locator(".reached").count(), 0);
    const forced = button(page, "Force hoist DI04");
    await forced.click();
    await page.getByRole("button", { name: "Force hoist DI04", pressed: true }).waitFor();
    await page.getByRole("switch", { name: "hoist DI04" }).click();
    await hoist.locator(".reached").getByText("DI04 /LIM. SWITCH CW").waitFor();
    assert.strictEqual(await hoist.locator(".mark.switch.on").count(), 1);
    await forced.click();
    await until(async () => (await hoist.locator(".reached").count()) === 0, "the switch stays");
    for (const colorScheme of ["dark", "light"]) {
      await page.emulateMedia({ colorScheme });
      await hasNoFindings(page, colorScheme);
    }
    await page.setViewportSize(phone);
    await until(async () => (await hoist.boundingBox()).width < 380, "it does not get smaller");
    await hasNoFindings(page, "phone");
  }),
);

test("parts ride on the conveyor and light the barrier; every kind is drawn and turns", { skip }, () =>
  meet("belt.toml", async (page, server) => {
    const belt = figure(page, "belt");
    await belt.waitFor();
    const part = belt.locator("rect.part");
    assert.strictEqual(await part.count(), 1);
    assert.strictEqual(await belt.locator(".mark.barrier.on").count(), 0);
    const level = async () => (await page.getByRole("switch", { name: "belt DI10" }).getAttribute("aria-checked")) === "true";
    // Where the part is drawn follows from where the server says it is; where that is, from the position.
    await page.getByRole("combobox", { name: "Speed" }).selectOption("0.1");
    await button(page, "Run").click();
    await until(level, "the barrier sees no part");
    await button(page, "Pause").click();
    await until(async () => (await page.locator(".clock .lamp.on").count()) === 0, "it does not stand");
    // The parts are looked at one millisecond before the position of now, 0.1 mm at 1500 rpm.
    let front = 0;
    await until(async () => {
      front = Number(await part.getAttribute("data-front"));
      return Math.abs(front - 45 - (await numberOf(belt))) < 0.11;
    }, "the part does not go with the belt");
    const covered = front >= 50 && front <= 55;
    await until(async () => (await level()) === covered, `the barrier is wrong for a part at ${front} mm`);
    await until(async () => (await belt.locator(".mark.barrier.on").count()) === (covered ? 1 : 0), "the barrier is drawn wrong");
    if (covered) assert.match(await belt.locator(".reached").textContent(), /DI10/);
    for (const [name, text] of [
      ["blower", "0.000 turns"],
      ["reel", "0.000 turns"],
      ["table", "0.00 deg"],
    ]) {
      assert.ok((await figure(page, name).textContent()).startsWith(text), name);
      assert.strictEqual(await figure(page, name).locator("svg").count(), 1, name);
    }
    await page.setViewportSize(phone);
    await hasNoFindings(page, "phone");
    await standAt(server, page, 1500);
    await until(async () => (await part.count()) === 0, "it has not fallen off");
  }),
);

// A layer more a turn: between the core (6 of the picture) and the full roll (18) the radius grows with the travel of 60 m.
test("the roll of a winder grows with its travel", { skip }, () =>
  meet(`${examples}/winder/winder.toml`, async (page, server) => {
    const roll = figure(page, "takeup");
    await roll.waitFor();
    assert.strictEqual(await roll.locator("circle.web").count(), 0, "it is not bare at first");
    let before = 6;
    for (const ms of [4000, 14_000]) {
      await standAt(server, page, ms);
      await until(async () => Math.abs(Number(await roll.locator("circle.web").first().getAttribute("r")) - 6 - (12 * (await numberOf(roll))) / 60) < 0.02, `the roll has another radius at ${ms} ms`);
      const radius = Number(await roll.locator("circle.web").first().getAttribute("r"));
      assert.ok(radius > before, `it does not grow: ${radius}`);
      before = radius;
    }
    await standAt(server, page, 60_000);
    await until(async () => (await roll.locator("circle.web").first().getAttribute("r")) === "18.00", "it never gets full");
    await hasNoFindings(page, "winder");
  }),
);

test("64 stations: compact rows, search, only what is not well, cards at a click, by keyboard too", { skip }, () =>
  meet("many.toml", async (page, server) => {
    const table = page.getByRole("table", { name: "Stations" });
    await table.waitFor();
    assert.strictEqual(await table.getAttribute("aria-rowcount"), "66");
    const high = await page.evaluate(() =>
      Math.max(...[document.documentElement, ...document.querySelectorAll(".pane, .view")].map((element) => element.scrollHeight)),
    );
    assert.ok(high < 2 * desktop.height, `${high} pixels high`);
    const nodes = await page.evaluate(() => document.querySelectorAll("[role=tabpanel]:not([hidden]) *").length);
    assert.ok(nodes < 900, `${nodes} elements`);
    assert.strictEqual(await table.getByRole("row", { name: "axis64" }).count(), 0);
    await page.locator(".stations-table").evaluate((box) => box.scrollTo(0, box.scrollHeight));
    await table.getByRole("row", { name: "axis64" }).waitFor();
    await standAt(server, page, 1200);
    await page.getByRole("checkbox", { name: "Only what is not well" }).check();
    // The one with a direction that is inhibited, the one with the fault, the line without telegrams and the station on it.
    const names = async () => (await table.locator("tbody th").allTextContents()).map((text) => text.trim());
    await until(async () => (await names()).join() === "sbus,axis01,axis40,axis50", `${await names()} are not well`);
    await table.getByRole("row", { name: "axis50" }).getByText("fault 26").waitFor();
    await table.getByRole("row", { name: "axis40" }).getByText("DI00").waitFor();
    await table.getByRole("row", { name: "sbus" }).getByText("silent").waitFor();
    await page.getByRole("checkbox", { name: "Only what is not well" }).uncheck();
    const search = page.getByRole("searchbox", { name: "Search stations" });
    await search.fill("axis33");
    await until(async () => (await names()).join() === "axis33", "the search finds others");
    await button(table, "axis33").focus();
    await page.keyboard.press("Enter");
    const card = page.getByRole("region", { name: "axis33", exact: true });
    await card.getByRole("switch", { name: "axis33 DI00" }).click();
    await until(async () => (await card.getByRole("switch", { name: "axis33 DI00" }).getAttribute("aria-checked")) === "true", "not switched");
    // Terminals that nobody uses are folded, and are there.
    assert.strictEqual(await card.getByRole("switch", { name: "axis33 DI17" }).count(), 0);
    await card.getByText("unused terminals").click();
    await card.getByRole("switch", { name: "axis33 DI17" }).click();
    await until(async () => (await card.getByRole("switch", { name: "axis33 DI17" }).getAttribute("aria-checked")) === "true", "not switched");
    await hasNoFindings(page, "table");
    await page.setViewportSize(phone);
    await hasNoFindings(page, "phone");
    for (const one of await card.locator("button, input, [role=switch]").all()) {
      const box = await one.boundingBox();
      assert.ok(box && box.x >= 0 && box.x + box.width <= phone.width, `out of reach: ${await one.getAttribute("aria-label")}`);
    }
    await page.reload();
    await page.getByRole("region", { name: "axis33", exact: true }).waitFor();
    await button(page, "Cards").click();
    await page.getByRole("region", { name: "axis02", exact: true }).waitFor();
    await button(page, "Table").click();
    await button(page, "Close card of axis33").click();
    await until(async () => (await page.getByRole("region", { name: "axis33", exact: true }).count()) === 0, "the card stays");
  }),
);

// The clock of the page is the test's: half of the time between two states is half of the way.
test("between two states it moves on a straight way; at a pause, and for who wants no motion, it stands exactly", { skip: missing ?? false }, async () => {
  for (const reducedMotion of ["no-preference", "reduce"]) {
    const mock = await startMock();
    const context = { reducedMotion };
    const opened = await openPage(browser ?? (browser = await launch()), "about:blank", context);
    const { page } = opened;
    try {
      await page.clock.install({ time: 0 });
      await page.goto(mock.address);
      await figure(page, "lift").waitFor();
      await page.clock.pauseAt(10_000);
      const cage = figure(page, "lift").locator(".car");
      const y = async () => Number((await cage.getAttribute("transform")).match(/ ([-\d.]+)\)/)[1]);
      const now = async (us, running) =>
        mock.announce({ event: "time", us, running, speed: 1, rate: 1, generation: 1, over: false, stopped: null });
      const at = (shaft) =>
        mock.announce({
          event: "plant",
          us: 0,
          stations: { lift: { in: 0, forced: 0, out: 0, powered: true, state: "", enabled: true, why: "", fault: 0, position: shaft, machine: { shaft } } },
        });
      const text = async (mm) => until(async () => (await numberOf(figure(page, "lift"))) === mm, `it is not at ${mm} mm`);
      await now(0, true);
      at(0);
      await text(0);
      await page.clock.runFor(100);
      const begin = await y();
      // 40 mm a turn: 1000 mm are 25 turns. 100 ms later than the state before.
      at(25 * 4096);
      await text(1000);
      if (reducedMotion === "no-preference") assert.strictEqual(await y(), begin);
      await page.clock.runFor(50);
      const half = await y();
      await page.clock.runFor(100);
      const end = await y();
      assert.ok(begin - end > 80, `from ${begin} to ${end}`);
      if (reducedMotion === "reduce") assert.strictEqual(half, end);
      else assert.ok(Math.abs(half - (begin + end) / 2) < (begin - end) / 5, `${half} is not half way from ${begin} to ${end}`);
      // A pause in the middle of a way: there at once.
      at(0);
      await text(0);
      await now(0, false);
      await until(async () => (await y()) === begin, "it is not where the text says");
      assert.deepStrictEqual(opened.errors, []);
    } finally {
      await opened.close();
      await mock.stop();
    }
  }
});

// A frame of 8 bytes takes some 0.2 ms at 500 kbit/s, which at the speed 0.001 is 0.2 s on the page.
test("telegrams run along the line in slow motion; one is read by a click; a cable is cut", { skip }, () =>
  meet(`${examples}/scom/scom.toml`, async (page, server) => {
    await standAt(server, page, 100);
    await page.getByRole("combobox", { name: "Speed" }).selectOption("0.001");
    await button(page, "Run").click();
    const dot = page.locator("g.telegram:not([style*='none'])").first();
    const seen = new Set();
    let text = "";
    await until(async () => {
      const now = await page.evaluate(() => {
        const one = [...document.querySelectorAll("g.telegram")].find((group) => group.style.display !== "none");
        return one && { x: one.querySelector("circle").getAttribute("cx"), label: one.getAttribute("aria-label") };
      });
      if (now) {
        if (text !== now.label) seen.clear();
        text = now.label;
        seen.add(now.x);
      }
      return seen.size > 2;
    }, "no telegram moves");
    await until(async () => {
      await dot.dispatchEvent("pointerdown", {}, { timeout: 5000 }).catch(() => undefined);
      return (await page.locator(".telegram-words").textContent()) !== "";
    }, "none can be read");
    const words = await page.locator(".telegram-words").textContent();
    assert.match(words, /^0\.1\d\d s sbus, unit[12]: /);
    await button(page, "Pause").click();
    // The trace has the same telegram, in the same words.
    await page.getByRole("tab", { name: "Bus" }).click();
    const row = page.getByRole("table", { name: "Telegrams" }).getByRole("row").filter({ hasText: words.match(/: (.*?) [0-9A-F]{2} /)[1] });
    await row.first().waitFor();
    await page.getByRole("tab", { name: "Plant" }).click();
    await page.getByRole("button", { name: "Cut unit1 from sbus" }).click();
    await page.getByRole("button", { name: "Cut unit1 from sbus", pressed: true }).waitFor();
    await hasNoFindings(page, "slow motion");
  }),
);

test("what happens here is told, and what is planned before it comes", { skip }, () =>
  meet(`${examples}/hoist/hoist.toml`, async (page, server) => {
    const story = page.getByRole("group").filter({ hasText: "What happens here" });
    await story.getByText("The cabin stands 8000 increments above the lower limit switch").waitFor();
    await story.getByText("4.000 s hoist.DI10 = 1 for 100 ms, every 4 s").waitFor();
    const planned = page.getByRole("status", { name: "Planned" });
    await standAt(server, page, 1900);
    assert.strictEqual(await planned.textContent(), "");
    await standAt(server, page, 2100);
    await until(async () => (await planned.textContent()) === "Planned at 4.000 s: hoist.DI10 = 1 for 100 ms", "it is not announced");
    await standAt(server, page, 4200);
    await until(async () => /^Planned at 6\.000 s: hoist\.DI11/.test(await planned.textContent()), "the next one is not announced");
    await story.getByText("What happens here").click();
    await page.reload();
    await story.waitFor();
    assert.strictEqual(await story.getAttribute("open"), null, "it opens again by itself");
    await hasNoFindings(page, "the story");
  }),
);
