// What an hour of dragging the timeline and editing costs in memory: of the page, and of the server with its copies. Not a
// test: it takes an hour.
//   IPOS_PROGRAM=.../ipos node test/hour.mjs [MINUTES]
import { cpSync, mkdtempSync, readFileSync, readdirSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

import { launch, openPage } from "./browser.mjs";
import { examples, serve } from "./serve.mjs";

const minutes = Number(process.argv[2] ?? 60);
const folder = mkdtempSync(join(tmpdir(), "ipos-hour-"));
cpSync(join(examples, "hoist"), folder, { recursive: true });
const server = await serve("hoist.toml", [], folder);
const browser = await launch();
const { page, errors } = await openPage(browser, server.address);
const session = await page.context().newCDPSession(page);
const pause = (ms) => new Promise((done) => setTimeout(done, ms));

// In MB: pages that several processes share count once (PSS).
function serverMemory() {
  let all = 0;
  for (const name of readdirSync("/proc")) {
    try {
      const command = readFileSync(`/proc/${name}/cmdline`, "utf8");
      if (!command.includes("serve") || readFileSync(`/proc/${name}/cwd/hoist.toml`, "utf8") === "") continue;
      if (!/^\/?\S*ipos/.test(command)) continue;
      all += Number(/^Pss:\s+(\d+)/m.exec(readFileSync(`/proc/${name}/smaps_rollup`, "utf8"))[1]);
    } catch {
      // not ours, or gone
    }
  }
  return all / 1024;
}
async function pageMemory() {
  await session.send("HeapProfiler.collectGarbage");
  const { usedSize } = await session.send("Runtime.getHeapUsage");
  return usedSize / 1024 / 1024;
}

let drags = 0;
let edits = 0;
async function look(began) {
  const nodes = await page.evaluate(() => document.querySelectorAll("*").length);
  console.log(`${((Date.now() - began) / 60_000).toFixed(0)} min: page ${(await pageMemory()).toFixed(1)} MB, server ${serverMemory().toFixed(1)} MB, ${nodes} elements, ${drags} drags, ${edits} edits, ${errors.length} errors`);
}

try {
  await page.getByRole("button", { name: "Desk" }).click();
  const source = page.getByRole("textbox", { name: "Source" });
  await source.getByText("UPPER").first().waitFor();
  await page.getByRole("button", { name: "Run", exact: true }).click();
  await pause(6000);
  const began = Date.now();
  await look(began);
  for (let next = 5; Date.now() - began < minutes * 60_000; ) {
    for (let n = 0; n < 20; ++n, ++drags) {
      await page.evaluate((part) => {
        const input = document.querySelector('input[type="range"][aria-label="Timeline"]');
        Object.getOwnPropertyDescriptor(HTMLInputElement.prototype, "value").set.call(input, String(Math.round(part * Number(input.max))));
        input.dispatchEvent(new Event("input", { bubbles: true }));
      }, Math.random());
      await pause(100);
    }
    await source.focus();
    await page.keyboard.press("Control+Home");
    await page.keyboard.type(`// ${edits}`);
    await page.keyboard.press("Enter");
    if (edits % 10 === 9) for (let n = 0; n < 10; ++n) await page.keyboard.press("Control+z");
    await page.keyboard.press("Control+s");
    await pause(300);
    if (++edits % 5 === 0) await page.getByRole("button", { name: "Restart", exact: true }).first().click();
    await page.getByRole("button", { name: "Run", exact: true }).click();
    await pause(1500);
    if ((Date.now() - began) / 60_000 >= next) {
      await look(began);
      next += 5;
    }
  }
  await look(began);
  if (errors.length > 0) console.log(errors.slice(0, 3));
} finally {
  await browser.close();
  await server.stop();
  rmSync(folder, { recursive: true });
}
