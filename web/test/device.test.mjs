// The page before `ipos serve --device`: the real drive is a simulated one at a pseudo-terminal. And before a plant with
// such a port.
//   IPOS_PROGRAM=.../ipos node --test test/device.test.mjs
import assert from "node:assert";
import { spawn } from "node:child_process";
import { closeSync, constants, existsSync, openSync, writeSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";

import { desktop, launch, missing, openPage } from "./browser.mjs";
import { folderOf, program, serve } from "./serve.mjs";

const no_terminals = existsSync("/dev/pts/ptmx") ? undefined : "there is no /dev/pts: no pseudo-terminals here";
const skip = missing ?? no_terminals ?? (program ? false : "IPOS_PROGRAM does not name the ipos to test");

const plant = (port) => `
[[bus]]
name = "line1"
kind = "rs485"
port = "pty:${port}"
[[station]]
name = "saw"
unit = "md60a"
rs485 = "line1"
[station.parameters]
P810 = 1
`;

// A slave that a master outside asks.
const dp_plant = `
[[bus]]
name = "dp"
kind = "profibus"
baud = 500000
port = "pty:dp"
[[station]]
name = "pump"
unit = "mc31"
option = "size0"
profibus = "dp"
profibus_address = 9
`;

let browser;
let place;
let port;
let drive;

async function until(what, text) {
  for (let n = 0; n < 200; ++n) {
    if (await what()) return;
    await new Promise((done) => setTimeout(done, 50));
  }
  assert.fail(text);
}

before(async () => {
  if (skip) return;
  browser = await launch();
  // A port is named relative to where the drive runs.
  place = folderOf({ "plant.toml": plant("line1"), "live.toml": plant("line2"), "dp.toml": dp_plant });
  port = join(place.folder, "line1");
  drive = spawn(program, ["run", "plant.toml", "--realtime", "--for", "300s"], { cwd: place.folder, stdio: "ignore" });
  await until(() => existsSync(port), "the drive is not at its port");
});
after(async () => {
  await browser?.close();
  drive?.kill();
  place?.remove();
});

// TYP 86h is the parameter channel alone, acyclic; service 31h reads, index 8318 = 207Eh is P000,
// 8470 = 2116h is P130, 2 s as delivered (1053 1610 p. 18-25).
test("bus: questions and answers of a real drive; sending needs a confirmation", { skip }, async () => {
  const server = await serve(`--device=${port}`, ["--address", "1", "--quiet", "--write"], place.folder);
  const { page, errors, close } = await openPage(browser, server.address, { viewport: desktop });
  try {
    await page.getByRole("tab", { name: "Scope" }).click(); // it reads P000 again and again
    await page.getByRole("figure", { name: "Scope" }).waitFor();
    await page.getByRole("tab", { name: "Bus" }).click();
    await page.getByRole("table", { name: "Bus" }).getByText("unit1").waitFor();
    await page.getByRole("searchbox", { name: "Filter of the trace" }).fill("0201863100207E");
    await page.getByRole("table", { name: "Telegrams" }).getByText("read").first().waitFor();
    await page.getByText("Sending to a real drive needs").waitFor();
    const send = page.getByRole("button", { name: "Send", exact: true });
    assert.ok(await send.isDisabled());
    page.on("dialog", (dialog) => dialog.accept());
    await page.getByRole("button", { name: "Allow writing" }).click();
    await page.getByRole("textbox", { name: "Data" }).fill("02 01 86 31 00 21 16 00 00 00 00 83");
    await until(async () => !(await send.isDisabled()), "still locked");
    await send.click();
    await page.getByRole("searchbox", { name: "Filter of the trace" }).fill("1D018631002116000007D0");
    await page.getByRole("table", { name: "Telegrams" }).getByText("unit1").first().waitFor();
    await page.getByRole("tab", { name: "Program" }).click();
    await page.getByText("A real drive does not give its source away").waitFor();
    assert.deepStrictEqual(errors.filter((text) => !text.includes("WebSocket")), []);
  } finally {
    await close();
    assert.ok([0, "SIGKILL"].includes(await server.stop()));
  }
});

test("a plant with a real port runs in step with the clock, and nothing can stop it", { skip }, async () => {
  const server = await serve("live.toml", [], place.folder);
  const { page, errors, close } = await openPage(browser, server.address, { viewport: desktop });
  try {
    await page.getByText("real ports: in step with the clock").waitFor();
    for (const name of ["Run", "Pause", "Step"]) assert.ok(await page.getByRole("button", { name, exact: true }).isDisabled(), name);
    const seconds = async () => Number.parseFloat(await page.getByRole("timer", { name: "Time" }).textContent());
    const before = await seconds();
    await until(async () => (await seconds()) > before + 0.5, "time stands");
    await page.getByRole("switch", { name: "saw DI00" }).click();
    await until(async () => (await page.getByRole("switch", { name: "saw DI00" }).getAttribute("aria-checked")) === "true", "no input");
    await page.getByRole("tab", { name: "Program" }).click();
    await page.getByText("Real ports: the program cannot be stopped").waitFor();
    assert.deepStrictEqual(errors.filter((text) => !text.includes("WebSocket")), []);
  } finally {
    await close();
    assert.ok([0, "SIGKILL"].includes(await server.stop()));
  }
});

// FDL_Status of the slave 9, asked by 1: 49h, and 09h + 01h + 49h = 53h. It finds the rate by what it hears.
test("a PROFIBUS master outside is watched; that it leaves is said on every tab", { skip }, async () => {
  const server = await serve("dp.toml", [], place.folder);
  const { page, errors, close } = await openPage(browser, server.address, { viewport: desktop });
  const attach = () => openSync(join(place.folder, "dp"), constants.O_RDWR | constants.O_NOCTTY | constants.O_NONBLOCK);
  try {
    await page.getByText("real ports: in step with the clock").waitFor();
    for (const name of ["Run", "Pause", "Step"]) assert.ok(await page.getByRole("button", { name, exact: true }).isDisabled(), name);
    const port = page.getByRole("status", { name: "Port of dp" });
    assert.match(await port.textContent(), /^away: no program/);
    assert.strictEqual(await page.getByRole("alert").count(), 0, "nobody was there yet");
    const master = attach();
    await page.getByRole("tab", { name: "Bus" }).click();
    const answer = page.getByRole("table", { name: "Bus" }).getByRole("row", { name: "9 → 1" });
    await until(async () => {
      writeSync(master, Buffer.from("100901495316", "hex"));
      return (await answer.count()) === 1;
    }, "the slave does not answer");
    closeSync(master);
    await page.getByRole("alert").getByText(/dp: port pty:dp is away since [\d.]+ s: no program/).waitFor();
    const again = attach();
    await until(async () => (await page.getByRole("alert").count()) === 0, "the alert stays");
    await page.getByRole("tab", { name: "Plant" }).click();
    assert.match(await port.textContent(), /^there since/);
    await page.getByRole("tab", { name: "Journal" }).click();
    await page.getByRole("log").getByText("port pty:dp is there again").waitFor();
    closeSync(again);
    assert.deepStrictEqual(errors.filter((text) => !text.includes("WebSocket")), []);
  } finally {
    await close();
    assert.ok([0, "SIGKILL"].includes(await server.stop()));
  }
});
