// ipos.html from a file, with the network off.
import { join } from "node:path";
import { pathToFileURL } from "node:url";

import { missing } from "./browser.mjs";

export const built = process.env.IPOS_WEB;
export const options = { skip: missing ?? (built ? false : "IPOS_WEB names no folder with ipos.html"), timeout: 120_000 };
export const address = () => pathToFileURL(join(built, "ipos.html")).href;

export async function opened(browser, place = address(), context = undefined) {
  context ??= await browser.newContext({ viewport: { width: 1280, height: 800 }, offline: true, acceptDownloads: true });
  const page = await context.newPage();
  const told = { errors: [], requests: [] };
  page.on("pageerror", (error) => told.errors.push(String(error)));
  page.on("console", (message) => message.type() === "error" && told.errors.push(message.text()));
  page.on("request", (request) => told.requests.push(request.url()));
  await page.goto(place);
  return { page, told, context };
}

export const moves = (page) =>
  page.waitForFunction(() => {
    const text = document.querySelector("[role=timer]")?.textContent ?? "0.000 s";
    return text !== "0.000 s";
  });

export const microseconds = async (page) => Math.round(parseFloat(await page.getByRole("timer", { name: "Time" }).textContent()) * 1e6);
