// Debian's Chromium for the tests of the page, without any request of its own.
import { existsSync } from "node:fs";

import { chromium } from "playwright-core";

const executablePath = process.env.IPOS_CHROMIUM ?? "/usr/bin/chromium";

export const missing = existsSync(executablePath) ? undefined : `${executablePath} is not installed`;

export function launch() {
  return chromium.launch({
    executablePath,
    headless: true,
    args: [
      "--headless",
      "--no-sandbox",
      "--disable-gpu",
      "--disable-quic",
      "--no-first-run",
      "--disable-background-networking",
      "--disable-component-update",
      "--disable-sync",
    ],
  });
}

export const desktop = { width: 1280, height: 800 };
export const phone = { width: 390, height: 844 };
export const tab_names = ["Plant", "Watch", "Scope", "Parameters", "Bus", "Program", "Journal"];

// A page with what it has against us: errors of scripts and of the console.
export async function openPage(browser, address, options = {}) {
  const context = await browser.newContext({ viewport: desktop, ...options });
  const page = await context.newPage();
  const errors = [];
  page.on("pageerror", (error) => errors.push(String(error)));
  page.on("console", (message) => message.type() === "error" && errors.push(message.text()));
  await page.goto(address);
  return { page, errors, close: () => context.close() };
}
