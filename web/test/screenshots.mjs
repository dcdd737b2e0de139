// Remakes the pictures of docs/guide/workbench.md: two drives in synchronous operation, after some seconds.
//   IPOS_PROGRAM=.../ipos npm run screenshots
// docs/images/smaller.sh, which needs pngquant and optipng, then makes them smaller.
import { execFileSync } from "node:child_process";
import { fileURLToPath } from "node:url";

import { desktop, launch, openPage, phone, tab_names } from "./browser.mjs";
import { serve } from "./serve.mjs";

const project = fileURLToPath(new URL("../..", import.meta.url));
const image = (name) => `${project}docs/images/workbench-${name.toLowerCase()}.png`;

// All tabs on a phone, side by side in one picture.
async function phones() {
  const { page } = await openPage(browser, server.address, { viewport: phone, colorScheme: "light" });
  const pictures = [];
  for (const name of tab_names) {
    await page.getByRole("tab", { name }).click();
    await page.waitForTimeout(1200);
    pictures.push((await page.screenshot()).toString("base64"));
  }
  const strip = await browser.newPage({ viewport: { width: 7 * 186 + 12, height: 340 } });
  await strip.setContent(
    `<body style="margin:12px 0 0 12px;display:flex;gap:12px;background:#888">${pictures
      .map((picture) => `<img width="174" src="data:image/png;base64,${picture}">`)
      .join("")}`,
  );
  await strip.screenshot({ path: image("phone") });
}

// The folder is left out of what the pages show.
const server = await serve("isync.toml", [], `${project}examples/isync`);
const browser = await launch();
try {
  const { page } = await openPage(browser, server.address, { viewport: desktop, colorScheme: "dark" });
  const tab = (name) => page.getByRole("tab", { name }).click();
  await tab("Scope");
  await page.getByRole("button", { name: "Run", exact: true }).click();
  await page.waitForTimeout(2600);
  for (const name of tab_names) {
    await tab(name);
    await page.waitForTimeout(600);
    if (name === "Plant") {
      await page.keyboard.press("0");
      await page.keyboard.press("r");
      await page.waitForTimeout(1000);
    }
    if (name === "Watch") await page.getByRole("row").nth(1).waitFor();
    if (name === "Scope") {
      await page.keyboard.press("p");
      const box = await page.locator(".picture").boundingBox();
      await page.mouse.click(box.x + box.width * 0.35, box.y + box.height / 2);
      await page.keyboard.down("Shift");
      await page.mouse.click(box.x + box.width * 0.6, box.y + box.height / 2);
      await page.keyboard.up("Shift");
      await page.waitForTimeout(1500);
    }
    await page.screenshot({ path: image(name) });
    if (name === "Scope") await page.keyboard.press("r");
  }
  await phones();
  execFileSync(`${project}docs/images/smaller.sh`, [...tab_names, "phone"].map(image));
} finally {
  await browser.close();
  await server.stop();
}
