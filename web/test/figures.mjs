// What the page costs a plant of 64 drives with 6400 telegrams a second: bytes a second and simulated seconds a second,
// with nobody there, with one view and with all of them. Not a test: a load of this computer changes every figure.
//   IPOS_PROGRAM=.../ipos node test/figures.mjs [SECONDS]
import { writeFileSync } from "node:fs";
import { join } from "node:path";

import { launch, openPage, tab_names } from "./browser.mjs";
import { folderOf, serve } from "./serve.mjs";

const seconds = Number(process.argv[2] ?? 10);
const drives = 64;

// As tests/serve/figures.py: seven bytes every 10 ms from each drive, whose axis moves to and fro.
const values = Array.from({ length: 20 }, (_, n) => `lValue${n}`);
const program = (number) => `#include <const.h>
SCTRCYCL TrCycl;
long lLow, lHigh, ${values.join(", ")};
main()
{
  TrCycl.ObjectNo = ${1100 + number};
  TrCycl.CycleTime = 10;
  TrCycl.Offset = 0;
  TrCycl.Format = 7;
  TrCycl.DPointer = numof(lLow);
  _SBusCommDef(SCD_TRCYCL, TrCycl);
  _SBusCommOn();
  ${values.map((name) => `${name}++;`).join(" ")}
  while (1) { lLow++; _GoAbs(GO_WAIT, 100000); _GoAbs(GO_WAIT, 0); }
}
`;
const station = (number) => `[[station]]
name = "d${number}"
unit = "mdxb"
program = "D${number}.IPC"
sbus = "sbus"
[station.parameters]
P881 = ${number}
P884 = 3
P700 = 13
P903 = 5
[station.inputs]
DI00 = 1
DI01 = 1
DI03 = 1
`;
const place = folderOf({});
const numbers = Array.from({ length: drives }, (_, number) => number);
for (const number of numbers) writeFileSync(join(place.folder, `D${number}.IPC`), program(number));
writeFileSync(join(place.folder, "plant.toml"), `[[bus]]\nname = "sbus"\nkind = "can"\nbaud = 1000000\n${numbers.map(station).join("")}`);

const pause = (s) => new Promise((done) => setTimeout(done, s * 1000));
const server = await serve("plant.toml", ["--no-snapshots"], place.folder);
const browser = await launch();
const bytes = new Map(); // of each topic or kind of frame

function listen(page) {
  page.on("websocket", (socket) =>
    socket.on("framereceived", ({ payload }) => {
      const kind = typeof payload === "string" ? (/"event":"(\w+)"/.exec(payload)?.[1] ?? "replies") : "scope.view";
      bytes.set(kind, (bytes.get(kind) ?? 0) + payload.length);
    }),
  );
}
async function timeOf(page) {
  return Number.parseFloat(await page.getByRole("timer", { name: "Time" }).textContent());
}
// So many seconds of the clock, between two looks at the plant's time.
async function measure(text, page, wait) {
  bytes.clear();
  const from = { plant: await timeOf(page), clock: performance.now() };
  await wait();
  const clock = (performance.now() - from.clock) / 1000;
  const plant = (await timeOf(page)) - from.plant;
  const of = [...bytes].sort(([, a], [, b]) => b - a).map(([kind, count]) => `${kind} ${(count / clock / 1000).toFixed(1)}`);
  const all = [...bytes.values()].reduce((sum, count) => sum + count, 0);
  console.log(`${text}: ${(plant / clock).toFixed(3)} simulated s/s, ${(all / clock / 1000).toFixed(1)} kB/s (${of.join(", ")})`);
}

try {
  const { page } = await openPage(browser, `${server.address}#Journal`);
  listen(page);
  await page.reload();
  for (const [name, speed] of [["pace 1", "1"], ["as fast as it goes", "0"]]) {
    await page.getByRole("tab", { name: "Journal" }).click();
    await page.getByRole("combobox", { name: "Speed" }).selectOption(speed);
    await page.getByRole("button", { name: "Run", exact: true }).click();
    await pause(1);
    await measure(`${name}, nobody`, page, async () => {
      const address = page.url();
      await page.goto("about:blank");
      await pause(seconds);
      await page.goto(address);
      await page.waitForFunction(() => !document.querySelector("[role=timer]")?.textContent.startsWith("0.000"));
    });
    for (const view of tab_names) {
      await page.getByRole("tab", { name: view }).click();
      await pause(2);
      await measure(`${name}, ${view}`, page, () => pause(seconds));
    }
    await page.getByRole("button", { name: "Desk" }).click();
    await measure(`${name}, Desk`, page, () => pause(seconds));
    for (const view of ["Watch", "Parameters", "Bus", "Journal"]) {
      await page.getByRole("button", { name: "Split" }).click();
      await page.getByRole("menuitem", { name: view }).click();
    }
    await pause(2);
    await measure(`${name}, all seven`, page, () => pause(seconds));
    console.log(`elements in the page: ${await page.evaluate(() => document.querySelectorAll("*").length)}`);
    const open = await page.locator("main > .pane:not([hidden])").evaluateAll((panes) => panes.map((pane) => pane.ariaLabel));
    for (const view of open.slice(1)) await page.getByRole("button", { name: `Close ${view}` }).click();
    await page.getByRole("button", { name: "Pause", exact: true }).click();
  }
} finally {
  await browser.close();
  await server.stop();
  place.remove();
}
