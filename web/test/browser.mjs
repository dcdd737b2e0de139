// Debian's Chromium for the tests of the page, without any request of its own.
//   IPOS_PAGE=dist/index.html     takes this page in place of the one in the program, which then need not be linked again
import { existsSync, readFileSync } from "node:fs";

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
      // The socket of a page that came from elsewhere goes to this computer.
      ...(process.env.IPOS_PAGE ? ["--disable-features=LocalNetworkAccessChecks"] : []),
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
  if (process.env.IPOS_PAGE)
    await page.route((url) => url.pathname === "/" && url.searchParams.has("token"), (route) =>
      route.fulfill({ contentType: "text/html", body: readFileSync(process.env.IPOS_PAGE, "utf8") }),
    );
  await page.goto(address);
  return { page, errors, close: () => context.close() };
}
