// What makes a person say "wow", by the keyboard alone: no pointer, no click, the focus moves by keys only. At 1280 x 800, and
// axe-core finds nothing in any state that is passed. What can be clicked in a view can be reached by Tab in it.
//   IPOS_PROGRAM=.../ipos node --test test/keyboard.test.mjs
// The plant of three stations is built so in gallery.test.mjs, the link is made so in alone_views.test.mjs.
import assert from "node:assert";
import { cpSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";

import { desktop, launch, missing, openPage, tab_names } from "./browser.mjs";
import { choose, leave, press, tabTo, type } from "./keyboard.mjs";
import { examples, program, serve, standAt } from "./serve.mjs";

const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const skip = missing ?? (program ? false : "IPOS_PROGRAM does not name the ipos to test");
let browser;

before(async () => {
  if (!skip) browser = await launch();
});
after(() => browser?.close());

const until = async (what, text) => {
  for (const end = Date.now() + 20_000; !(await what()); ) {
    assert.ok(Date.now() < end, text);
    await new Promise((done) => setTimeout(done, 30));
  }
};

async function passesAxe(page, where) {
  await page.evaluate(axe);
  const { violations } = await page.evaluate(() => window.axe.run(document, { resultTypes: ["violations"] }));
  assert.deepStrictEqual(violations.map((one) => `${where}: ${one.id} ${one.nodes.map((node) => node.html.slice(0, 160)).join(" ")}`), []);
}

// In a copy of the example; without a name in an empty folder, which opens the gallery.
async function meet(example, use) {
  const folder = mkdtempSync(join(tmpdir(), "ipos-keyboard-"));
  if (example) cpSync(join(examples, example), folder, { recursive: true });
  const server = await serve(example && `${example}.toml`, ["--port", "0"], folder);
  const opened = await openPage(browser, server.address, { viewport: desktop });
  // Whoever uses a pointer here does not test what this file is for.
  await opened.page.evaluate(() => addEventListener("pointerdown", () => (window.pointed = true), true));
  try {
    await use(opened.page, server, folder);
    assert.ok(!(await opened.page.evaluate(() => window.pointed)), "a pointer was used");
    assert.deepStrictEqual(opened.errors.filter((text) => !text.includes("WebSocket")), []);
  } finally {
    await opened.close();
    await server.stop();
    rmSync(folder, { recursive: true });
  }
}

const timer = (page) => page.getByRole("timer", { name: "Time" });
const shows = (page, text) => until(async () => (await timer(page).textContent()) === text, `the time is not ${text}`);
const machine = (page, name) => page.getByRole("figure", { name: `Machine ${name}` });
const status = (page) => page.getByRole("status", { name: "State of the text" });

// Rows 1 and 2: from the gallery to the desk; the hoist stops lower at once; the timeline takes all views back.
test("an example of the gallery is opened, its program changed, and the timeline dragged", { skip }, () =>
  meet(undefined, async (page, server) => {
    await page.getByRole("link", { name: "hoist", exact: true }).waitFor();
    await passesAxe(page, "gallery");
    await press(page, "hoist");
    await page.getByRole("dialog", { name: "Open hoist" }).waitFor();
    await press(page, "Folder");
    await page.getByRole("textbox", { name: "Source" }).getByText("60000").first().waitFor();
    await passesAxe(page, "desk");

    await tabTo(page, "Source");
    await page.keyboard.press("Control+f");
    await page.keyboard.type("60000");
    await page.keyboard.press("Enter");
    await passesAxe(page, "search in the text");
    await page.keyboard.press("Escape");
    await page.keyboard.type("40000");
    await page.keyboard.press("Control+s");
    await status(page).getByText("Built. Restart begins at 0 s with it").waitFor();
    await leave(page);
    await press(page, "Restart");
    await status(page).getByText("This text runs.").waitFor();
    // Upper floor: 40000 increments of 150 mm a turn of 4096.
    await standAt(server, page, 5500);
    await machine(page, "hoist").getByText("1464.84 mm").waitFor();

    await tabTo(page, "Timeline");
    await page.keyboard.press("Home");
    await shows(page, "0.000 s");
    await machine(page, "hoist").getByText(/^0\.00 mm/).waitFor();
    await page.keyboard.press("PageUp");
    await page.keyboard.press("ArrowRight");
    await shows(page, "0.101 s");
    await page.keyboard.press("End");
    await shows(page, "5.500 s");
    await machine(page, "hoist").getByText("1464.84 mm").waitFor();
    await press(page, "hoist DI11", " ");
    await page.keyboard.press("s");
    await shows(page, "5.501 s");
    await press(page, "5.500 s DI11");
    await shows(page, "5.500 s");
    await passesAxe(page, "timeline");
  }),
);

// Row 3: slow motion, a telegram is read, a cable is cut and joined.
test("telegrams in slow motion are read, and a cable is cut", { skip }, () =>
  meet("scom", async (page, server) => {
    await page.getByRole("switch", { name: "unit1 DI00" }).waitFor();
    await standAt(server, page, 100);
    // 0.5, 0.1, 0.01, 0.001, faster than the server can answer.
    for (let n = 0; n < 4; ++n) await page.keyboard.press("-");
    await until(async () => (await page.getByRole("combobox", { name: "Speed" }).inputValue()) === "0.001", "it is not slower");
    // Pauses while one is on the line.
    const on_line = page.locator("g.telegram:not([style*='none'])");
    await page.keyboard.press("r");
    await until(async () => {
      if ((await on_line.count()) === 0) return false;
      await page.keyboard.press("p");
      await page.getByText("paused", { exact: true }).waitFor();
      if ((await on_line.count()) > 0) return true;
      await page.keyboard.press("r");
      return false;
    }, "no telegram is caught on the line");
    await press(page, /^Telegram ./);
    await page.locator(".telegram-words").getByText(/^0\.1\d\d s/).waitFor();
    await passesAxe(page, "slow motion");
    await press(page, "Close telegram");
    await press(page, "Cut unit1 from sbus");
    await page.getByRole("button", { name: "Cut unit1 from sbus", pressed: true }).waitFor();
    await passesAxe(page, "cut");
    await page.keyboard.press("Enter");
    await page.getByRole("button", { name: "Cut unit1 from sbus", pressed: false }).waitFor();
  }),
);

// Row 4: what was done becomes a test, green at once, and a session.
test("what was done is kept as a test, which is green, and as a session", { skip }, () =>
  meet("hoist", async (page, _server, folder) => {
    const input = page.getByRole("switch", { name: "hoist DI10" });
    await input.waitFor();
    await page.keyboard.press("s");
    await shows(page, "0.001 s");
    await press(page, "hoist DI10", " ");
    await until(async () => (await input.getAttribute("aria-checked")) === "true", "Space does not switch");
    await page.keyboard.press("s");
    await shows(page, "0.002 s");
    await page.keyboard.press("2");
    await page.getByRole("searchbox", { name: "Search names" }).waitFor();
    await page.keyboard.press("/");
    await page.keyboard.type("hoist.setpoint");
    await press(page, "Pin hoist.setpoint");
    await passesAxe(page, "watch");
    await page.keyboard.press("k");
    const dialog = page.getByRole("dialog", { name: "Keep as test" });
    await until(async () => (await dialog.getByRole("textbox", { name: "Test" }).inputValue()).includes("[[expect]]"), "no test comes");
    await passesAxe(page, "keep as test");
    await type(page, "File", "keys.test.toml");
    await press(page, "Save");
    await dialog.getByText("Saved as").waitFor();
    assert.match(readFileSync(join(folder, "keys.test.toml"), "utf8"), /input = "DI10"[^]*signal = "setpoint"/);
    await press(page, "Run tests");
    await dialog.getByRole("row", { name: /^keys / }).getByText("passed").waitFor();
    await passesAxe(page, "report");
    await page.keyboard.press("Escape");
    await page.keyboard.press("K");
    const session = page.getByRole("dialog", { name: "Save session" });
    await type(page, "File", "keys.ipos");
    await page.keyboard.press("Enter");
    await session.getByText("Saved").waitFor();
    await passesAxe(page, "save session");
  }),
);

// Elements that do something at a click, and that Tab does not stop at: a widget of the ARIA patterns moves in itself by its
// arrows, the edge of the source by F9, and the dots of the marks say what the list below them says.
const unreachable = (page) =>
  page.evaluate(() => {
    const by_itself = "[role=tab], [role^=menuitem], [role=option], [role=treeitem], .cm-editor *, [aria-hidden=true] *, dialog *";
    const acts = (element) => Object.keys(element.l ?? {}).some((kind) => /^(click|dblclick|pointerdown|pointerup|mousedown)/i.test(kind));
    const native = "button, a[href], input, select, textarea, summary, label";
    return [...document.querySelectorAll("body *")]
      .filter((one) => one.checkVisibility() && (acts(one) || one.matches("button, a[href]")) && !one.matches(by_itself))
      .filter((one) => one.tabIndex < 0 || !(one.matches(native) || one.hasAttribute("role")))
      .filter((one) => !one.matches(":disabled"))
      .map((one) => `${one.outerHTML.replace(/>.*/s, ">")} ${one.textContent.slice(0, 30)}`);
  });

test("in every view Tab reaches all that acts, leaves it again, and every view passes axe", { skip }, () =>
  meet("gateway", async (page, server) => {
    await page.getByRole("button", { name: "Step", exact: true }).waitFor();
    await standAt(server, page, 300);
    for (const [n, view] of tab_names.entries()) {
      await leave(page);
      await page.keyboard.press(String(n + 1));
      await page.getByRole("tab", { name: view, selected: true }).waitFor();
      assert.deepStrictEqual(await unreachable(page), [], view);
      await passesAxe(page, view);
      // Once around: neither the text nor the curves keep the focus.
      if (view !== "Program" && view !== "Scope") continue;
      await tabTo(page, "Timeline");
      await tabTo(page, view);
    }
  }),
);
