// Views side by side before the mock server: split, desk, dragged and moved by keys, borders, closed, kept; the keys that
// depend on where the focus came from; one column on a phone.
import assert from "node:assert";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { after, before, test } from "node:test";
import { fileURLToPath } from "node:url";

import { build } from "esbuild";

import { startMock } from "../mock/server.mjs";
import { desktop, launch, missing, openPage, phone, tab_names } from "./browser.mjs";

const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const skip = missing ?? false;
let browser;

before(async () => {
  if (!skip) browser = await launch();
});
after(() => browser?.close());

async function meet(use, { after: ending = "", ...options } = {}) {
  const mock = await startMock();
  const opened = await openPage(browser, mock.address + ending, options);
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

// A part of the page that needs no document.
async function bundled(file) {
  const entry = fileURLToPath(new URL(`../src/${file}`, import.meta.url));
  const { outputFiles } = await build({ entryPoints: [entry], bundle: true, format: "esm", write: false });
  return import(`data:text/javascript;base64,${Buffer.from(outputFiles[0].contents).toString("base64")}`);
}

const region = (page, name) => page.getByRole("region", { name, exact: true });
const button = (page, name) => page.getByRole("button", { name, exact: true });

async function split(page, name, side) {
  await button(page, "Split").click();
  if (side) await page.getByRole("menuitemradio", { name: side }).click();
  await page.getByRole("menuitem", { name }).click();
  await region(page, name).waitFor();
}

// The views that are open, in the order in which they are read.
const open = (page) => page.locator("main > .pane:not([hidden])").evaluateAll((panes) => panes.map((pane) => pane.getAttribute("aria-label")));
const opens = (page, ...views) => until(async () => (await open(page)).join() === views.join(), `not ${views.join()}`);
const focusedIn = (page) => page.evaluate(() => document.activeElement?.closest(".pane")?.getAttribute("aria-label"));

// Whether the boxes lie so: "left", "above" of each other.
async function lies(page, one, side, other) {
  const [a, b] = [await region(page, one).boundingBox(), await region(page, other).boundingBox()];
  return side === "left" ? a.x + a.width <= b.x + 1 : a.y + a.height <= b.y + 1;
}

test("split adds a view, a tab shows its own where it is or in the pane that was used last, the layout is kept", { skip }, () =>
  meet(async (page, mock) => {
    assert.strictEqual(await page.getByRole("tabpanel").count(), 1);
    assert.strictEqual(await page.getByRole("separator").count(), 0);
    await split(page, "Watch");
    await opens(page, "Plant", "Watch");
    assert.ok(await lies(page, "Plant", "left", "Watch"));
    await until(async () => (await focusedIn(page)) === "Watch", "the focus does not go to the new view");
    assert.strictEqual(await page.getByRole("tab", { selected: true }).textContent(), "Watch");
    // By Plant's focus Journal comes there; Watch stays.
    await region(page, "Plant").getByRole("switch", { name: "saw DI00" }).click();
    await page.getByRole("tab", { name: "Journal" }).click();
    await opens(page, "Journal", "Watch");
    await page.getByRole("tab", { name: "Watch" }).click();
    await opens(page, "Journal", "Watch");
    await until(async () => (await focusedIn(page)) === "Watch", "the focus does not go to the view that is open");
    // Arrows in the tabs take no view away.
    await page.getByRole("tab", { name: "Watch" }).focus();
    await page.keyboard.press("ArrowRight");
    assert.strictEqual(await page.evaluate(() => document.activeElement.textContent), "Scope");
    assert.deepStrictEqual(await open(page), ["Journal", "Watch"]);
    await split(page, "Bus", "Below");
    await opens(page, "Journal", "Watch", "Bus");
    assert.ok(await lies(page, "Watch", "above", "Bus"));
    // All that is open is remembered, and nothing else than the address says which one was used last.
    await until(() => JSON.stringify(mock.plant.settings["desk.layout"] ?? null).includes("Bus"), "not kept");
    mock.received.length = 0;
    await page.reload();
    await until(async () => (await open(page)).join() === "Journal,Watch,Bus", "the layout is lost");
    // What the views ask before the server has come waits for it.
    await until(() => mock.received.some((one) => one.do === "bus.trace"), "nothing is asked");
    assert.deepStrictEqual(await page.getByRole("alert").allTextContents(), []);
    assert.strictEqual(await page.getByRole("tab", { selected: true }).textContent(), "Bus");
    for (const name of ["Journal", "Bus"]) await button(page, `Close ${name}`).click();
    await page.getByRole("tabpanel").waitFor();
    assert.strictEqual(await page.getByRole("tabpanel").count(), 1);
    assert.strictEqual(await page.getByRole("tab", { selected: true }).textContent(), "Watch");
    await until(() => mock.plant.settings["desk.layout"] === null, "one view is no layout");
  }),
);

test("desk: by its button, its key and its address; program left, plant and scope right", { skip }, async () => {
  const isDesk = async (page) => {
    await region(page, "Program").waitFor();
    assert.deepStrictEqual(await open(page), ["Program", "Plant", "Scope"]);
    assert.ok(await lies(page, "Program", "left", "Plant"));
    assert.ok(await lies(page, "Program", "left", "Scope"));
    assert.ok(await lies(page, "Plant", "above", "Scope"));
  };
  await meet(async (page) => {
    await button(page, "Desk").click();
    await isDesk(page);
  });
  for (const ending of ["#Desk", "&desk"])
    await meet(
      async (page, mock) => {
        await isDesk(page);
        // What is done afterwards stays over a reload.
        await button(page, "Close Program").click();
        await page.reload();
        await until(async () => (await open(page)).join() === "Plant,Scope", "the desk comes again");
        // Who asks for the desk gets it, whatever was kept.
        await page.goto("about:blank");
        await page.goto(mock.address + ending);
        await isDesk(page);
      },
      { after: ending },
    );
  await meet(
    async (page) => {
      assert.deepStrictEqual(await page.getByRole("tab", { selected: true }).allTextContents(), ["Plant"]);
      await page.evaluate(() => (location.hash = "#Scope"));
      await until(async () => (await page.getByRole("tab", { selected: true }).textContent()) === "Scope", "a link in the page does nothing");
    },
    { after: "#Nowhere" },
  );
});

test("views move by pointer and by keys, and keep what they hold", { skip }, () =>
  meet(async (page) => {
    // Of browsers that take an element out to move it.
    await page.addInitScript(() => {
      for (const kind of [Element, Document, DocumentFragment]) delete kind.prototype.moveBefore;
    });
    await page.reload();
    await button(page, "Desk").click();
    const grip = (name) => button(page, `Move ${name}`);
    const dropAt = async (name, x, y, source = grip(name), on = "Scope") => {
      const from = await source.boundingBox();
      const to = await region(page, on).boundingBox();
      await page.mouse.move(from.x + 20, from.y + 8);
      await page.mouse.down();
      await page.mouse.move(to.x + to.width * x, to.y + to.height * y, { steps: 5 });
      assert.strictEqual(await page.locator(".drop-zone").count(), 1);
      await page.mouse.up();
      assert.strictEqual(await page.locator(".drop-zone").count(), 0);
    };
    await region(page, "Plant").getByRole("textbox").first().fill("4711");
    await region(page, "Plant").locator(".view").evaluate((view) => {
      view.scrollTop = 40;
      view.querySelector(".station").dataset.same = "yes";
    });
    const scrolled = (name) => region(page, name).locator(".view").evaluate((view) => view.scrollTop);
    await region(page, "Scope").locator(".view").evaluate((view) => (view.scrollTop = 20));
    const holds = async () => {
      assert.strictEqual(await scrolled("Scope"), 20, "the scope has lost its place");
      const view = region(page, "Plant").locator(".view");
      assert.strictEqual(await view.evaluate((one) => one.scrollTop), 40);
      assert.strictEqual(await view.locator('[data-same="yes"]').count(), 1);
      assert.strictEqual(await view.getByRole("textbox").first().inputValue(), "4711");
    };
    // To the left of the scope, into the middle of the program, to the side of the whole.
    await dropAt("Plant", 0.1, 0.5);
    await until(() => lies(page, "Plant", "left", "Scope"), "it does not come to the left");
    await holds();
    await dropAt("Plant", 0.5, 0.5, grip("Plant"), "Program");
    await opens(page, "Plant", "Program", "Scope");
    await holds();
    await grip("Scope").focus();
    await page.keyboard.press("ArrowLeft");
    await opens(page, "Plant", "Scope", "Program");
    await until(() => grip("Scope").evaluate((one) => one === document.activeElement), "the title loses the focus");
    await page.keyboard.press("ArrowDown");
    await opens(page, "Plant", "Program", "Scope");
    assert.ok((await lies(page, "Plant", "above", "Scope")) && (await lies(page, "Program", "above", "Scope")));
    await holds();
    await dropAt("Plant", 0.5, 0.5);
    await opens(page, "Scope", "Program", "Plant");
    await holds();
    await dropAt("Scope", 0.5, 0.5, grip("Scope"), "Plant");
    await opens(page, "Plant", "Program", "Scope");
    await holds();
    // A tab is dragged as well, and Escape gives up.
    await dropAt("Bus", 0.5, 0.9, page.getByRole("tab", { name: "Bus" }), "Plant");
    await opens(page, "Plant", "Bus", "Program", "Scope");
    assert.ok(await lies(page, "Plant", "above", "Bus"));
    assert.ok(await lies(page, "Bus", "left", "Program"));
    const before = await open(page);
    const from = await grip("Bus").boundingBox();
    await page.mouse.move(from.x + 20, from.y + 8);
    await page.mouse.down();
    await page.mouse.move(from.x + 20, from.y - 200, { steps: 3 });
    await page.keyboard.press("Escape");
    await page.mouse.up();
    assert.deepStrictEqual(await open(page), before);
  }),
);

test("borders are separators, moved by arrows and by pointer", { skip }, () =>
  meet(async (page, mock) => {
    await button(page, "Desk").click();
    const border = page.getByRole("separator", { name: "Between Program and Plant" });
    assert.strictEqual(await border.getAttribute("aria-orientation"), "vertical");
    assert.strictEqual(await border.getAttribute("aria-valuenow"), "50");
    const width = async () => (await region(page, "Program").boundingBox()).width;
    const before = await width();
    await border.focus();
    await page.keyboard.press("ArrowRight");
    await page.keyboard.press("ArrowRight");
    assert.strictEqual(await border.getAttribute("aria-valuenow"), "54");
    assert.ok(Math.abs((await width()) - before - 0.04 * desktop.width) < 3);
    await page.keyboard.press("Home");
    assert.strictEqual(await border.getAttribute("aria-valuenow"), await border.getAttribute("aria-valuemin"));
    await page.keyboard.press("End");
    assert.strictEqual(await border.getAttribute("aria-valuenow"), await border.getAttribute("aria-valuemax"));
    const box = await border.boundingBox();
    await page.mouse.move(box.x + 4, box.y + 200);
    await page.mouse.down();
    await page.mouse.move(400, 300, { steps: 4 });
    await page.mouse.up();
    assert.ok(Math.abs((await width()) - 400) < 6, "it is not where the pointer left it");
    const inner = page.getByRole("separator", { name: "Between Plant and Scope" });
    assert.strictEqual(await inner.getAttribute("aria-orientation"), "horizontal");
    await inner.focus();
    await page.keyboard.press("ArrowUp");
    assert.strictEqual(await inner.getAttribute("aria-valuenow"), "48");
    await until(() => Math.abs((mock.plant.settings["desk.layout"]?.parts[0].share ?? 0) - 400 / desktop.width) < 0.01, "the size is not kept");
  }),
);

test("keys: Space after a click, of a switch reached by Tab; two views with one key; split, next and close", { skip }, () =>
  meet(async (page, mock) => {
    await button(page, "Run").click();
    const runs = (whether) => until(async () => (await page.locator(".clock .lamp.on").count()) === (whether ? 1 : 0) && mock.plant.running === whether, `it ${whether ? "stands" : "runs"}`);
    await runs(true);
    await page.keyboard.press(" ");
    await runs(false);
    const input = page.getByRole("switch", { name: "saw DI00" });
    await input.click();
    await until(async () => (await input.getAttribute("aria-checked")) === "true", "not switched");
    await page.keyboard.press(" ");
    await runs(true);
    assert.strictEqual(await input.getAttribute("aria-checked"), "true");
    await page.keyboard.press(" ");
    await runs(false);
    await page.getByRole("button", { name: "Force saw DI00" }).focus();
    await page.keyboard.press("Shift+Tab");
    await page.keyboard.press("Shift+Tab");
    assert.ok(await input.evaluate((one) => one === document.activeElement), "Tab does not lead to the switch");
    await page.keyboard.press(" ");
    await until(async () => (await input.getAttribute("aria-checked")) === "false", "Space does not press the switch");
    assert.strictEqual(mock.plant.running, false);
    // The menu by keys alone.
    await page.keyboard.press("e");
    await page.getByRole("menu").waitFor();
    await page.keyboard.press("j");
    assert.strictEqual(await page.evaluate(() => document.activeElement.textContent), "Journal");
    await page.keyboard.press("Enter");
    await until(async () => (await open(page)).join() === "Plant,Journal", "no Journal");
    await page.keyboard.press("w");
    await until(async () => (await focusedIn(page)) === "Plant", "not the next one");
    await page.keyboard.press("W");
    await until(async () => (await focusedIn(page)) === "Journal", "not the one before");
    await page.keyboard.press("q");
    await until(async () => (await open(page)).join() === "", "Journal stays");
    await page.keyboard.press("d");
    await region(page, "Program").waitFor();
    // "i" is a step of the program and a picture of the scope.
    const steps = () => mock.received.filter((one) => one.do === "program.step").length;
    await region(page, "Program").locator(".view").click({ position: { x: 4, y: 300 } });
    await page.keyboard.press("i");
    await until(() => steps() === 1, "no step");
    await page.keyboard.press("e");
    await page.getByRole("menu").waitFor();
    await page.keyboard.press("Escape");
    assert.strictEqual(await page.getByRole("menu").count(), 0);
    await page.getByRole("tab", { name: "Scope" }).click();
    await until(async () => (await focusedIn(page)) === "Scope", "no scope");
    const [picture] = await Promise.all([page.waitForEvent("download"), page.keyboard.press("i")]);
    assert.strictEqual(picture.suggestedFilename(), "scope.png");
    assert.strictEqual(steps(), 1);
    await page.keyboard.press("?");
    const sheet = page.getByRole("dialog", { name: "Keys" });
    for (const text of ["One view more", "Close the view", "Next view", "Desk: program, plant and scope"]) await sheet.getByText(text).waitFor();
  }),
);

for (const { name, viewport, colorScheme } of [
  { name: "desktop", viewport: desktop, colorScheme: "dark" },
  { name: "phone", viewport: phone, colorScheme: "light" },
])
  test(`${name}, ${colorScheme}: seven views at once, nothing is cut off, axe-core finds nothing serious`, { skip }, () =>
    meet(
      async (page, mock) => {
        await page.evaluate(axe);
        await button(page, "Desk").click();
        for (const view of ["Watch", "Bus", "Journal", "Parameters"]) await split(page, view);
        assert.strictEqual((await open(page)).length, tab_names.length);
        await button(page, "Split").click();
        await page.getByRole("menu").getByText("All views are open").waitFor();
        const found = await page.evaluate(() => window.axe.run(document));
        const serious = found.violations.filter((one) => one.impact === "serious" || one.impact === "critical");
        assert.deepStrictEqual(serious.map((one) => `${one.id} ${one.nodes.map((node) => node.html.slice(0, 160))}`), []);
        await page.keyboard.press("Escape");
        assert.ok((await page.evaluate(() => document.documentElement.scrollWidth - innerWidth)) <= 0, "too wide");
        // Each topic has one subscription, and each view hears of it.
        await page.getByRole("button", { name: "Step" }).click();
        const topics = mock.received.filter((one) => one.do === "subscribe").map((one) => one.topic);
        assert.ok(new Set(topics).size >= tab_names.length - 1, topics.join());
        if (viewport === desktop) return;
        // One column: each view over the whole width, one below the other, each at a tap on its tab.
        const boxes = await Promise.all((await open(page)).map((view) => region(page, view).boundingBox()));
        boxes.forEach((box, position) => {
          assert.strictEqual(box.width, phone.width);
          if (position > 0) assert.ok(box.y >= boxes[position - 1].y + boxes[position - 1].height - 1);
        });
        await page.getByRole("tab", { name: "Watch" }).click();
        const row = page.getByRole("table", { name: "Watch" }).getByRole("row", { name: "lift.lWrong" });
        for (const field of [row.getByRole("textbox"), row.getByRole("button", { name: "Force" }), row.getByRole("button", { name: "Pin" })]) {
          await field.scrollIntoViewIfNeeded();
          const box = await field.boundingBox();
          assert.ok(box.width >= 24 && box.x >= 0 && box.x + box.width <= phone.width, `a field lies at ${JSON.stringify(box)}`);
        }
        await row.getByRole("textbox").fill("7");
        await row.getByRole("textbox").press("Enter");
        await until(async () => (await row.getByRole("cell").first().textContent()) === "7", "the value is not there");
      },
      { viewport, colorScheme },
    ),
  );

test("of a thousand variables the rows in sight are drawn and watched", { skip }, () =>
  meet(async (page, mock) => {
    mock.plant.variables.push(...Array.from({ length: 996 }, (_, n) => `lift.lValue${n}`));
    await page.getByRole("tab", { name: "Watch" }).click();
    const table = page.getByRole("table", { name: "Watch" });
    const row = (name) => table.getByRole("row", { name });
    await row("lift.lValue5 ").waitFor();
    await until(() => mock.plant.watched.includes("lift.lValue5"), "nothing is watched");
    const few = async () => {
      assert.strictEqual(await table.getAttribute("aria-rowcount"), "1001");
      assert.ok((await table.getByRole("row").count()) < 200 && mock.plant.watched.length < 200);
    };
    await few();
    const scroller = page.locator(".view > .scroll");
    const height = await scroller.evaluate((one) => one.scrollHeight);
    for (const [part, name] of [[1, "lift.lValue995"], [0.5, "lift.lValue495"], [0, "saw.lCount"]]) {
      await scroller.evaluate((one, to) => (one.scrollTop = to * (one.scrollHeight - one.clientHeight)), part);
      await row(name).waitFor();
      const [inner, outer] = [await row(name).boundingBox(), await scroller.boundingBox()];
      assert.ok(inner.y + inner.height > outer.y && inner.y < outer.y + outer.height, `${name} is not in sight`);
      await until(() => mock.plant.watched.includes(name), `${name} is not watched`);
      await few();
      const now = await scroller.evaluate((one) => one.scrollHeight);
      assert.ok(Math.abs(now - height) < height * 0.02, `the height jumps from ${height} to ${now}`);
    }
    // The search makes it short again, and a view that is left finds its place again.
    await page.getByRole("searchbox", { name: "Search names" }).fill("lValue99");
    await until(async () => (await table.getByRole("row").count()) === 8, "not the seven that have it");
    await page.getByRole("searchbox", { name: "Search names" }).fill("");
    await row("saw.lCount").waitFor();
    await scroller.evaluate((one) => (one.scrollTop = 5000));
    await page.getByRole("tab", { name: "Plant" }).click();
    await page.getByRole("tab", { name: "Watch" }).click();
    await until(async () => (await scroller.evaluate((one) => one.scrollTop)) === 5000, "the place is lost");
  }),
);

// The tree of panes alone, without a browser: whatever one does, each view has one place, and the places cover the whole.
test("a thousand moves leave no gap, no overlap and no view twice", async () => {
  const { bordersOf, exchange, moveBorder, place, readLayout, rectsOf, viewsOf, without } = await bundled("shell/layout.ts");
  let seed = 4711;
  const any = (list) => list[(seed = (seed * 48271) % 2147483647) % list.length];
  const sides = ["left", "right", "above", "below"];
  let layout = { view: "Plant" };
  for (let n = 0; n < 1000; ++n) {
    const open = viewsOf(layout);
    const view = any(tab_names);
    const act = any(["place", "place", "exchange", "without", "border"]);
    if (act === "place") {
      layout = place(layout, view, any([null, ...open.filter((one) => one !== view)]), any(sides));
    } else if (act === "exchange") {
      layout = exchange(layout, any(open), view);
    } else if (act === "without") {
      layout = without(layout, view) ?? layout;
    } else {
      const border = any([undefined, ...bordersOf(layout)]);
      if (border) layout = moveBorder(layout, border.path, border.position, any([-5, 2, 10, 37, 50, 98, 400]));
    }
    const now = viewsOf(layout);
    assert.strictEqual(new Set(now).size, now.length, "a view is there twice");
    if (act === "place") assert.ok(now.includes(view));
    const rects = [...rectsOf(layout).values()];
    const area = rects.reduce((sum, rect) => sum + rect.width * rect.height, 0);
    assert.ok(Math.abs(area - 1) < 1e-6, `they cover ${area}`);
    for (const [position, a] of rects.entries())
      for (const b of rects.slice(position + 1)) {
        const wide = Math.min(a.x + a.width, b.x + b.width) - Math.max(a.x, b.x);
        const high = Math.min(a.y + a.height, b.y + b.height) - Math.max(a.y, b.y);
        assert.ok(wide < 1e-6 || high < 1e-6, "two of them overlap");
      }
    assert.strictEqual(bordersOf(layout).length, now.length - 1);
    assert.deepStrictEqual(viewsOf(readLayout(JSON.parse(JSON.stringify(layout)), tab_names)), now);
  }
  // What is kept may be anything.
  for (const kept of [null, 4, "Plant", [], {}, { view: "Nowhere" }, { direction: "row", parts: [] }, { direction: "up", parts: [{ share: 1, layout: { view: "Bus" } }] }])
    assert.strictEqual(readLayout(kept, tab_names), undefined);
  const twice = { direction: "row", parts: ["Bus", "Bus", "Gone"].map((view) => ({ share: 0.4, layout: { view } })) };
  assert.deepStrictEqual(readLayout(twice, tab_names), { view: "Bus" });
  const row = (share, ...parts) => ({ share, layout: { direction: "row", parts } });
  const leaf = (share, view) => ({ share, layout: { view } });
  const nested = readLayout(row(1, row(1, leaf(2, "Bus"), leaf(2, "Plant")), leaf(3, "Scope")).layout, tab_names);
  assert.deepStrictEqual([...rectsOf(nested)].map(([view, { width }]) => `${view} ${width}`), ["Bus 0.125", "Plant 0.125", "Scope 0.75"]);
});

test("what two views want of one topic is one wish", async () => {
  const { united } = await bundled("server/wishes.ts");
  const wishes = (...options) => united(options.map((one) => ({ options: one, take: () => undefined })));
  assert.deepStrictEqual(wishes({ rate: 5, step_ms: 10, names: ["a", "b"], station: "saw" }, { rate: 20, step_ms: 1000, names: ["b", "c"], station: "lift" }), {
    rate: 20,
    step_ms: 10,
    names: ["a", "b", "c"],
    station: "lift",
  });
  assert.deepStrictEqual(wishes({ rate: 20 }, { rate: 5, station: "saw" }), { rate: 20, station: "saw" });
});
