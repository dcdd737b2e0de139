// The page before the real server: a click turns an axis, a fault triggers the scope, its CSV is that of ipos run.
//   IPOS_PROGRAM=.../ipos node --test test/plant.test.mjs
import assert from "node:assert";
import { execFileSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";

import { launch, missing, openPage, tab_names } from "./browser.mjs";
import { examples, folderOf, program, serve } from "./serve.mjs";

const skip = missing ?? (program ? false : "IPOS_PROGRAM does not name the ipos to test");

// n11 = 150 rpm; DI05 is /EXT. FAULT: without voltage it is F26 (MDX60B/61B, list of errors). The ramp is 0, so the axis
// turns with 150 rpm once the motor is magnetized.
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
P130 = 0
P160 = 150000
P604 = 11
P881 = 1
[station.inputs]
DI05 = 1
[[station]]
name = "gate"
unit = "mdxb"
sbus = "sbus"
[station.parameters]
P881 = 2
[[control]]
name = "plc"
sbus = "sbus"
cycle = "5ms"
[[control.target]]
address = 2
po = [6, 5000, 0]
every = "5ms"
`;
// A master with one slave: a token, requests of DP and their answers.
const dp_text = `
[[bus]]
name = "dp"
kind = "profibus"
baud = 500000
[[station]]
name = "pump"
unit = "mc31"
option = "size0"
profibus = "dp"
profibus_address = 9
[[control]]
name = "plc"
profibus = "dp"
address = 1
[[control.slave]]
address = 9
cfg = "F1"
watchdog = "200ms"
po = [6, 2500]
`;
// A CANopen node with its master.
const canopen_text = `
[[bus]]
name = "can"
kind = "can"
baud = 500000
[[station]]
name = "belt"
unit = "mdxb"
sbus = "can"
[station.parameters]
P880 = 1
P886 = 5
[[control]]
name = "plc"
kind = "canopen"
sbus = "can"
cycle = "10ms"
[[control.target]]
address = 5
po = [6, 5000, 0]
[control.target.parameters]
P130 = "1 s"
`;
const program_text = `#include <constb.h>
#include <iob.h>
long lCount, lFree;
main()
{
  while (1)
  {
    lCount++;
    if (lCount == 100000)
      lFree = 1;
  }
}
`;

let browser;
let place;

before(async () => {
  if (skip) return;
  browser = await launch();
  place = folderOf({ "belt.toml": plant_text, "dp.toml": dp_text, "canopen.toml": canopen_text, "BELT.IPC": program_text });
});
after(async () => {
  await browser?.close();
  place?.remove();
});

async function meet(use, file = "belt.toml", first = "belt DI00") {
  const server = await serve(file, [], place.folder);
  const opened = await openPage(browser, server.address);
  try {
    await opened.page.getByRole("switch", { name: first }).waitFor();
    await use(opened.page, server, opened);
    assert.deepStrictEqual(opened.errors.filter((text) => !text.includes("WebSocket")), []);
  } finally {
    await opened.close();
    assert.ok([0, "SIGKILL"].includes(await server.stop()));
  }
}

async function until(what, text) {
  for (let n = 0; n < 200; ++n) {
    if (await what()) return;
    await new Promise((done) => setTimeout(done, 50));
  }
  assert.fail(text);
}

const button = (page, name) => page.getByRole("button", { name, exact: true });
const tab = (page, name) => page.getByRole("tab", { name }).click();
const timeOf = async (page) => Math.round(Number.parseFloat(await page.getByRole("timer", { name: "Time" }).textContent()) * 1000);
const card = (page, name) => page.getByRole("region", { name, exact: true });

async function enable(page) {
  for (const name of ["DI00", "DI01", "DI03", "DI04"]) await page.getByRole("switch", { name: `belt ${name}` }).click();
}

// Stands at that time, without a race with the clock: as fast as it goes until the trigger of a step.
async function stepTo(page, ms) {
  await page.evaluate(() => document.activeElement?.blur());
  while ((await timeOf(page)) < ms) {
    const before = await timeOf(page);
    await page.keyboard.press("s");
    await until(async () => (await timeOf(page)) > before, "time stands still");
  }
}

test("a click turns an axis", { skip }, () =>
  meet(async (page) => {
    assert.strictEqual(await timeOf(page), 0);
    await button(page, "Run").click();
    await enable(page);
    await until(async () => /150\s*rpm/.test(await card(page, "belt").textContent()), "the axis does not turn");
    const shaft = card(page, "belt").getByRole("img", { name: "belt shaft" });
    const before = await shaft.getAttribute("aria-label");
    await until(async () => (await shaft.getAttribute("aria-label")) !== before, "the shaft stands");
    assert.strictEqual(await page.getByRole("status", { name: "belt DB00" }).textContent(), "on");
    await page.getByRole("switch", { name: "belt DI00" }).click();
    await until(async () => (await card(page, "belt").textContent()).includes("Not enabled"), "no reason is shown");
  }),
);

// AO1 is the actual speed as delivered, 10 V are 3000 rpm (ours).
test("an analog output and the mains", { skip }, () =>
  meet(async (page) => {
    await button(page, "Run").click();
    await enable(page);
    const output = page.getByRole("status", { name: "belt AO1" });
    await until(async () => (await output.textContent()) === "0.50 V", "AO1 does not show 150 rpm");
    assert.strictEqual(await button(page, "Mains belt").getAttribute("aria-pressed"), "true");
    await button(page, "Mains belt").click();
    await until(async () => (await card(page, "belt").textContent()).includes("Not enabled: no mains"), "the drive goes on without mains");
    assert.strictEqual(await button(page, "Mains belt").getAttribute("aria-pressed"), "false");
    assert.strictEqual(await button(page, "Power belt").getAttribute("aria-pressed"), "true", "its 24 V stay");
    await button(page, "Mains belt").click();
    await until(async () => (await output.textContent()) === "0.50 V", "it does not start again");
  }),
);

test("a fault triggers the scope, is named, and can be reset", { skip }, () =>
  meet(async (page) => {
    await tab(page, "Scope");
    await page.getByRole("combobox", { name: "On" }).selectOption("fault");
    await button(page, "Single").click();
    await until(async () => (await button(page, "Single").getAttribute("aria-pressed")) === "true", "not armed");
    await button(page, "Run").click();
    await tab(page, "Plant");
    await enable(page);
    await page.getByRole("switch", { name: "belt DI05" }).click();
    await until(async () => /26/.test(await card(page, "belt").locator(".words.fault").textContent()), "no F26");
    await tab(page, "Scope");
    await until(async () => /triggered|complete/.test(await page.getByRole("figure", { name: "Scope" }).textContent()), "no trigger");
    await tab(page, "Journal");
    await page.getByRole("log").getByText("F26").first().waitFor();
    await tab(page, "Plant");
    await page.getByRole("switch", { name: "belt DI05" }).click();
    await page.getByRole("button", { name: "Fault reset belt" }).click();
    await until(async () => (await card(page, "belt").locator(".words.fault").count()) === 0, "the fault stays");
  }),
);

test("the CSV is that of ipos run --trace, to the digit", { skip }, () =>
  meet(async (page) => {
    await tab(page, "Scope");
    await button(page, "Run").click();
    await until(async () => (await timeOf(page)) > 300, "it does not run");
    await button(page, "Pause").click();
    await until(async () => (await page.locator(".clock .lamp.on").count()) === 0, "it does not stand");
    const download = page.waitForEvent("download");
    await button(page, "CSV").click();
    const mine = readFileSync(await (await download).path(), "utf8");
    const ms = await timeOf(page);
    const signals = mine.split("\n")[0].split(",").slice(1).map((name) => name.replace(/ ?\[.*\]/, ""));
    const file = join(place.folder, "run.csv");
    execFileSync(program, ["run", "belt.toml", "--for", `${ms}ms`, "--trace", file, "--signals", signals.join(",")], { cwd: place.folder, stdio: "ignore" });
    assert.strictEqual(mine, readFileSync(file, "utf8"));
  }),
);

test("watch: every variable of the program, set by hand", { skip }, () =>
  meet(async (page) => {
    await tab(page, "Watch");
    const table = page.getByRole("table", { name: "Watch" });
    const row = table.getByRole("row", { name: "belt.lFree" });
    await row.getByRole("textbox").fill("0x20");
    await row.getByRole("textbox").press("Enter");
    await until(async () => (await row.getByRole("cell").first().textContent()) === "32", "not set");
    await page.getByRole("searchbox").fill("P160");
    await table.getByRole("row", { name: "belt.P160" }).waitFor();
    await until(async () => /150/.test(await table.getByRole("row", { name: "belt.P160" }).getByRole("cell").first().textContent()), "no value of P160");
  }),
);

test("parameters: set with Enter, a refusal is an alert", { skip }, () =>
  meet(async (page) => {
    await tab(page, "Parameters");
    await page.getByRole("combobox", { name: "Station" }).selectOption("gate");
    const row = page.getByRole("table", { name: "Parameters" }).getByRole("row", { name: /^P130 / });
    await row.getByRole("textbox").fill("2.5 s");
    await row.getByRole("textbox").press("Enter");
    await until(async () => (await row.textContent()).includes("2.500"), "not set");
    await row.getByRole("textbox").fill("99999 s");
    await row.getByRole("textbox").press("Enter");
    await page.getByRole("alert").waitFor();
    await page.getByRole("searchbox").fill("ramp t11");
    assert.ok((await page.getByRole("table", { name: "Parameters" }).getByRole("row").count()) >= 5);
    await page.getByRole("combobox", { name: "Compare with" }).selectOption("belt");
    await page.getByRole("searchbox").fill("");
    await page.getByRole("table", { name: "Parameters" }).getByRole("row", { name: /^P881 / }).waitFor();
  }),
);

// Process output data to address 2: 8 x 2 + 3 = 19 (SBus, identifiers of process data).
test("bus: a row an identifier; a cut is seen in the telegrams", { skip }, () =>
  meet(async (page) => {
    await button(page, "Run").click();
    await tab(page, "Bus");
    const row = page.getByRole("table", { name: "Bus" }).getByRole("row", { name: "19 (013h)" });
    await row.waitFor();
    assert.match(await row.textContent(), /00\s*06/);
    await tab(page, "Plant");
    const tap = page.getByRole("button", { name: "Cut gate from sbus" });
    await tap.press("Enter");
    await until(async () => (await tap.getAttribute("aria-pressed")) === "true", "not cut");
  }),
);

// CiA 301: 600h + node is the SDO of a client, 180h + node the first PDO that the node sends.
test("bus: CANopen telegrams in words", { skip }, () =>
  meet(
    async (page) => {
      await button(page, "Run").click();
      await tab(page, "Bus");
      const table = page.getByRole("table", { name: "Bus" });
      await table.getByRole("row", { name: "389 (185h)" }).getByText(/TPDO1 .* <- belt/).waitFor();
      await table.getByRole("row", { name: "0 (000h)" }).getByText("NMT start -> belt").waitFor();
      await page.getByRole("searchbox", { name: "Filter of the trace" }).fill("SDO");
      await page.getByRole("table", { name: "Telegrams" }).getByRole("row", { name: "1541 (605h)" }).getByText(/SDO write .*P130 .* -> belt/).first().waitFor();
    },
    "canopen.toml",
  ),
);

// Set_Prm goes from access point 62 to 61 (EN 50170 volume 2, DP); 2500 digits are 09C4h. The master is at work, but
// where in its cycle the run pauses is a matter of the clock, so frames are sent until one meets a frame of the master.
test("bus: PROFIBUS frames by addresses and access points; one of a hand collides", { skip }, () =>
  meet(
    async (page) => {
      await button(page, "Run").click();
      await tab(page, "Bus");
      const table = page.getByRole("table", { name: "Bus" });
      await table.getByRole("row", { name: "1 → 9, SAP 62 → 61" }).getByText("Set_Prm").waitFor();
      await until(async () => /00\s*06\s*09\s*C4/.test(await table.getByRole("row", { name: /Data_Exchange, SRD/ }).textContent()), "no outputs");
      await table.getByRole("row", { name: "1 → 1" }).getByText("token").waitFor();
      await page.getByText("no master of this line").waitFor();
      await page.getByRole("searchbox", { name: "Filter of the trace" }).fill("Chk_Cfg");
      await page.getByRole("table", { name: "Telegrams" }).getByRole("row", { name: "1 → 9, SAP 62 → 62" }).first().waitFor();
      await button(page, "Pause").click();
      await page.getByRole("searchbox", { name: "Filter of the trace" }).fill("void");
      await page.getByRole("textbox", { name: "Data" }).fill("10 09 20 49 fcs 16");
      const collided = page.getByRole("table", { name: "Telegrams" }).getByText("void, ").first();
      for (let sent = 0; sent < 20 && !(await collided.isVisible()); ++sent) {
        await button(page, "Send").click();
        await stepTo(page, (await timeOf(page)) + 5);
        await collided.waitFor({ timeout: 500 }).catch(() => {});
      }
      await collided.waitFor();
      await page.getByText(/[1-9]\d* errors?/).waitFor();
    },
    "dp.toml",
    "pump DI00",
  ),
);

// The slave's answers are lost, so its card tells that data exchange has ended; the journal names the fault.
test("faults: a PROFIBUS line offers its own, at a click, and ends them", { skip }, () =>
  meet(
    async (page) => {
      const pane = page.getByRole("region", { name: "Line faults" });
      assert.deepStrictEqual(await pane.getByLabel("Kind").locator("option").allTextContents(), ["lost", "cut", "parity", "noise", "collision", "swap", "link", "card", "card_flash", "diagnosis", "terminator", "length", "baud"]);
      assert.strictEqual(await pane.getByLabel("Identifier").count(), 0);
      assert.strictEqual(await page.getByRole("button", { name: "Cut pump from dp" }).count(), 0);
      await button(page, "Run").click();
      await until(async () => (await timeOf(page)) > 1500, "it does not run");
      await pane.getByLabel("Kind").selectOption("lost");
      await pane.getByLabel("Sent by").selectOption("pump");
      await pane.getByRole("button", { name: "Inject" }).click();
      const planted = pane.getByRole("button", { name: "dp: lost at pump" });
      await planted.waitFor();
      await tab(page, "Journal");
      await page.getByRole("log").getByText("the line loses a frame").first().waitFor();
      await tab(page, "Plant");
      await planted.click();
      await until(async () => (await planted.count()) === 0, "the fault stays");
    },
    "dp.toml",
    "pump DI00",
  ),
);

test("program: breakpoint, steps, coverage", { skip }, () =>
  meet(async (page) => {
    await tab(page, "Program");
    await page.getByRole("button", { name: "Breakpoint in line 8" }).click();
    await until(async () => (await page.getByRole("button", { name: "Breakpoint in line 8" }).getAttribute("aria-pressed")) === "true", "not set");
    await button(page, "Run").click();
    const here = page.locator(".cm-line.here");
    await until(async () => (await here.count()) === 1 && /lCount\+\+/.test(await here.textContent()), "it does not stop in line 8");
    await button(page, "Over").click();
    await until(async () => (await here.count()) === 1 && /lCount == 100000/.test(await here.textContent()), "no step to line 9");
    assert.ok((await page.locator(".editor .covered").count()) >= 1);
    assert.ok((await page.locator(".editor .missed").count()) >= 1);
  }),
);

test("step and back", { skip }, () =>
  meet(async (page) => {
    await stepTo(page, 5);
    assert.strictEqual(await timeOf(page), 5);
    await page.getByRole("button", { name: "−1 ms" }).click();
    await until(async () => (await timeOf(page)) === 4, "no way back");
    await page.getByRole("button", { name: "0 s, begin anew" }).click();
    await until(async () => (await timeOf(page)) === 0, "not at 0 s");
  }),
);

test("two browsers see the same plant", { skip }, () =>
  meet(async (page, server) => {
    const second = await openPage(browser, server.address);
    await page.getByRole("switch", { name: "belt DI03" }).click();
    await until(async () => (await second.page.getByRole("switch", { name: "belt DI03" }).getAttribute("aria-checked")) === "true", "the other one sees nothing");
    await second.close();
  }),
);

test("a killed server is an alert; a wrong token gets nothing", { skip }, () =>
  meet(async (page, server) => {
    const answer = await fetch(server.address.replace(/token=.*/, "token=wrong"));
    assert.strictEqual(answer.status, 401);
    server.kill();
    await page.getByRole("alert").waitFor();
  }),
);

// --- what is kept, and that the page shows what is ---

// What the server sent is gone when it ends: the browser says so itself.
const own_mistakes = (errors) => errors.filter((text) => !/WebSocket|ERR_CONNECTION_REFUSED/.test(text));

test("a restarted server takes its tabs back, with stars and settings, and the page goes on", { skip }, async () => {
  const state = folderOf({});
  let server = await serve("belt.toml", [], place.folder, state.folder);
  const opened = await openPage(browser, server.address);
  const { page } = opened;
  const star = (name) => page.getByRole("button", { name: `Pin belt.${name}`, exact: true });
  const isPinned = async (name) => (await star(name).getAttribute("aria-pressed")) === "true";
  try {
    await tab(page, "Watch");
    await star("lCount").click();
    await until(() => isPinned("lCount"), "no star");
    await page.reload();
    await until(() => isPinned("lCount"), "the star is lost by a reload");
    await star("lFree").click();
    await until(() => isPinned("lFree"), "no second star");
    assert.ok(await isPinned("lCount"), "the second star takes the first one away");
    await page.getByLabel("hexadecimal").check();
    const address = server.address;
    assert.strictEqual(await server.stop(), 0);
    await page.getByRole("alert").waitFor();
    server = await serve("belt.toml", [], place.folder, state.folder);
    assert.strictEqual(server.address, address);
    await page.getByRole("alert").waitFor({ state: "detached", timeout: 20_000 });
    await button(page, "Step").click();
    await until(async () => (await timeOf(page)) === 1, "the page does not go on");
    await until(async () => (await isPinned("lCount")) && (await isPinned("lFree")), "the stars are lost by a restart");
    assert.ok(await page.getByLabel("hexadecimal").isChecked());
    assert.deepStrictEqual(own_mistakes(opened.errors), []);
    // A page of another token says what to do.
    const old = await fetch(server.address.replace(/token=.*/, "token=0123"));
    assert.strictEqual(old.status, 401);
    assert.match(await old.text(), /open the one that <code>ipos serve<\/code> has printed last/);
  } finally {
    await opened.close();
    await server.stop();
    state.remove();
  }
});

test("program: a file that has changed since is told, offered, and not mixed with what runs", { skip }, async () => {
  const own = folderOf({ "belt.toml": plant_text, "BELT.IPC": program_text });
  const server = await serve("belt.toml", [], own.folder);
  const opened = await openPage(browser, server.address);
  const { page } = opened;
  try {
    await tab(page, "Program");
    const source = page.getByRole("textbox", { name: "Source" });
    const status = page.getByRole("status", { name: "State of the text" });
    await source.getByText("if (lCount == 100000)").waitFor();
    await status.getByText("This text runs.").waitFor();
    writeFileSync(join(own.folder, "BELT.IPC"), program_text.replace("100000", "4711"));
    await status.getByText("BELT.IPC has changed outside").waitFor();
    await page.keyboard.press("0");
    await source.getByText("if (lCount == 100000)").waitFor();
    assert.strictEqual(await source.getByText("4711").count(), 0);
    await page.getByRole("button", { name: "Take changed file" }).click();
    await source.getByText("4711").waitFor();
    await status.getByText("The text shown is not the one that runs.").waitFor();
    await page.reload();
    await source.getByText("4711").waitFor();
    await status.getByText("The text shown is not the one that runs.").waitFor();
  } finally {
    await opened.close();
    await server.stop();
    own.remove();
  }
});

test("scope: a channel more leaves a complete recording as it is, and has its past", { skip }, () =>
  meet(async (page) => {
    await enable(page);
    await tab(page, "Scope");
    await page.getByRole("group", { name: "Trigger" }).locator("select").first().selectOption("edge");
    await page.getByRole("textbox", { name: "Value" }).fill("100");
    await page.getByRole("textbox", { name: "Value" }).press("Enter");
    await page.getByRole("spinbutton", { name: "Length, ms" }).fill("500");
    await page.getByRole("spinbutton", { name: "Length, ms" }).press("Enter");
    await button(page, "Single").click();
    await button(page, "Run").click();
    await page.getByText(/^complete/).waitFor({ timeout: 30_000 });
    await button(page, "Pause").click();
    const csv = async () => {
      const [download] = await Promise.all([page.waitForEvent("download"), button(page, "CSV").click()]);
      return readFileSync(await download.path(), "utf8").trim().split("\n");
    };
    const before = await csv();
    const count = before[0].split(",").length;
    const field = page.getByRole("combobox", { name: "Add channel" });
    await field.fill("belt.lCount");
    await field.press("Enter");
    await page.getByRole("button", { name: "Remove belt.lCount" }).waitFor();
    const after = await csv();
    assert.deepStrictEqual(after.map((row) => row.split(",").slice(0, count).join(",")), before, "what was recorded has changed");
    const texts = after.slice(1).map((row) => row.split(",")[count]);
    assert.ok(!texts.includes(""), "the past of the channel is not there");
    const counts = texts.map(Number);
    assert.ok(counts.every((value, n) => n === 0 || value >= counts[n - 1]), "it counts up");
    assert.ok(counts[100] > counts[0] && counts.at(-1) > counts[100]);
    await page.getByText(/^complete/).waitFor();
  }),
);

test("bus: the last 200 telegrams of the chosen line, whatever the others do", { skip }, async () => {
  const server = await serve(`${examples}/gateway/gateway.toml`);
  const opened = await openPage(browser, server.address);
  const { page } = opened;
  try {
    await tab(page, "Bus");
    await page.getByRole("combobox", { name: "Speed" }).selectOption("0").catch(() => undefined);
    await button(page, "Run").click();
    await page.getByRole("combobox", { name: "Line" }).selectOption("axes");
    const rows = page.getByRole("table", { name: "Telegrams" }).locator("tbody tr");
    await until(async () => (await rows.count()) === 200, "never 200 of this line");
    assert.deepStrictEqual([...new Set(await rows.locator("td.wire").allTextContents())], ["axes"]);
  } finally {
    await opened.close();
    await server.stop();
  }
});

test("one request for all tabs", { skip }, () =>
  meet(async (page) => {
    const requests = [];
    page.on("request", (request) => requests.push(request.url()));
    await page.reload();
    for (const name of tab_names) {
      await tab(page, name);
      await page.waitForTimeout(200);
    }
    assert.strictEqual(requests.length, 1);
  }),
);
