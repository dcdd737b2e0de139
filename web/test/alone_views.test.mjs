// Every view of the page without a server: what is edited, kept, run again and opened, from a file and with the network off.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";

import { address, moves, opened, options } from "./alone.mjs";
import { launch, tab_names } from "./browser.mjs";
import { press, tabTo } from "./keyboard.mjs";
import { examples } from "./serve.mjs";

let browser;
before(async () => {
  if (!options.skip) browser = await launch();
});
after(() => browser?.close());

const until = async (what, text) => {
  for (const end = Date.now() + 30_000; !(await what()); ) {
    assert.ok(Date.now() < end, text);
    await new Promise((done) => setTimeout(done, 50));
  }
};
const button = (page, name) => page.getByRole("button", { name, exact: true });
const tab = (page, name) => page.getByRole("tab", { name }).click();
const source = (page) => page.getByRole("textbox", { name: "Source" });
const status = (page) => page.getByRole("status", { name: "State of the text" });
const messages = (page) => page.getByRole("table", { name: "Messages" });
const timer = (page) => page.getByRole("timer", { name: "Time" });
const ms = async (page) => Math.round(Number.parseFloat(await timer(page).textContent()) * 1000);

async function meet(use, place = undefined) {
  const { page, told, context } = await opened(browser, place);
  try {
    await use(page);
    assert.deepEqual(told.errors, []);
  } finally {
    await context.close();
  }
}

// The whole text anew, as a person does it with the keys.
async function type(page, text) {
  await source(page).focus();
  await page.keyboard.press("Control+a");
  await page.keyboard.insertText(text);
}

async function pause(page) {
  await button(page, "Pause").click();
  await page.waitForFunction(() => ["paused", "ended"].includes(document.querySelector(".pace")?.textContent)); // all programs may have ended
}

// By the timeline, as an input event says it; the plant must have been there before.
async function goTo(page, to) {
  await page.evaluate((to) => {
    const input = document.querySelector('input[type="range"][aria-label="Timeline"]');
    Object.getOwnPropertyDescriptor(HTMLInputElement.prototype, "value").set.call(input, String(to));
    input.dispatchEvent(new Event("input", { bubbles: true }));
  }, to);
  await until(async () => (await ms(page)) === to, `the page does not go to ${to} ms`);
}

async function passes(page, moment) {
  await until(async () => (await ms(page)) > moment, `${moment} ms do not pass`);
  await pause(page);
}

async function watched(page, name) {
  await tab(page, "Watch");
  await page.getByRole("searchbox", { name: "Search names" }).fill(name);
  const cell = page.getByRole("table", { name: "Watch" }).getByRole("row", { name }).first().getByRole("cell").first();
  await until(async () => /\d/.test(await cell.textContent()), `no value of ${name}`);
  return Number(await cell.textContent());
}

test("each of the seven views and the desk has something to show", options, () =>
  meet(async (page) => {
    await moves(page);
    for (const name of tab_names) {
      await tab(page, name);
      await until(async () => (await page.locator("main").textContent()).length > 40, `${name} is empty`);
      assert.equal(await page.getByRole("alert").count(), 0, name);
    }
    await tab(page, "Scope");
    await page.getByRole("figure", { name: "Scope" }).waitFor();
    await tab(page, "Parameters");
    await page.getByRole("table", { name: "Parameters" }).getByRole("row", { name: /^P130 / }).waitFor();
    await tab(page, "Journal");
    await page.getByRole("log").waitFor();
    await page.locator("body").press("d");
    for (const name of ["Program", "Plant", "Scope"]) await page.getByRole("region", { name }).first().waitFor();
  }),
);

const hoist = readFileSync(join(examples, "hoist/HOIST.IPC"), "utf8");

test("README's link opens the hoist in a fresh profile, and an edit changes where it stops", options, () =>
  meet(async (page) => {
    await moves(page);
    await passes(page, 6_500);
    await goTo(page, 5_500);
    assert.ok(Math.abs((await watched(page, "hoist.position")) - 60_000) < 50);
    await tab(page, "Program");
    await source(page).getByText("UPPER").first().waitFor();
    await type(page, hoist.replace("60000", "60000x"));
    await messages(page).getByRole("row", { name: /HOIST\.IPC/ }).first().waitFor();
    await type(page, hoist.replace("60000", "40000").replace("main()", "main( )"));
    await button(page, "Format").click();
    await until(async () => (await source(page).textContent()).includes("main()"), "it is not formatted");
    await page.keyboard.press("Control+s");
    await status(page).getByText("Built. Restart begins at 0 s with it").waitFor();
    await button(page, "Restart").click();
    await status(page).getByText("This text runs.").waitFor();
    await button(page, "Run").click();
    await passes(page, 5_600);
    await goTo(page, 5_500);
    const position = await watched(page, "hoist.position");
    assert.ok(Math.abs(position - 40_000) < 50, String(position));
    // What was typed is there at the next visit.
    await page.reload();
    await tab(page, "Program");
    await source(page).getByText("40000").first().waitFor();
  }, `${address()}#example=hoist`),
);

test("a plant with mistakes can be opened and mended", options, () =>
  meet(async (page) => {
    await moves(page);
    await tab(page, "Program");
    await source(page).getByText("UPPER").first().waitFor();
    await type(page, hoist.replace("GROUND)", "GROND)"));
    await page.keyboard.press("Control+s");
    await status(page).getByText("It does not build").waitFor();
    await page.reload();
    await page.getByRole("alert").getByText("hoist/hoist.toml has mistakes").waitFor();
    await source(page).getByText("GROND").first().waitFor();
    await messages(page).getByText(/GROND/).first().waitFor();
    await type(page, hoist);
    await page.keyboard.press("Control+s");
    await status(page).getByText("Restart begins at 0 s").waitFor();
    await button(page, "Restart").click();
    await status(page).getByText("This text runs.").waitFor();
    await tab(page, "Plant");
    await page.getByRole("switch", { name: "hoist DI10" }).waitFor();
  }),
);

test("clicks become a test that passes, and a session of the same moment", options, () =>
  meet(async (page) => {
    await moves(page);
    await pause(page);
    const before = await timer(page).textContent();
    await page.getByRole("switch", { name: "hoist DI10" }).click();
    await button(page, "Step").click();
    await until(async () => (await timer(page).textContent()) !== before, "no step is done");
    const moment = await timer(page).textContent();
    await button(page, "Keep as test").click();
    const dialog = page.getByRole("dialog", { name: "Keep as test" });
    await until(async () => (await dialog.getByRole("textbox", { name: "Test" }).inputValue()).includes('input = "DI10"'), "no test comes");
    await dialog.getByRole("textbox", { name: "File" }).fill("clicks.test.toml");
    await dialog.getByRole("button", { name: "Save" }).click();
    await dialog.getByText("Saved as").waitFor();
    await dialog.getByRole("button", { name: "Run tests" }).click();
    for (const row of [/^clicks /, /^hoist /]) await dialog.getByRole("table", { name: "Tests" }).getByRole("row", { name: row }).getByText("passed").waitFor();
    await page.keyboard.press("Escape");
    await button(page, "Save session").click();
    const session = page.getByRole("dialog", { name: "Save session" });
    await session.getByRole("button", { name: "Save" }).click();
    await session.getByText("Open it by the button Files").waitFor();
    await page.keyboard.press("Escape");
    await button(page, "Files").click();
    await page.evaluate(() => (window.is_before = true));
    await button(page, "hoist/hoist.ipos").click();
    await page.waitForFunction(() => !window.is_before && document.title.includes("hoist"));
    await until(async () => (await timer(page).textContent().catch(() => "")) === moment, `the session does not stand at ${moment}`);
    assert.equal(await page.getByRole("switch", { name: "hoist DI10" }).getAttribute("aria-checked"), "true");
    // The link has them, too. It is made by the keyboard alone as the rest is in keyboard.test.mjs.
    await press(page, "Share");
    await page.getByRole("textbox", { name: "Link" }).or(page.getByRole("alert")).waitFor();
    assert.equal(await page.getByRole("alert").count(), 0, await page.getByRole("alert").allTextContents().then(String));
    const link = await page.getByRole("textbox", { name: "Link" }).inputValue();
    await tabTo(page, "Link");
    assert.equal(await page.evaluate(() => getSelection().toString() || document.activeElement.value), link);
    await meet(async (other) => {
      await other.getByRole("switch", { name: "hoist DI10" }).waitFor();
      await button(other, "Files").click();
      await button(other, "hoist/clicks.test.toml").waitFor({ state: "detached" });
      await button(other, "hoist/hoist.ipos").waitFor();
    }, link);
  }),
);

test("the gallery has every example, opens one with buses, and makes a plant", options, () =>
  meet(async (page) => {
    await moves(page);
    await button(page, "Files").click();
    await button(page, "Gallery").click();
    await page.getByRole("region", { name: "Gallery" }).waitFor();
    await page.getByRole("link").nth(21).waitFor();
    await page.getByRole("link", { name: "gateway", exact: true }).click();
    await page.getByRole("dialog", { name: "Open gateway" }).getByRole("button", { name: "Open" }).click();
    await page.waitForFunction(() => document.title.includes("gateway.toml"));
    await button(page, "Run").click();
    await passes(page, 1_500);
    await tab(page, "Bus");
    await page.getByRole("table", { name: "Bus" }).getByRole("row").nth(3).waitFor();
    await goTo(page, 700);
    await tab(page, "Journal");
    await page.getByRole("log").waitFor();
    await tab(page, "Plant");
    await button(page, "Files").click();
    await button(page, "Gallery").click();
    await page.getByRole("link", { name: "hoist/hoist.toml" }).waitFor();
    await button(page, "New plant").click();
    const dialog = page.getByRole("dialog", { name: "New plant" });
    await dialog.getByRole("textbox", { name: "Plant file" }).fill("own/own.toml");
    await dialog.getByRole("button", { name: "Make plant" }).click();
    await dialog.getByRole("alert").waitFor();
    await dialog.getByRole("textbox", { name: "Plant file" }).fill("own.toml");
    await dialog.getByRole("button", { name: "Make plant" }).click();
    await page.waitForFunction(() => document.title.includes("own.toml"));
  }),
);

test("a link never takes the place of what a person has changed", options, async () => {
  const { page, context } = await opened(browser);
  await moves(page);
  await button(page, "Share").click();
  const link = await page.getByRole("textbox", { name: "Link" }).inputValue();
  await page.keyboard.press("Escape");
  await tab(page, "Program");
  await source(page).getByText("UPPER").first().waitFor();
  await type(page, `// mine\n${hoist}`);
  await page.keyboard.press("Control+s");
  await status(page).getByText("Built.").waitFor();
  const other = (await opened(browser, link, context)).page;
  await moves(other);
  await button(other, "Files").click();
  await button(other, "hoist-2/hoist.toml").waitFor();
  await button(other, "hoist/hoist.toml").click();
  await other.waitForFunction(() => document.querySelector("dialog[open]") === null);
  await tab(other, "Program");
  await source(other).getByText("// mine").first().waitFor();
  await context.close();
});

// The programs of a page of the docs, by their fences.
function programsOf(code) {
  const page = readFileSync(join(examples, "../docs/reference/diagnostics", `${code}.md`), "utf8");
  return [...page.matchAll(/```ipc\n(.*?)```/gs)].map(([, text]) => text);
}

test("pages of messages open their failing program and their mended one", options, async () => {
  for (const code of ["E0201", "E0120", "W0201"])
    for (const [version, program] of programsOf(code).entries())
      await meet(
        async (page) => {
          await source(page).locator(".cm-line").first().waitFor();
          const shown = async () =>
            (await source(page).locator(".cm-line").evaluateAll((lines) =>
              lines.map((line) => [...line.childNodes].filter((node) => node.className !== "values").map((node) => node.textContent).join("")),
            )).join("\n");
          await until(async () => (await shown()).trimEnd() === program.trimEnd(), `${code}: ${await shown()}`);
          if (version === 0) await messages(page).getByText(code).first().waitFor();
        },
        `${address()}#message=${code}${version === 0 ? "" : ".right"}`,
      );
});
