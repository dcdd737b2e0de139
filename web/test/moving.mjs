// Makes the moving picture of the README: the desk of the hoist, which is called up and down.
//   IPOS_PROGRAM=.../ipos npm run moving
// ImageMagick, which it needs, puts the pictures together.
import { execFileSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath } from "node:url";

import { launch, openPage } from "./browser.mjs";
import { serve } from "./serve.mjs";

const project = fileURLToPath(new URL("../..", import.meta.url));
const frames = 48; // of 100 ms each, 4.8 s of the hoist: a travel up, and the beginning of the way down
const folder = mkdtempSync(join(tmpdir(), "ipos-moving-"));
const server = await serve("hoist.toml", [], `${project}examples/hoist`);
const browser = await launch();
try {
  const { page } = await openPage(browser, server.address, { viewport: { width: 1280, height: 800 }, colorScheme: "dark" });
  await page.getByRole("button", { name: "Desk" }).click();
  const slider = page.getByRole("slider", { name: "Timeline" });
  await page.getByRole("button", { name: "Run", exact: true }).click();
  await page.waitForFunction(() => parseFloat(document.querySelector('[role="timer"]').textContent) > 8.8, null, { timeout: 60_000 });
  await page.getByRole("button", { name: "Pause", exact: true }).click();
  await slider.focus();
  // From the end back to 4 s, then on in steps of 100 ms: every picture is of an exact moment.
  const now = Number(await slider.getAttribute("aria-valuenow") ?? (await slider.inputValue()));
  for (let ms = now; ms > 4000 + 50; ms -= 100) await page.keyboard.press("PageDown");
  for (let n = 0; n < frames; ++n) {
    await page.waitForTimeout(250);
    await page.screenshot({ path: join(folder, `${String(n).padStart(3, "0")}.png`) });
    await page.keyboard.press("PageUp");
  }
  const pictures = [...Array(frames).keys()].map((n) => join(folder, `${String(n).padStart(3, "0")}.png`));
  execFileSync("convert", ["-delay", "10", "-loop", "0", ...pictures, "-resize", "960x", "-quality", "60", `${project}docs/images/desk.webp`]);
} finally {
  await browser.close();
  await server.stop();
  rmSync(folder, { recursive: true });
}
