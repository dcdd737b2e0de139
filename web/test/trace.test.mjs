// The trace and the journal before the real server: columns, filter, mute, find, one telegram in detail, files for other
// tools, and how much the server sends. On a wide page and on a phone, by keyboard, with axe-core.
//   IPOS_PROGRAM=.../ipos node --test test/trace.test.mjs
import assert from "node:assert";
import { execFileSync, spawnSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { after, before, test } from "node:test";

import { desktop, launch, missing, openPage, phone } from "./browser.mjs";
import { examples, order, program, serve, standAt } from "./serve.mjs";

const skip = missing ?? (program ? false : "IPOS_PROGRAM does not name the ipos to test");
const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const gateway = `${examples}/gateway/gateway.toml`;

let browser;
before(async () => {
  if (!skip) browser = await launch();
});
after(() => browser?.close());

async function until(condition, what, ms = 20_000) {
  for (const end = Date.now() + ms; !(await condition()); ) {
    assert.ok(Date.now() < end, what);
    await new Promise((done) => setTimeout(done, 50));
  }
}

async function meet(plant, viewport, act) {
  const server = await serve(plant);
  const opened = await openPage(browser, server.address, { viewport });
  try {
    await act(opened.page, server);
    assert.deepStrictEqual(opened.errors.filter((text) => !text.includes("WebSocket")), []);
  } finally {
    await opened.close();
    await server.stop();
  }
}

const button = (page, name) => page.getByRole("button", { name, exact: true });
const tab = (page, name) => page.getByRole("tab", { name }).click();
const timeOf = async (page) => Number.parseFloat(await page.getByRole("timer", { name: "Time" }).textContent());

async function findings(page) {
  await page.evaluate(axe);
  const found = await page.evaluate(() => window.axe.run(document));
  return found.violations.filter((one) => ["serious", "critical"].includes(one.impact)).map((one) => `${one.id}: ${one.nodes.map((node) => node.html.slice(0, 120))}`);
}

async function saved(page, name) {
  const download = page.waitForEvent("download");
  await button(page, name).click();
  const file = await download;
  return { name: file.suggestedFilename(), path: await file.path() };
}

test("trace: columns, filter, tokens, mute, find, one telegram, files", { skip }, () =>
  meet(gateway, desktop, async (page, server) => {
    let sent = 0;
    let largest = 0;
    page.on("websocket", (socket) =>
      socket.on("framereceived", ({ payload }) => {
        sent += payload.length;
        if (String(payload).includes('"frames"')) largest = Math.max(largest, payload.length);
      }),
    );
    await page.reload();
    await tab(page, "Bus");
    await standAt(server, page, 1200);
    const table = page.getByRole("table", { name: "Telegrams" });
    const rows = table.locator("tbody tr");
    const column = async (name) => {
      const heads = await table.getByRole("columnheader").allTextContents();
      return rows.locator(`td:nth-child(${heads.indexOf(name) + 1})`).allTextContents();
    };
    assert.deepStrictEqual(await table.getByRole("columnheader").allTextContents(), ["Time", "Delta", "Line", "Direction", "Sender", "Identifier", "DLC", "Data", "Meaning"]);

    // Newest first, to the microsecond, each with its distance from the one below it.
    await page.getByRole("combobox", { name: "Line", exact: true }).selectOption("dp");
    await until(async () => new Set(await column("Line")).size === 1 && (await table.getAttribute("aria-rowcount")) === "201", "not 200 of dp");
    const times = (await column("Time")).map((text) => (assert.match(text, /^\d+\.\d{6}$/), Math.round(Number(text) * 1e6)));
    const deltas = (await column("Delta")).map((text) => Math.round(Number(text.slice(1)) * 1e6));
    for (let n = 0; n + 1 < times.length; ++n) assert.strictEqual(deltas[n], times[n] - times[n + 1]);
    assert.deepStrictEqual([...new Set(await column("Direction"))], ["Tx"]);

    // The data of the gateway in words of its configuration: 1500 digits of 0.2 rpm are 300 rpm.
    assert.ok((await column("Meaning")).some((text) => text.includes("token")));
    await page.getByRole("checkbox", { name: "Hide tokens" }).check();
    await until(async () => (await column("Meaning")).every((text) => !text.includes("token")), "tokens stay");
    const filter = page.getByRole("searchbox", { name: "Filter of the trace" });
    await filter.fill("sender:plc Data_Exchange -Diag");
    await until(async () => (await rows.count()) > 5 && (await column("Sender")).every((text) => text === "plc"), "not of plc alone");
    assert.match((await column("Meaning"))[0], /pump PO CTRL\. WORD 1 0006h \(enable\), SPEED 300\.0 rpm, .*fan PO .*SPEED 600\.0 rpm, .*-> gateway$/);
    await filter.fill("id:saw");
    await page.getByText("'saw' is no hexadecimal number and no range of them").waitFor();
    await filter.fill("sender:plc Data_Exchange");
    await until(async () => (await rows.count()) > 5, "the filter is not mended");

    // One of them: its words go to the scope, its answer is the gateway's, its moment is there again.
    const first = rows.nth(1); // the newest may still wait for its answer
    const moment = await first.getByRole("cell").first().textContent();
    await first.click();
    const detail = page.getByRole("region", { name: "Telegram" });
    await detail.getByRole("row", { name: /^dp\.10\.PO2 1500/ }).waitFor();
    await detail.getByRole("button", { name: "Add channel dp.10.PO2" }).click();
    const partner = detail.getByText("Answered by").getByRole("button");
    assert.ok(Number(await partner.textContent()) > Number(moment));
    await partner.click();
    await detail.getByText("10 → 1").waitFor();
    await detail.getByText("Answer to").waitFor();
    // By keyboard: arrows choose the next one.
    await filter.fill("");
    await button(page, "Follow").click();
    const box = page.getByRole("group", { name: /^Trace, arrow keys/ });
    await box.focus();
    await page.keyboard.press("ArrowDown");
    await page.keyboard.press("ArrowDown");
    const current = table.locator('tr[aria-current="true"]');
    await current.waitFor();
    assert.deepStrictEqual(await findings(page), []);
    // Further back than what was sent: many rows, few in the document.
    await button(page, "Close detail").click();
    for (let n = 0; n < 4; ++n) {
      await box.evaluate((element) => (element.scrollTop = element.scrollHeight));
      await until(async () => Number(await table.getAttribute("aria-rowcount")) > 200 * (n + 1), "nothing older comes");
    }
    assert.ok((await rows.count()) < 120, "rows out of sight are in the document");
    // Find goes on, further back than what is loaded, too.
    await page.getByRole("textbox", { name: "Find" }).fill("Chk_Cfg");
    await page.getByRole("textbox", { name: "Find" }).press("Enter");
    await current.getByText("Chk_Cfg").waitFor();

    // A telegram of a hand goes to the line that is named, and no other.
    await page.getByRole("combobox", { name: "Line", exact: true }).selectOption("");
    await page.getByRole("combobox", { name: "Send to" }).selectOption("");
    assert.ok(await button(page, "Send").isDisabled());
    await page.getByRole("combobox", { name: "Send to" }).selectOption("sbus");
    await page.getByText("onto sbus").waitFor();
    await page.getByRole("textbox", { name: "Identifier" }).fill("7F0h");
    await page.getByRole("textbox", { name: "Data" }).fill("0A FF");
    await button(page, "Send").click();
    await filter.fill("sender:\"the page\"");
    await button(page, "Follow").click();
    await order(server, { do: "step", ms: 3 });
    await until(async () => (await column("Identifier")).join() === "2032 (7F0h)", "it did not go out");
    assert.deepStrictEqual(await column("Line"), ["sbus"]);
    assert.deepStrictEqual(await column("DLC"), ["2"]);

    // A muted identifier stays as it was; the others go on.
    await filter.fill("line:sbus id:13,2B");
    await until(async () => (await rows.count()) > 10, "nothing to mute");
    await button(page, "Mute sbus 19 (013h)").click();
    const paused_at = await timeOf(page);
    await order(server, { do: "step", ms: 60 });
    await until(async () => (await column("Time")).some((text) => Number(text) > paused_at), "nothing new");
    const identifiers = await column("Identifier");
    for (const [n, text] of (await column("Time")).entries()) if (Number(text) > paused_at) assert.strictEqual(identifiers[n], "43 (02Bh)");
    await page.getByRole("button", { name: "Unmute 1" }).click();

    // Files: everything as pcapng, the CAN lines as candump and ASC, with a word about the rest.
    await filter.fill("");
    await page.getByRole("checkbox", { name: "Hide tokens" }).uncheck();
    const all = await saved(page, "Save trace");
    assert.strictEqual(all.name, "trace.pcapng");
    const decode = (path) => execFileSync(program, ["bus", "decode", path, "--names", gateway], { encoding: "utf8", maxBuffer: 1 << 28 }).trim().split("\n");
    const decoded = decode(all.path);
    assert.ok(decoded.some((text) => text.includes(" dp ")) && decoded.some((text) => text.includes(" axes ")) && decoded.some((text) => text.includes(" sbus ")));
    const dissected = spawnSync("tshark", ["-r", all.path, "-T", "fields", "-e", "frame.number"], { encoding: "utf8" });
    if (!dissected.error) assert.strictEqual(dissected.stdout.trim().split("\n").length, decoded.length);
    for (const form of ["candump", "asc"]) {
      await page.getByRole("combobox", { name: "Form of the file" }).selectOption(form);
      const file = await saved(page, "Save trace");
      await page.getByText(/Left out: dp is a PROFIBUS line/).waitFor();
      assert.strictEqual(decode(file.path).length, decoded.filter((text) => / (sbus|canopen) /.test(text)).length, form);
    }
    await page.getByRole("combobox", { name: "Line", exact: true }).selectOption("axes");
    await button(page, "Save trace").click();
    await page.getByRole("alert").getByText("axes is a RS-485 line").waitFor();
    await button(page, "Close message").click();

    // The channel is there, and the plant goes back to the telegram.
    await tab(page, "Scope");
    await page.getByText("dp.10.PO2").first().waitFor({ state: "attached" });
    await tab(page, "Bus");
    await page.getByRole("combobox", { name: "Line", exact: true }).selectOption("dp");
    await rows.nth(12).click();
    const back_to = Number(await rows.nth(12).getByRole("cell").first().textContent());
    await page.getByRole("button", { name: /^Go to / }).click();
    await until(async () => Math.abs((await timeOf(page)) - back_to) < 0.002, "it is not there again");

    // What is not looked at is not sent: 200 rows at once are the most, and a standing plant sends nothing.
    assert.ok(largest < 120_000, `${largest} characters at once`);
    await page.waitForTimeout(700);
    const before = sent;
    await page.waitForTimeout(1500);
    assert.ok(sent - before < 2_000, `${sent - before} characters while the plant stands`);
  }),
);

test("trace: where it stands a new filter acts at once, and so does another moment", { skip }, () =>
  meet(gateway, desktop, async (page, server) => {
    await tab(page, "Bus");
    await standAt(server, page, 400);
    const rows = page.getByRole("table", { name: "Telegrams" }).locator("tbody tr[role=row]");
    const lines = async () => [...new Set(await rows.locator(".wire").allTextContents())].sort();
    const filter = page.getByRole("searchbox", { name: "Filter of the trace" });
    await until(async () => (await rows.count()) > 10, "no telegrams");
    await button(page, "Follow").click();
    const before = await rows.first().textContent();
    // What comes by now is not shown, whatever the filter.
    await standAt(server, page, 500);
    assert.strictEqual(await rows.first().textContent(), before);
    await filter.fill("line:sbus");
    await until(async () => (await lines()).join() === "sbus", "the filter does nothing");
    const times = await rows.locator(".time").allTextContents();
    assert.ok(times.every((time) => Number.parseFloat(time) <= 0.4), "newer ones than where it stands");
    await filter.fill("-line:sbus");
    await until(async () => !(await lines()).includes("sbus") && (await rows.count()) > 10, "the other filter does nothing");
    await filter.fill("line:nowhere");
    await page.getByText("No telegram.").waitFor();
    await filter.fill("");
    await until(async () => (await rows.count()) > 10 && (await rows.first().textContent()) === before, "without the filter it is another trace");
    await order(server, { do: "go", us: 200_000 });
    await until(async () => (await rows.count()) > 10 && Number.parseFloat(await rows.first().locator(".time").textContent()) <= 0.2, "it does not show the earlier moment");
  }),
);

test("trace and journal on a phone: nothing lies beside the box; the journal leads to moments and lines", { skip }, () =>
  meet(`${examples}/hoist/hoist.toml`, phone, async (page, server) => {
    await page.getByRole("switch", { name: "hoist DI04" }).waitFor();
    await standAt(server, page, 4500); // it is on its way up
    await page.getByRole("button", { name: "Force hoist DI04" }).click();
    await page.getByRole("button", { name: "Force hoist DI04", pressed: true }).waitFor();
    await page.getByRole("switch", { name: "hoist DI04" }).click();
    await order(server, { do: "step", ms: 20 });
    await tab(page, "Journal");
    const log = page.getByRole("log", { name: "Journal" });
    await log.getByText("F29").first().waitFor();
    assert.deepStrictEqual(await findings(page), []);
    // The newest one is on top; oldest first turns it round.
    const entry_times = async () => (await log.getByRole("button", { name: /^Go to / }).allTextContents()).map((text) => Number.parseFloat(text));
    const falling = await entry_times();
    assert.deepStrictEqual(falling, [...falling].sort((a, b) => b - a));
    await page.getByRole("checkbox", { name: "newest first" }).uncheck();
    await until(async () => (await entry_times())[0] === falling.at(-1), "the order stays");
    await page.getByRole("searchbox", { name: "Search the journal" }).fill("F29 -reset");
    await until(async () => (await entry_times()).length < falling.length, "the filter takes all");
    const csv = await saved(page, "Save as CSV");
    const lines = readFileSync(csv.path, "utf8").trim().split("\r\n");
    assert.strictEqual(lines[0], "time_s,station,weight,text");
    assert.match(lines[1], /^\d\.\d{6},hoist,(fault|warning),.*F29/);
    const text = await saved(page, "Save as text");
    assert.match(readFileSync(text.path, "utf8"), /^\d\.\d{6} s hoist: .*F29/);
    // The place that it names is a way to the line.
    await log.getByRole("button", { name: /HOIST\.IPC:\d+/ }).first().click();
    await page.locator(".cm-activeLine").getByText("_GoAbs").waitFor();
    await tab(page, "Journal");
    await log.getByText("F29").first().waitFor();
    const [moment] = await entry_times();
    await log.getByRole("button", { name: /^Go to / }).first().click();
    await until(async () => Math.abs((await timeOf(page)) - moment) < 0.0015, "it does not go back");
  }),
);

test("trace on a phone: nothing lies beside its box", { skip }, () =>
  meet(gateway, phone, async (page, server) => {
    await tab(page, "Bus");
    await standAt(server, page, 600);
    const table = page.getByRole("table", { name: "Telegrams" });
    await table.getByRole("row").nth(5).waitFor();
    const box = page.getByRole("group", { name: /^Trace, arrow keys/ });
    const { inner, outer } = await box.evaluate((element) => ({ inner: element.scrollWidth, outer: element.clientWidth }));
    assert.ok(inner <= outer, `${inner} in ${outer}`);
    const counts = await page.getByRole("group", { name: "What runs on the lines" }).evaluate((element) => element.scrollWidth - element.clientWidth);
    assert.ok(counts <= 0, `the counts are ${counts} pixels too wide`);
    assert.ok((await page.getByRole("table", { name: "Bus" }).getByRole("row").count()) > 3);
    const meaning = table.locator("tbody tr").first().locator("td.meaning");
    await meaning.waitFor();
    const { x, width } = await meaning.evaluate((cell) => cell.getBoundingClientRect().toJSON());
    assert.ok(x >= 0 && x + width <= phone.width, "the meaning is outside");
    await table.locator("tbody tr").first().click();
    await page.getByRole("region", { name: "Telegram" }).waitFor();
    assert.ok((await page.evaluate(() => document.documentElement.scrollWidth)) <= phone.width, "the page is too wide");
    assert.deepStrictEqual(await findings(page), []);
  }),
);
