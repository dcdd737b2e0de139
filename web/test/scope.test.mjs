// The scope and its one picture: what is measured and thinned against calculations of our own, channels, lanes, layouts and
// files before the real server, hands and keys at both sizes, and the page of a plot that stands alone.
import assert from "node:assert";
import { execFileSync, spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath } from "node:url";

import { build } from "esbuild";

import { desktop, launch, missing, openPage, phone } from "./browser.mjs";
import { examples, order, program, serve, standAt } from "./serve.mjs";

const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const skip = missing ?? (program ? false : "IPOS_PROGRAM names no program");
const folder = mkdtempSync(join(tmpdir(), "ipos-scope-"));
let browser;

before(async () => {
  if (!skip) browser = await launch();
});
after(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true });
});

// A module of the page, for what needs no page.
async function source(name) {
  const entry = fileURLToPath(new URL(`../src/picture/${name}.ts`, import.meta.url));
  const result = await build({ entryPoints: [entry], bundle: true, format: "esm", write: false, logLevel: "silent" });
  return import(`data:text/javascript;base64,${Buffer.from(result.outputFiles[0].text).toString("base64")}`);
}

const until = async (what, text) => {
  for (let n = 0; n < 200; ++n) {
    if (await what()) return;
    await new Promise((done) => setTimeout(done, 50));
  }
  assert.fail(text);
};

async function findings(page) {
  await page.evaluate(axe);
  const found = await page.evaluate(() => window.axe.run(document));
  return found.violations.map((one) => `${one.id}: ${one.nodes.map((node) => node.html.slice(0, 140))}`);
}

const windowOf = (page) => page.locator(".picture").evaluate((one) => [Number(one.dataset.fromUs), Number(one.dataset.toUs)]);
const cells = (page, name) => page.getByRole("table", { name: "Readings" }).locator("tbody tr", { hasText: name }).getByRole("cell").allTextContents();

// A page of the scope of a plant that has run for some seconds.
async function meet(plant, ms, use, options = {}) {
  const server = await serve(plant, [], ".", options.state);
  const opened = await openPage(browser, server.address, options);
  const { page } = opened;
  try {
    await page.getByRole("tab", { name: "Scope" }).click();
    await page.getByRole("figure", { name: "Scope" }).waitFor();
    if (ms) await standAt(server, page, ms);
    await use(page, server);
    assert.deepStrictEqual(opened.errors, []);
  } finally {
    await opened.close();
    await server.stop();
  }
}

async function saved(page, button) {
  const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: button, exact: true }).click()]);
  return readFileSync(await download.path(), "utf8");
}

test("measures are those of their definitions", async () => {
  const { measure } = await source("measure");
  // The step of a second order system (damping 0.5, 10 rad/s), in closed form: it overshoots by exp(-pi z / sqrt(1 - z^2)).
  const zeta = 0.5;
  const omega = 10;
  const damped = omega * Math.sqrt(1 - zeta * zeta);
  const step = (t) => 1000 * (1 - Math.exp(-zeta * omega * t) * (Math.cos(damped * t) + ((zeta * omega) / damped) * Math.sin(damped * t)));
  const values = Float64Array.from({ length: 5001 }, (_, n) => step(n / 1000));
  const found = measure(values);
  assert.ok(Math.abs(found.overshoot_percent - 100 * Math.exp((-Math.PI * zeta) / Math.sqrt(1 - zeta * zeta))) < 0.01, `${found.overshoot_percent}`);
  // Where it is outside of 2 % for the last time, by bisection of the closed form behind its last outer extreme.
  let settled = 0;
  for (let n = 0; n <= 5000; ++n) if (Math.abs(step(n / 1000) - step(5)) > 0.02 * step(5)) settled = n + 1;
  assert.strictEqual(found.settling_ms, settled);
  assert.ok(Math.abs(found.greatest - 1163.03) < 0.05);
  // The mean of a sine over whole periods is its middle; the period is what it was made of.
  const sine = measure(Float64Array.from({ length: 4000 }, (_, n) => 7 + 3 * Math.sin((2 * Math.PI * n) / 250 + 0.3)));
  assert.ok(Math.abs(sine.mean - 7) < 1e-9);
  assert.ok(Math.abs(sine.period_ms - 250) < 1e-9);
  const square = measure(Float64Array.from({ length: 1000 }, (_, n) => (n % 80 < 20 ? 1 : 0)));
  assert.strictEqual(square.period_ms, 80);
  // Downwards it overshoots below; what stands still has neither.
  assert.strictEqual(measure(Float64Array.of(100, 50, -10, 0, 0)).overshoot_percent, 10);
  assert.deepStrictEqual(
    [measure(Float64Array.of(5, 9, 5)).overshoot_percent, measure(Float64Array.of(5, 5)).settling_ms, measure(Float64Array.of(1, NaN))],
    [null, null, null],
  );
});

test("no spike is lost at any zoom, and 100 000 points of ten channels zoom at once", async () => {
  const { thin } = await source("points");
  const length = 100_000;
  const channels = Array.from({ length: 10 }, (_, channel) =>
    Float64Array.from({ length }, (_, n) => (n === 7919 * (channel + 1) ? 9e6 + channel : n === 104729 % length ? -9e6 : Math.sin(n / 500 + channel))),
  );
  const words = Float64Array.from({ length }, (_, n) => (n === 4242 ? 0x104 : 0x900));
  const samples = { first_us: 1000, values: [...channels, words] };
  const isWord = [...channels.map(() => false), true];
  for (const most of [1, 37, 800, 4096]) {
    const thinned = thin(samples, isWord, 0, length * 1000, most);
    assert.ok(thinned.count <= most);
    for (let channel = 0; channel < 10; ++channel) {
      assert.strictEqual(Math.max(...thinned.greatest[channel]), 9e6 + channel);
      assert.strictEqual(Math.min(...thinned.least[channel]), -9e6);
    }
    assert.ok(thinned.greatest[10].some((word) => word & 4), "the bit of one millisecond");
  }
  // Each point has what its samples have, looked for one by one.
  const part = thin(samples, isWord, 20_000_000, 30_000_000, 333);
  const per = part.step_us / 1000;
  for (let point = 0; point < part.count; ++point) {
    const begin = (part.first_us - 1000) / 1000 + point * per;
    const mine = channels[3].slice(begin, Math.min(begin + per, Math.floor(29_999_000 / 1000) + 2));
    assert.strictEqual(part.least[3][point], Math.min(...mine));
    assert.strictEqual(part.greatest[3][point], Math.max(...mine));
  }
});

test("three stations fit, setpoints lie under speeds, status is lanes, and a channel that comes later has its past", { skip }, () =>
  meet(`${examples}/gateway/gateway.toml`, 1500, async (page) => {
    const first = await page.getByRole("table", { name: "Readings" }).locator("tbody th").allTextContents();
    assert.ok(first.length > 8 && first.some((text) => /status/.test(text)), `${first}`);
    const { panelsOf, lanesOf } = await source("channel");
    const speed = { name: "u.speed", unit: "rpm", decimals: 3 };
    const setpoint = { name: "u.setpoint", unit: "rpm", decimals: 3 };
    const status = { name: "u.status", unit: "", decimals: 0, kind: "word", bit_names: [[0, "on"]], texts: [[0, "off"]], mask: 1 };
    assert.deepStrictEqual(panelsOf([speed, setpoint, status]), [{ title: "rpm", channels: [1, 0] }]);
    assert.deepStrictEqual(lanesOf([speed, setpoint, status], [], () => 0).map((lane) => lane.text), ["u.status", "u.status.0 on"]);
    // One more by its name, one by the tree.
    const before = (await saved(page, "CSV")).trim().split("\n");
    const columns = before[0].split(",").length;
    const stations = [...new Set(before[0].split(",").slice(1).map((name) => name.split(".")[0]))];
    const add = page.getByRole("combobox", { name: "Add channel" });
    await add.fill(`${stations[0]}.dc_link`);
    await add.press("Enter");
    await page.getByRole("table", { name: "Readings" }).getByRole("rowheader", { name: `${stations[0]}.dc_link` }).waitFor();
    await page.getByText("Pick from the list").click();
    await page.getByRole("searchbox", { name: "Search signals" }).fill("torque");
    const box = page.getByRole("group", { name: "Channels" }).getByRole("checkbox").first();
    await box.check();
    await until(async () => (await saved(page, "CSV")).split("\n")[0].split(",").length === columns + 2, "no channel by the tree");
    const after = (await saved(page, "CSV")).trim().split("\n");
    assert.deepStrictEqual(after.map((row) => row.split(",").slice(0, columns).join(",")), before, "what was there stays");
    assert.ok(after.slice(1).every((row) => row.split(",")[columns] !== ""), "its past is there");
    await page.getByRole("button", { name: `Remove ${stations[0]}.dc_link` }).click();
    await until(async () => (await page.getByRole("button", { name: `Remove ${stations[0]}.dc_link` }).count()) === 0, "not removed");
  }),
);

// What was recorded beyond this moment stays visible, pale, until another future begins; and many lanes leave room for curves.
test("curves keep their room beside many lanes; after the way back what came later is pale", { skip }, () =>
  meet(`${examples}/isync/isync.toml`, 2000, async (page, server) => {
    await until(async () => (await page.locator(".picture .uplot").count()) > 0, "no curves");
    const areas = await page.locator(".picture .u-over").evaluateAll((all) => all.map((one) => one.clientHeight));
    assert.ok(areas.every((height) => height >= 120), `curves have ${areas} pixels`);
    assert.ok(await page.locator(".picture").evaluate((one) => one.scrollHeight <= one.clientHeight + 1), "something lies over the rest");
    // Of the column of a moment: how many pixels of the curves are coloured, and how much lies over them.
    const at = (us) =>
      page.locator(".picture").evaluate((picture, time) => {
        const dots = devicePixelRatio;
        const area = picture.querySelector(".u-over").getBoundingClientRect();
        const [from, to] = [Number(picture.dataset.fromUs), Number(picture.dataset.toUs)];
        const x = area.left - picture.getBoundingClientRect().left + ((time - from) / (to - from)) * area.width;
        const column = (canvas) => canvas.getContext("2d").getImageData(Math.round(x * dots) - 2, 0, 4, canvas.height).data;
        const curves = column(picture.querySelector(".uplot canvas"));
        let coloured = 0;
        for (let n = 0; n < curves.length; n += 4) if (Math.max(curves[n], curves[n + 1], curves[n + 2]) - Math.min(curves[n], curves[n + 1], curves[n + 2]) > 60 && curves[n + 3] > 100) ++coloured;
        const over = column(picture.querySelector(".over"));
        return { coloured, veil: over[3 + 4 * 4 * 40] };
      }, us);
    await until(async () => (await at(1_500_000)).coloured > 0 && (await at(1_500_000)).veil === 0, "no curves at 1.5 s");
    await order(server, { do: "go", us: 800_000 });
    await until(async () => (await at(1_500_000)).veil > 100, "what comes later is not pale");
    assert.ok((await at(1_500_000)).coloured > 0, "what comes later is gone");
    assert.strictEqual((await at(500_000)).veil, 0, "the past is pale");
    assert.deepStrictEqual(await findings(page), []);
    await page.getByRole("button", { name: "Step", exact: true }).click();
    await until(async () => (await at(1_500_000)).coloured === 0 && (await at(1_500_000)).veil === 0, "another future shows the old one");
  }),
);

test("cursors measure, a layout is kept and recalled, XY is drawn, files are those of the command line", { skip }, async () => {
  const state = mkdtempSync(join(tmpdir(), "ipos-state-"));
  try {
    await meet(
      `${examples}/hoist/hoist.toml`,
      3000,
      async (page, server) => {
        await page.getByRole("combobox", { name: "Panel of channel 2" }).selectOption("2");
        await page.locator(".picture").focus();
        for (const key of ["+", "+", "ArrowRight"]) await page.keyboard.press(key);
        const width = async () => (([from, to]) => to - from)(await windowOf(page));
        await until(async () => (await width()) <= 1_300_000, "it is not zoomed");
        const narrow = await windowOf(page);
        await page.getByRole("button", { name: "Cursor B" }).click();
        await until(async () => (await cells(page, "hoist.speed"))[6] !== "", "nothing is measured");
        // The same of the CSV, between the times of the cursors.
        const [, a, b] = (await cells(page, "time")).map((text) => Math.round(Number.parseFloat(text) * 1000));
        const rows = (await saved(page, "CSV")).trim().split("\n").map((row) => row.split(","));
        const at = rows[0].findIndex((name) => name.startsWith("hoist.speed"));
        const part = rows.slice(1).filter(([ms]) => Number(ms) >= Math.min(a, b) && Number(ms) <= Math.max(a, b)).map((row) => Number(row[at]));
        const measured = (await cells(page, "hoist.speed")).map(Number.parseFloat);
        assert.strictEqual(measured[4], Math.min(...part));
        assert.strictEqual(measured[5], Math.max(...part));
        assert.ok(Math.abs(measured[6] - part.reduce((sum, value) => sum + value, 0) / part.length) < 1e-4);
        await page.getByRole("group", { name: "XY" }).locator("select").first().selectOption("hoist.speed");
        await page.getByRole("group", { name: "XY" }).locator("select").last().selectOption("hoist.setpoint");
        await page.getByRole("img", { name: "hoist.setpoint against hoist.speed" }).waitFor();
        await page.getByRole("textbox", { name: "Layout name" }).fill("start");
        await page.getByRole("button", { name: "Keep layout" }).click();
        await page.waitForTimeout(700); // cursors are kept when they stand
        await page.goto(server.address);
        await page.getByRole("tab", { name: "Scope" }).click();
        await until(async () => (await cells(page, "time"))[1] === `${(a / 1000).toFixed(3)} s`, "the cursor is not kept");
        assert.strictEqual(await page.getByRole("combobox", { name: "Panel of channel 2" }).inputValue(), "2");
        await page.getByRole("button", { name: "Remove hoist.setpoint" }).click();
        await until(async () => (await page.getByRole("button", { name: "Remove hoist.setpoint" }).count()) === 0, "not removed");
        await page.getByRole("combobox", { name: "Layout", exact: true }).selectOption("start");
        await page.getByRole("button", { name: "Remove hoist.setpoint" }).waitFor();
        await until(async () => JSON.stringify(await windowOf(page)) === JSON.stringify(narrow), "the zoom is not recalled");
        await page.getByRole("img", { name: "hoist.setpoint against hoist.speed" }).waitFor();
        // Files.
        assert.match(await saved(page, "SVG"), /^<svg[^]*hoist\.speed[^]*<\/svg>\n$/);
        const html = join(folder, "scope.html");
        writeFileSync(html, await saved(page, "HTML"));
        const alone = await browser.newPage();
        await alone.goto(`file://${html}`);
        const names = (table) => table.locator("tbody th").allTextContents();
        assert.deepStrictEqual(await names(alone.getByRole("table", { name: "Readings" })), await names(page.getByRole("table", { name: "Readings" })));
        await alone.close();
      },
      { state },
    );
  } finally {
    rmSync(state, { recursive: true });
  }
});

for (const { name, viewport, colorScheme } of [
  { name: "desktop", viewport: desktop, colorScheme: "dark" },
  { name: "phone", viewport: phone, colorScheme: "light" },
])
  test(`${name}: hands and keys move the picture, axe-core finds nothing`, { skip }, () =>
    meet(
      `${examples}/hoist/hoist.toml`,
      3000,
      async (page) => {
        const picture = page.locator(".picture");
        await picture.scrollIntoViewIfNeeded();
        const box = await picture.boundingBox();
        const [x, y] = [box.x + box.width / 2, box.y + 60];
        const span = async () => {
          const [from, to] = await windowOf(page);
          return to - from;
        };
        const whole = await span();
        if (name === "phone") {
          const client = await page.context().newCDPSession(page);
          const touch = (type, ...places) =>
            client.send("Input.dispatchTouchEvent", { type, touchPoints: places.map((place, id) => ({ x: place, y, id })) });
          await touch("touchStart", x - 40, x + 40);
          for (let far = 45; far <= 120; far += 15) await touch("touchMove", x - far, x + far);
          await touch("touchEnd");
          await until(async () => (await span()) < whole / 2, "two fingers do not zoom");
          const [from] = await windowOf(page);
          await touch("touchStart", x);
          for (let by = 10; by <= 80; by += 10) await touch("touchMove", x + by);
          await touch("touchEnd");
          await until(async () => (await windowOf(page))[0] < from, "a finger does not move it");
        } else {
          await page.mouse.move(x - 200, y);
          await page.mouse.down();
          await page.mouse.move(x, y, { steps: 4 });
          await page.mouse.up();
          await until(async () => (await span()) < whole / 2, "a drag does not zoom");
          await page.mouse.click(x, y);
          await until(async () => (await cells(page, "time"))[1] !== "–", "a click puts no cursor");
          assert.notStrictEqual((await cells(page, "hoist.speed"))[0], "–", "a value at the pointer");
        }
        await picture.focus();
        await page.keyboard.press("Home");
        await until(async () => (await span()) === whole, "Home does not show all");
        await page.keyboard.press("+");
        await until(async () => (await span()) === whole / 2, "+ does not zoom");
        const before = (await cells(page, "time"))[1];
        await page.keyboard.press("ArrowRight");
        await until(async () => (await cells(page, "time"))[1] !== before, "an arrow moves no cursor");
        await page.keyboard.press("-");
        await page.getByText("Pick from the list").click();
        await page.locator(".signal-tree summary").first().waitFor();
        assert.ok((await page.evaluate(() => document.documentElement.scrollWidth - innerWidth)) <= 0, "too wide");
        assert.deepStrictEqual(await findings(page), []);
      },
      { viewport, colorScheme, hasTouch: name === "phone" },
    ),
  );

test("the plot of twenty stations: all names, no number cut, colours as in the table; it stands alone", { skip }, async () => {
  const stations = Array.from({ length: 20 }, (_, n) => `[[station]]\nname = "axis${n + 1}"\nunit = "mdxb"\nsbus = "sbus"\n[station.parameters]\nP881 = ${n + 1}\n`);
  writeFileSync(join(folder, "p20.toml"), `[[bus]]\nname = "sbus"\nkind = "can"\n${stations.join("")}`);
  const signals = ["axis*.speed", "axis*.setpoint", "axis1.dc_link", "axis1.P130"].join(",");
  execFileSync(program, ["run", "p20.toml", "--for", "300ms", "--plot", "p20.html", "--signals", signals], { cwd: folder, stdio: "ignore" });
  for (const viewport of [desktop, phone]) {
    const opened = await openPage(browser, `file://${join(folder, "p20.html")}`, { viewport });
    const { page } = opened;
    try {
      const names = await page.getByRole("table", { name: "Readings" }).locator("tbody th").allTextContents();
      assert.strictEqual(names.length, 43);
      const found = await page.evaluate(() => {
        // Ink at the left edge would be a number that is cut.
        const plots = [...document.querySelectorAll(".picture .uplot canvas")];
        const cut = plots.map((canvas) => {
          const { data } = canvas.getContext("2d").getImageData(0, 0, 2, canvas.height);
          return data.some((_, n) => n % 4 === 3 && data[n] !== 0);
        });
        // A panel with one curve has the colour of its row.
        const canvas = plots[1];
        const pixels = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
        const swatch = [...document.querySelectorAll("tbody tr")].find((row) => row.textContent.includes("dc_link")).querySelector(".swatch");
        const wanted = getComputedStyle(swatch).backgroundColor.match(/\d+/g).map(Number);
        let same = 0;
        for (let n = 0; n < pixels.length; n += 4) if (wanted.every((value, part) => pixels[n + part] === value) && pixels[n + 3] === 255) ++same;
        // The first line of the grid over a whole panel: all begin at the same place.
        const lefts = plots.map((plot) => {
          const { data, width, height } = plot.getContext("2d").getImageData(0, 0, plot.width, plot.height);
          const rows = Array.from({ length: Math.floor(height * 0.4) }, (_, y) => y + Math.floor(height * 0.3));
          for (let x = 0; x < width; ++x) if (rows.filter((y) => data[4 * (y * width + x) + 3] > 0).length > 0.9 * rows.length) return x;
          return -1;
        });
        return { plots: plots.length, cut, same, lefts };
      });
      assert.ok(found.plots >= 2, `${found.plots} panels`);
      assert.ok(!found.cut.includes(true), `cut: ${found.cut}`);
      assert.strictEqual(new Set(found.lefts).size, 1, `panels begin at ${found.lefts}`);
      assert.ok(found.lefts[0] > 0);
      assert.ok(found.same > 100, `${found.same} pixels have the colour of the row`);
      assert.deepStrictEqual(await findings(page), []);
      assert.deepStrictEqual(opened.errors, []);
    } finally {
      await opened.close();
    }
  }
});

// --- traces that ipos run has written ---

const traced = (form) => spawnSync(program, ["run", join(examples, "isync/isync.toml"), "--for", "1500ms", "--trace", `run.${form}`, "--signals", "*.speed,*.status,*.P302,sbus.frames"], { cwd: folder, stdio: "ignore" });

test("a trace has the values of the run's CSV, and what is damaged is told with its place", { skip }, async () => {
  for (const form of ["csv", "jsonl", "ipos-trace"]) traced(form);
  const { readTrace } = await source("trace_file");
  const bytes = readFileSync(join(folder, "run.ipos-trace"));
  const file = (content) => content.buffer.slice(content.byteOffset, content.byteOffset + content.length);
  const trace = await readTrace(file(bytes), "run");
  const [head, ...rows] = readFileSync(join(folder, "run.csv"), "utf8").trim().split("\n").map((line) => line.split(","));
  assert.deepStrictEqual(trace.signals.map((signal) => signal.name), head.slice(1, -1).map((name) => name.replace(/ \[.*/, "")));
  assert.strictEqual(trace.begin, 1);
  assert.strictEqual(trace.end, rows.length);
  trace.samples.values.forEach((values, n) => {
    assert.strictEqual(values.length, rows.length);
    rows.forEach((row, at) => assert.ok(Math.abs(values[at] - Number(row[n + 1])) < 1e-6, `${head[n + 1]} at ${at}`));
  });
  const lines = readFileSync(join(folder, "run.jsonl"), "utf8").trim().split("\n").map((line) => JSON.parse(line));
  assert.deepStrictEqual(trace.events.map(({ time, text }) => [time, text]), lines.filter((line) => line.event).map((line) => [line.time_ms, line.event]));
  assert.strictEqual(trace.tracks[0].times.length, lines.filter((line) => line.frame).length);
  const early = await readTrace(file(bytes.subarray(0, bytes.length - 20)), "run");
  assert.match(early.title, /ends early/);
  assert.ok(early.end > 0 && early.end < trace.end);
  for (let at = 0; at < bytes.length; at += 31) {
    const bad = Buffer.from(bytes);
    bad[at] ^= 0x10;
    const read = await readTrace(file(bad), "run").catch((reason) => reason);
    if (read instanceof Error) assert.ok(Number(read.message.match(/^byte (\d+): /)[1]) <= at, read.message);
    else assert.match(read.title, /ends early/);
  }
});

test("a trace is opened in the scope, dropped on the page, and dropped on the page of a plot", { skip }, async () => {
  traced("ipos-trace");
  const path = join(folder, "run.ipos-trace");
  const drop = async (page) => {
    const data = await page.evaluateHandle((base64) => {
      const transfer = new DataTransfer();
      transfer.items.add(new File([Uint8Array.from(atob(base64), (c) => c.charCodeAt(0))], "run.ipos-trace"));
      return transfer;
    }, readFileSync(path).toString("base64"));
    await page.dispatchEvent("body", "drop", { dataTransfer: data });
  };
  await meet(`${examples}/hoist/hoist.toml`, 0, async (page) => {
    const dialog = page.getByRole("dialog", { name: "Trace" });
    await page.getByLabel("Open trace").setInputFiles(path);
    await dialog.getByRole("heading", { name: "run.ipos-trace" }).waitFor();
    await until(async () => (await dialog.locator(".picture .uplot canvas").count()) > 0, "no curves");
    assert.ok((await dialog.getByRole("table", { name: "Readings" }).locator("tbody th").allTextContents()).some((name) => name.includes("speed")));
    await page.evaluate(axe);
    assert.deepStrictEqual(await findings(page), []);
    await dialog.getByRole("button", { name: "Close" }).click();
    await dialog.waitFor({ state: "detached" });
    await drop(page);
    await dialog.waitFor();
    await page.keyboard.press("Escape");
    await dialog.waitFor({ state: "detached" });
    writeFileSync(join(folder, "bad.ipos-trace"), "no trace");
    await page.getByLabel("Open trace").setInputFiles(join(folder, "bad.ipos-trace"));
    await page.getByRole("alert").filter({ hasText: "bad.ipos-trace: byte 0: this is no .ipos-trace" }).waitFor();
  });
  spawnSync(program, ["run", `${examples}/hoist/hoist.toml`, "--for", "20ms", "--plot", "small.html"], { cwd: folder, stdio: "ignore" });
  const opened = await openPage(browser, `file://${join(folder, "small.html")}`);
  try {
    await drop(opened.page);
    await opened.page.getByRole("heading", { name: "run.ipos-trace" }).waitFor();
    assert.deepStrictEqual(opened.errors, []);
  } finally {
    await opened.close();
  }
});
