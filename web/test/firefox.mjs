// Debian's Firefox, driven by WebDriver BiDi, which it speaks itself: playwright-core drives only builds of its own, and Debian has
// no geckodriver. No network but this computer's.
import { spawn } from "node:child_process";
import { existsSync, mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { createInterface } from "node:readline";

import WebSocket from "ws";

const program = process.env.IPOS_FIREFOX ?? "/usr/bin/firefox-esr";

export const missing = existsSync(program) ? undefined : `${program} is not installed`;

// Nothing is asked or sent by the browser itself; no proxy can be reached, so nothing leaves this computer.
const preferences = {
  "app.normandy.enabled": false,
  "app.update.enabled": false,
  "browser.shell.checkDefaultBrowser": false,
  "browser.startup.homepage_override.mstone": "ignore",
  "datareporting.policy.dataSubmissionEnabled": false,
  "network.captive-portal-service.enabled": false,
  "network.connectivity-service.enabled": false,
  "network.proxy.type": 1,
  "network.proxy.http": "127.0.0.1",
  "network.proxy.http_port": 9,
  "network.proxy.ssl": "127.0.0.1",
  "network.proxy.ssl_port": 9,
  "toolkit.telemetry.enabled": false,
};

class Page {
  constructor(say, context, errors) {
    this.say = say;
    this.context = context;
    this.errors = errors; // of scripts and of the console
  }
  open(url) {
    return this.say("browsingContext.navigate", { context: this.context, url, wait: "complete" });
  }
  reload() {
    return this.say("browsingContext.reload", { context: this.context, wait: "complete" });
  }
  // A function of the page, with plain arguments and a plain result.
  async run(act, ...given) {
    const { result, exceptionDetails } = await this.say("script.evaluate", {
      expression: `(async () => JSON.stringify(await (${act})(...${JSON.stringify(given)})))()`,
      target: { context: this.context },
      awaitPromise: true,
      userActivation: true,
    });
    if (exceptionDetails) throw new Error(exceptionDetails.text);
    return result.type === "string" ? JSON.parse(result.value) : undefined;
  }
  async until(what, act, ...given) {
    for (const end = Date.now() + 60_000; ; ) {
      const found = await this.run(act, ...given);
      if (found) return found;
      if (Date.now() > end) throw new Error(`${what}: ${(await this.run(() => document.body.innerText)).slice(0, 500)}`);
      await new Promise((done) => setTimeout(done, 50));
    }
  }
  // With the mouse, in the middle of the first element of the selector that has this text or name and can be seen.
  async click(selector, text = null) {
    const [x, y] = await this.until(
      `${selector} ${text ?? ""} is not there`,
      (selector, text) => {
        const shown = (one) => one.getClientRects().length > 0;
        const names = (one) => [one.getAttribute("aria-label"), one.textContent.trim()];
        const found = [...document.querySelectorAll(selector)].find((one) => shown(one) && (text === null || names(one).includes(text)));
        if (!found) return null;
        found.scrollIntoView({ block: "center" });
        const { left, top, width, height } = found.getBoundingClientRect();
        return [Math.round(left + width / 2), Math.round(top + height / 2)];
      },
      selector,
      text,
    );
    await this.act({ type: "pointer", id: "mouse", actions: [{ type: "pointerMove", x, y }, { type: "pointerDown", button: 0 }, { type: "pointerUp", button: 0 }] });
  }
  act(actions) {
    return this.say("input.performActions", { context: this.context, actions: [actions] });
  }
  // Each key goes down and up; those of `held` are down meanwhile.
  keys(text, held = "") {
    const down = [...held].map((value) => ({ type: "keyDown", value }));
    const up = [...held].map((value) => ({ type: "keyUp", value }));
    const typed = [...text].flatMap((value) => [{ type: "keyDown", value }, { type: "keyUp", value }]);
    return this.act({ type: "key", id: "keys", actions: [...down, ...typed, ...up] });
  }
}

export const control = "\uE009"; // as WebDriver has it

// A browser with a profile of its own and one page.
export async function launchFirefox() {
  const profile = mkdtempSync(join(tmpdir(), "ipos-firefox-"));
  writeFileSync(join(profile, "user.js"), Object.entries(preferences).map(([name, value]) => `user_pref("${name}", ${JSON.stringify(value)});\n`).join(""));
  const child = spawn(program, ["--headless", "--no-remote", "--remote-debugging-port=0", "--profile", profile], {
    stdio: ["ignore", "ignore", "pipe"],
    env: { ...process.env, HOME: profile, MOZ_HEADLESS_WIDTH: "1280", MOZ_HEADLESS_HEIGHT: "900" },
  });
  const ended = new Promise((done) => child.on("exit", done));
  const address = await new Promise((done, failed) => {
    createInterface(child.stderr).on("line", (line) => {
      const found = /WebDriver BiDi listening on (ws:\S+)/.exec(line);
      if (found) done(found[1]);
    });
    void ended.then((code) => failed(new Error(`${program} ended with ${code}`)));
  });
  const socket = new WebSocket(`${address}/session`);
  await new Promise((done, failed) => socket.on("open", done).on("error", failed));
  const waiting = new Map();
  const errors = [];
  let next = 1;
  socket.on("message", (data) => {
    const { id, type, result, message, method, params } = JSON.parse(data);
    if (method === "log.entryAdded" && params.level === "error") errors.push(params.text);
    const { done, failed } = waiting.get(id) ?? {};
    waiting.delete(id);
    if (type === "success") done?.(result);
    else failed?.(new Error(message));
  });
  const say = (method, params) =>
    new Promise((done, failed) => {
      waiting.set(next, { done, failed: (error) => failed(new Error(`${method}: ${error.message}`)) });
      socket.send(JSON.stringify({ id: next++, method, params }));
    });
  const { capabilities } = await say("session.new", { capabilities: {} });
  await say("session.subscribe", { events: ["log.entryAdded"] });
  const { contexts } = await say("browsingContext.getTree", {});
  return {
    version: capabilities.browserVersion,
    page: new Page(say, contexts[0].context, errors),
    async close() {
      socket.close();
      child.kill("SIGTERM");
      await ended;
      rmSync(profile, { recursive: true, force: true, maxRetries: 5 });
    },
  };
}
