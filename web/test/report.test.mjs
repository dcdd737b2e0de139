// The report of a campaign, a page that stands alone: what it counts is what is calculated here; marks on its axes choose cases, a
// click tells of a case, and the command that it prints runs that case again. And a case that `ipos campaign show --serve` opens.
import assert from "node:assert";
import { spawn, spawnSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { createInterface } from "node:readline";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";

import { desktop, launch, missing, openPage, phone } from "./browser.mjs";
import { folderOf, order, program } from "./serve.mjs";

const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const skip = missing ?? (program ? false : "IPOS_PROGRAM does not name the ipos to test");
const most = 60; // what lOut may be
const ins = Array.from({ length: 11 }, (_, n) => n);
const gears = [1, 5, 10];
const cases = ins.flatMap((input) => gears.map((gear) => ({ input, gear, out: input * gear })));
const failed = (of) => of.filter((one) => one.out > most).length;
let browser, place;

const run = (...words) => spawnSync(program, ["campaign", ...words], { cwd: place.folder, encoding: "utf8" });

before(async () => {
  if (skip) return;
  browser = await launch();
  place = folderOf({
    "plant.toml": '[[station]]\nname = "a"\nunit = "mdxb"\nprogram = "A.IPC"\n',
    "A.IPC": "long lIn, lGear, lOut;\nmain() { while (1) { lOut = lIn * lGear; } }\n",
    "c.campaign.toml": `plant = "plant.toml"\nfor = "20ms"\n
[[vary]]\nstation = "a"\nvariable = "lIn"\nvalues = [${ins}]\n
[[vary]]\nstation = "a"\nvariable = "lGear"\nvalues = [${gears}]\n
[[measure]]\nname = "out"\nsignal = "a.lOut"\ntake = "final"\nat_most = ${most}\n`,
  });
  assert.strictEqual(run("run", "c.campaign.toml", "--out", "out").status, 1); // some fail
  const merged = run("merge", "out", "--html", "report.html");
  assert.notStrictEqual(merged.status, 65, merged.stderr);
});
after(async () => {
  await browser?.close();
  place?.remove();
});

async function withReport(viewport, use, more = {}) {
  const opened = await openPage(browser, pathToFileURL(join(place.folder, "report.html")).href, { viewport, ...more });
  try {
    await use(opened.page);
    assert.deepStrictEqual(opened.errors, []);
  } finally {
    await opened.close();
  }
}

// Where axis `number` of `count` has `part` of its range, on the picture (as the page draws it).
async function spot(page, number, count, part) {
  const picture = page.getByRole("img", { name: "Cases over parallel axes" });
  await picture.scrollIntoViewIfNeeded();
  const box = await picture.boundingBox();
  return { x: box.x + 60 + ((box.width - 120) * number) / (count - 1), y: box.y + box.height - 22 - (box.height - 48) * part };
}
async function mark(page, number, from, to) {
  const begin = await spot(page, number, 3, from), end = await spot(page, number, 3, to);
  await page.mouse.move(begin.x, begin.y);
  await page.mouse.down();
  await page.mouse.move(begin.x, (begin.y + end.y) / 2);
  await page.mouse.move(end.x, end.y);
  await page.mouse.up();
}
const rows = (page) => page.locator("#cases tr[tabindex]").count();

test("counts factors, distributions and the map of two factors", { skip }, () =>
  withReport(desktop, async (page) => {
    await page.getByText(`${cases.length} of ${cases.length} cases: ${cases.length - failed(cases)} good, ${failed(cases)} failed`).waitFor();
    const titles = (name) => page.getByRole("region", { name, exact: true }).locator("title").allTextContents();
    const factors = await titles("Factors and measures");
    for (const input of ins) {
      const of = cases.filter((one) => one.input === input), outs = of.map((one) => one.out);
      assert.ok(factors.includes(`${input}: ${failed(of)} of ${of.length} failed`), `lIn = ${input}`);
      const mean = Number((outs.reduce((sum, out) => sum + out) / outs.length).toPrecision(5));
      assert.ok(factors.includes(`${input}: ${Math.min(...outs)} to ${Math.max(...outs)} , mean ${mean}`), `out at ${input}`);
    }
    const bars = (await titles("Distributions")).map((text) => text.match(/: (\d+) good, (\d+) failed/).slice(1).map(Number));
    assert.deepStrictEqual([0, 1].map((n) => bars.reduce((sum, bar) => sum + bar[n], 0)), [cases.length - failed(cases), failed(cases)]);
    const cells = await titles("Two factors");
    assert.strictEqual(cells.length, cases.length);
    for (const { input, gear, out } of cases) {
      const [name, other] = [`a.lIn = ${input}`, `a.lGear = ${gear}`], bad = `${out > most ? 1 : 0} of 1 failed`;
      assert.ok([`${name}, ${other}`, `${other}, ${name}`].some((cell) => cells.includes(`${cell}: ${bad}`)), `${name}, ${other}: ${bad}`);
    }
  }));

test("chooses cases by marks on the axes", { skip }, () =>
  withReport(desktop, async (page) => {
    assert.strictEqual(await rows(page), cases.length);
    await mark(page, 0, 0.75, 1); // lIn from 7.5 on
    const high = cases.filter((one) => one.input >= 8);
    await page.getByText(`${high.length} of ${cases.length} cases chosen, ${failed(high)} of them failed`).waitFor();
    assert.strictEqual(await rows(page), high.length);
    await mark(page, 1, 0.75, 1.05); // and the largest gear; beyond the end of the axis is its end
    const both = high.filter((one) => one.gear === 10);
    await page.getByText(`${both.length} of ${cases.length} cases chosen, ${failed(both)} of them failed`).waitFor();
    const axis = await spot(page, 0, 3, 0.2);
    await page.mouse.click(axis.x, axis.y); // takes the first mark away
    const geared = cases.filter((one) => one.gear === 10);
    await page.getByText(`${geared.length} of ${cases.length} cases chosen, ${failed(geared)} of them failed`).waitFor();
    await page.getByRole("button", { name: "All cases" }).click();
    assert.strictEqual(await rows(page), cases.length);
  }));

test("tells of a case at a click, with the command that runs it again", { skip }, () =>
  withReport(desktop, async (page) => {
    const about = page.getByRole("status", { name: "Case", exact: true });
    // lIn = 10 and lGear = 10: the uppermost line between the first two axes.
    const [from, to] = [await spot(page, 0, 3, 1), await spot(page, 1, 3, 1)];
    await page.mouse.click((from.x + to.x) / 2, from.y);
    await about.getByText("a.lIn = 10, a.lGear = 10").waitFor();
    await about.getByText("out: 100").first().waitFor();
    const command = (await about.locator("code").first().textContent()).split(" ");
    const again = run(...command.slice(2));
    assert.strictEqual(again.status, 1);
    assert.match(again.stdout, /a\.lIn = 10\na\.lGear = 10\nout: 100\n/);
    const good = page.locator("#cases tr[tabindex]").last();
    await good.focus();
    await good.press("Enter");
    assert.strictEqual(await good.getAttribute("aria-selected"), "true");
    assert.strictEqual(await about.locator(".bad").count(), 0);
  }));

for (const [name, viewport] of Object.entries({ desktop, phone }))
  test(`fits into ${name} and is readable for all`, { skip }, () =>
    withReport(
      viewport,
      async (page) => {
        const { wide, room } = await page.evaluate(() => ({ wide: document.documentElement.scrollWidth, room: innerWidth }));
        assert.ok(wide <= room, `${wide} of ${room}`);
        await mark(page, 0, 0.5, 1);
        const upper = cases.filter((one) => one.input >= 5);
        await page.getByText(`${upper.length} of ${cases.length} cases chosen`).waitFor();
        await page.evaluate(axe);
        const { violations } = await page.evaluate(() => window.axe.run(document, { resultTypes: ["violations"] }));
        assert.deepStrictEqual(violations.map((one) => `${one.id}: ${one.nodes.map((node) => node.html).join(" ")}`), []);
      },
      name === "phone" ? { hasTouch: true, isMobile: true } : {},
    ));

test("opens a case in the page of ipos serve", { skip }, async () => {
  const plan = JSON.parse(run("merge", "out", "--jsonl", "-").stdout.split("\n").filter(Boolean).at(-1));
  const child = spawn(program, ["campaign", "show", "c.campaign.toml", plan.case, "--serve"], { cwd: place.folder, stdio: ["ignore", "pipe", "inherit"] });
  const ended = new Promise((done) => child.on("exit", done));
  try {
    const address = await new Promise((done) => createInterface(child.stdout).once("line", done));
    const opened = await openPage(browser, address);
    await opened.page.getByRole("timer", { name: "Time" }).waitFor();
    await order({ address }, { do: "step", ms: 20 });
    await opened.page.getByRole("tab", { name: "Watch" }).click();
    const [input, gear] = [plan.factors["a.lIn"], plan.factors["a.lGear"]].map(Number);
    await opened.page.getByText(String(input * gear), { exact: true }).first().waitFor();
    assert.deepStrictEqual(opened.errors.filter((text) => !text.includes("WebSocket")), []);
    await opened.close();
  } finally {
    child.kill("SIGINT");
    await ended;
  }
});
