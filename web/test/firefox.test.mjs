// The page without a server in Debian's Firefox, from a file: the plant runs as natively, every view is there, files are edited,
// tested, stored, and shared by a link. What needs a dialog of the system (folders, archives) is tried in Chromium alone.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { join } from "node:path";
import { after, before, test } from "node:test";

import { address, built } from "./alone.mjs";
import { tab_names } from "./browser.mjs";
import { control, launchFirefox, missing } from "./firefox.mjs";
import { examples, program } from "./serve.mjs";

const options = { skip: missing ?? (built ? false : "IPOS_WEB names no folder with ipos.html"), timeout: 240_000 };
let firefox;
let page;

before(async () => {
  if (options.skip) return;
  firefox = await launchFirefox();
  page = firefox.page;
  console.log(`# Firefox ${firefox.version}`);
});
after(() => firefox?.close());

const timer = () => document.querySelector("[role=timer]")?.textContent;
const moves = () => page.until("it does not move", () => (document.querySelector("[role=timer]")?.textContent ?? "0.000 s") !== "0.000 s");

test("the hoist moves, and its hash is that of the native program", options, async () => {
  const began = Date.now();
  await page.open(address());
  await page.until("no plant", () => document.querySelector('[role="switch"][aria-label="hoist DI10"]') !== null);
  console.log(`# first plant on screen: ${Date.now() - began} ms`);
  await moves();
  await page.click("button", "Pause");
  await page.until("it goes on", () => document.querySelector(".pace")?.textContent === "paused");
  const us = Math.round(parseFloat(await page.run(timer)) * 1e6);
  const { stderr } = spawnSync(program, ["run", join(examples, "hoist/hoist.toml"), "--for", `${us}us`, "--trace-hash"], { encoding: "utf8" });
  assert.equal(await page.run(() => window.ipos.hash()), /trace hash ([0-9a-f]{16})/.exec(stderr)?.[1]);
});

test("each view has something to show, and time goes back", options, async () => {
  for (const name of tab_names) {
    await page.click('[role="tab"]', name);
    await page.until(`${name} is empty`, () => document.querySelector("main").textContent.length > 40);
    assert.equal(await page.run(() => document.querySelector('[role="alert"]')?.textContent ?? ""), "", name);
  }
  await page.click('[role="tab"]', "Plant");
  await page.run(() => {
    const input = document.querySelector('input[type="range"][aria-label="Timeline"]');
    Object.getOwnPropertyDescriptor(HTMLInputElement.prototype, "value").set.call(input, "20");
    input.dispatchEvent(new Event("input", { bubbles: true }));
  });
  await page.until("it does not go back", () => document.querySelector("[role=timer]")?.textContent === "0.020 s");
});

test("a program is edited, built and restarted, and is there after a reload", options, async () => {
  await page.click('[role="tab"]', "Program");
  await page.until("no text", () => /UPPER/.test(document.querySelector(".cm-content")?.textContent ?? ""));
  await page.click(".cm-content");
  await page.keys("\uE011", control); // Home: the beginning of the text
  await page.keys("// mine\uE006");
  await page.keys("s", control);
  await page.until("not built", () => /Built\. Restart/.test(document.querySelector('[aria-label="State of the text"]')?.textContent ?? ""));
  await page.click("button", "Restart");
  await page.until("not restarted", () => /This text runs\./.test(document.querySelector('[aria-label="State of the text"]')?.textContent ?? ""));
  await new Promise((done) => setTimeout(done, 1500)); // until it is stored
  await page.reload();
  await page.click('[role="tab"]', "Program");
  await page.until("it was not stored", () => /\/\/ mine/.test(document.querySelector(".cm-content")?.textContent ?? ""));
});

test("the tests of the folder run, and a link opens as a plant of its own", options, async () => {
  await page.click("button", "Files");
  await page.click("button", "Test all");
  await page.until("no report", () => /4 tests, 4 passed/.test(document.querySelector('[aria-label="Test report"]')?.textContent ?? ""));
  await page.click("button", "Close");
  await page.click("button", "Share");
  const link = await page.until("no link", () => document.querySelector('input[aria-label="Link"]')?.value);
  await page.open("about:blank");
  await page.open(link);
  await moves();
  await page.open("about:blank");
  await page.open(`${address()}#message=E0201`);
  await page.until("no message", () => /E0201|unknown/i.test(document.querySelector('table[aria-label="Messages"]')?.textContent ?? ""));
  assert.deepEqual(page.errors, []);
});
