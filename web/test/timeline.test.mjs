// The timeline: dragged over the examples every view shows that moment; marks lead there; running on drops what came later.
//   IPOS_PROGRAM=.../ipos node --test test/timeline.test.mjs
// IPOS_TIMELINE=all drags over all examples and prints how long it takes.
import assert from "node:assert";
import { cpSync, mkdtempSync, readdirSync, readFileSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";

import { desktop, launch, missing, openPage, phone } from "./browser.mjs";
import { examples, folderOf, program, serve, standAt } from "./serve.mjs";

const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const skip = missing ?? (program ? false : "IPOS_PROGRAM does not name the ipos to test");

let browser;
before(async () => {
  if (!skip) browser = await launch();
});
after(() => browser?.close());

async function meet(file, folder, use, options = {}) {
  const server = await serve(file, options.serve ?? [], folder);
  const opened = await openPage(browser, server.address, options);
  try {
    await opened.page.getByRole("slider", { name: "Timeline" }).waitFor();
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
    await new Promise((done) => setTimeout(done, 40));
  }
  assert.fail(text);
}

const button = (page, name) => page.getByRole("button", { name, exact: true });
const slider = (page) => page.getByRole("slider", { name: "Timeline" });
const timer = (page) => page.getByRole("timer", { name: "Time" });
const seconds = (ms) => `${(ms / 1000).toFixed(3)} s`;
const shows = (page, ms) => until(async () => (await timer(page).textContent()) === seconds(ms), `the time is not ${seconds(ms)}`);
const valueOf = async (page) => Number(await slider(page).getAttribute("aria-valuenow"));
const marks = (page) => page.getByRole("list", { name: "Marks" }).getByRole("listitem");

// In the page: drags to a moment, as an input event says it, and waits until the timer and what the views show are those of it.
async function drag(page, ms, shown) {
  return page.evaluate(
    async ([to, text]) => {
      const input = document.querySelector('input[type="range"][aria-label="Timeline"]');
      const there = () =>
        document.querySelector('[role="timer"]').textContent === `${(to / 1000).toFixed(3)} s` &&
        (text === null || document.querySelector("main").textContent === text);
      const began = performance.now();
      Object.getOwnPropertyDescriptor(HTMLInputElement.prototype, "value").set.call(input, String(to));
      input.dispatchEvent(new Event("input", { bubbles: true }));
      while (!there()) {
        if (performance.now() - began > 30000) throw new Error(`not there: ${to} ms, ${document.querySelector('[role="timer"]').textContent}`);
        await new Promise((done) => setTimeout(done, 1));
      }
      return performance.now() - began;
    },
    [ms, shown],
  );
}

// The trace asks twice a second for what is new.
async function standingText(page) {
  let before;
  let same = 0;
  for (let n = 0; n < 100 && same < 3; ++n) {
    const now = await page.locator("main").textContent();
    same = now === before ? same + 1 : 0;
    if (same === 3) return now;
    before = now;
    await new Promise((done) => setTimeout(done, 250));
  }
  throw new Error("the views do not stand");
}

// The moments in an order that goes far back and far on.
async function dragAbout(page, tab) {
  await page.getByRole("tab", { name: tab }).click();
  const end = await valueOf(page);
  const moments = [0.02, 0.93, 0.31, 0.77, 0.12, 0.55].map((part) => Math.round(end * part));
  const shown = new Map();
  for (const ms of moments) {
    await drag(page, ms, null);
    shown.set(ms, await standingText(page));
  }
  const took = [];
  for (const ms of [...moments].reverse().concat(moments)) took.push(await drag(page, ms, shown.get(ms)));
  await drag(page, end, null);
  return took;
}

const all = process.env.IPOS_TIMELINE === "all";
const chosen = all ? readdirSync(examples).filter((name) => !name.includes(".")) : ["hoist", "gateway"];

test("dragging shows every moment as it was, in all views", { skip }, async (t) => {
  const place = mkdtempSync(join(tmpdir(), "ipos-timeline-"));
  cpSync(examples, place, { recursive: true });
  const took = [];
  try {
    for (const name of chosen) {
      const file = readdirSync(join(place, name), { withFileTypes: true }).map((entry) => entry.name).find((one) => /^[^.]+\.toml$/.test(one));
      if (!file) continue;
      await meet(file, join(place, name), async (page, server) => {
        await standAt(server, page, 4000);
        const mine = [];
        for (const tab of all ? ["Plant", "Watch", "Program", "Bus"] : ["Plant", "Bus"]) mine.push(...(await dragAbout(page, tab)));
        mine.sort((a, b) => a - b);
        took.push(...mine);
        t.diagnostic(`${name}: median ${mine[mine.length >> 1].toFixed(0)} ms, worst ${mine[mine.length - 1].toFixed(0)} ms of ${mine.length}`);
      });
    }
  } finally {
    rmSync(place, { recursive: true });
  }
  took.sort((a, b) => a - b);
  t.diagnostic(`all: median ${took[took.length >> 1].toFixed(0)} ms, worst ${took[took.length - 1].toFixed(0)} ms of ${took.length}`);
});

// DI05 is /EXT. FAULT: without voltage it is F26 (MDX60B/61B, list of errors). A second station, to be touched later.
const plant_text = `
[[bus]]
name = "sbus"
kind = "can"
baud = 500000
[[station]]
name = "belt"
unit = "mdxb"
program = "BELT.IPC"
sbus = "sbus"
[station.parameters]
P604 = 11
P610 = 16
P611 = 16
P612 = 16
P881 = 1
[station.inputs]
DI05 = 1
[[stimulus]]
station = "belt"
at = "3s"
input = "DI05"
set = 0
`;
const program_text = `long lCount;
main()
{
  while (1)
  {
    lCount++;
    _Wait(1);
  }
}
`;
const belt = () => folderOf({ "belt.toml": plant_text, "BELT.IPC": program_text });

test("keys, marks, clicks that come again, and clicks that are dropped", { skip }, async () => {
  const place = belt();
  try {
    await meet("belt.toml", place.folder, async (page, server) => {
      const axis = slider(page);
      assert.strictEqual(await valueOf(page), 0);
      await standAt(server, page, 1000);
      const clicked = await valueOf(page);
      const input = page.getByRole("switch", { name: "belt DI10" });
      await input.click();
      const mark = marks(page).filter({ hasText: /DI10/ });
      await mark.waitFor();
      assert.strictEqual(await mark.textContent(), `${seconds(clicked)} DI10`);
      await standAt(server, page, 3500);
      const end = await valueOf(page);
      assert.strictEqual(Number(await axis.getAttribute("max")), end);
      assert.strictEqual(await axis.getAttribute("aria-valuetext"), seconds(end));
      await marks(page).getByText("3.000 s F26").waitFor();

      // By the keyboard alone.
      await axis.focus();
      for (const [key, by] of [["ArrowLeft", -1], ["PageDown", -100], ["ArrowRight", 1], ["PageUp", 100], ["ArrowDown", -1], ["ArrowUp", 1]]) {
        const before = await valueOf(page);
        await page.keyboard.press(key);
        await until(async () => (await valueOf(page)) === before + by, `${key} leads somewhere else`);
        await shows(page, before + by);
      }
      await page.keyboard.press("Home");
      await shows(page, 0);
      await until(async () => (await input.getAttribute("aria-checked")) === "false", "DI10 is on at 0 s");
      await page.keyboard.press("End");
      await shows(page, end);
      await until(async () => (await input.getAttribute("aria-checked")) === "true", "the click is not done again");

      // A mark leads to its moment.
      await marks(page).getByText("3.000 s F26").press("Enter");
      await shows(page, 3000);
      await page.getByRole("region", { name: "belt", exact: true }).getByText(/Fault 26/).waitFor();
      await page.getByRole("combobox", { name: "Show marks" }).selectOption("click");
      assert.deepStrictEqual(await marks(page).allTextContents(), [`${seconds(clicked)} DI10`]);
      await page.getByRole("combobox", { name: "Show marks" }).selectOption("");
      await mark.getByRole("button").click();
      await shows(page, clicked);
      assert.strictEqual(await mark.getByRole("button").getAttribute("aria-current"), "time");

      // Only looked at: nothing is lost. Run on from before the click: it is.
      assert.strictEqual(Number(await axis.getAttribute("max")), end);
      await drag(page, clicked - 500, null);
      await page.getByText("drops 1 click").waitFor();
      await button(page, "Step").click();
      await shows(page, clicked - 499);
      await page.getByRole("status").getByText(/1 click after .* dropped/).waitFor();
      await until(async () => (await mark.count()) === 0, "the mark of the click stays");
      assert.strictEqual(Number(await axis.getAttribute("max")), clicked - 499);
      await standAt(server, page, clicked + 100);
      assert.strictEqual(await input.getAttribute("aria-checked"), "false");
    });
  } finally {
    place.remove();
  }
});

test("the scope, the source and the watch follow; without copies it is the same", { skip }, async () => {
  const place = belt();
  try {
    await meet(
      "belt.toml",
      place.folder,
      async (page, server) => {
        await standAt(server, page, 2000);
        const end = await valueOf(page);
        await page.getByRole("tab", { name: "Watch" }).click();
        const count = page.getByRole("row", { name: "belt.lCount" }).getByRole("cell").first();
        await standingText(page);
        const at_end = await count.textContent();
        await drag(page, 1200, null);
        await standingText(page);
        const at_1200 = await count.textContent();
        assert.ok(Number(at_1200) < Number(at_end), "the watch stays");
        await page.getByRole("tab", { name: "Program" }).click();
        await page.locator('[aria-current]:not(nav *)').first().waitFor();
        await drag(page, end, null);
        await page.getByRole("tab", { name: "Watch" }).click();
        await until(async () => (await count.textContent()) === at_end, "going on does not repeat the run");
        for (let ms = 100; ms <= 1200; ms += 50) void drag(page, ms, null).catch(() => undefined);
        await drag(page, 1200, null);
        await until(async () => (await count.textContent()) === at_1200, "not the same moment");
        await button(page, "Pause").click();
      },
      { serve: ["--no-snapshots"] },
    );
  } finally {
    place.remove();
  }
});

for (const [name, viewport] of [["desktop", desktop], ["phone", phone]])
  test(`${name}: axe-core finds nothing in it, and nothing is cut off`, { skip }, async () => {
    const place = belt();
    try {
      await meet(
        "belt.toml",
        place.folder,
        async (page, server) => {
          await standAt(server, page, 1000);
          for (const input of ["DI10", "DI11", "DI12"]) {
            await page.getByRole("switch", { name: `belt ${input}` }).click();
            await button(page, "Step").click();
          }
          await marks(page).getByText("DI12").waitFor();
          await page.evaluate(axe);
          const found = await page.evaluate(() => window.axe.run(document.querySelector(".timeline")));
          assert.deepStrictEqual(found.violations.map((one) => `${one.id}: ${one.nodes[0].html}`), []);
          assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), "the page is wider than the screen");
        },
        { viewport },
      );
    } finally {
      place.remove();
    }
  });
