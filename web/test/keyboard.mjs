// Hands on the keyboard and nothing else: Tab until something of that name has the focus, then a key.
import assert from "node:assert";

// What a person with a screen reader hears of the element that has the focus.
const focused = (page) =>
  page.evaluate(() => {
    const element = document.activeElement;
    const text = (one) => one?.textContent?.trim();
    return element?.getAttribute("aria-label") ?? text(element?.labels?.[0]) ?? text(element) ?? "";
  });

const fits = (name, wanted) => (wanted instanceof RegExp ? wanted.test(name) : name === wanted);

export async function tabTo(page, name) {
  const seen = [];
  for (let n = 0; n < 200; ++n) {
    await page.keyboard.press("Tab");
    const now = await focused(page);
    if (fits(now, name)) return;
    seen.push(now.slice(0, 30));
  }
  assert.fail(`${name} is not reached by Tab: ${[...new Set(seen)].join(" | ")}`);
}

export async function press(page, name, key = "Enter") {
  await tabTo(page, name);
  await page.keyboard.press(key);
}

export async function type(page, name, text) {
  await tabTo(page, name);
  await page.keyboard.press("Control+A");
  await page.keyboard.type(text);
}

// A list chooses what begins with these letters.
export async function choose(page, name, text) {
  await tabTo(page, name);
  await page.keyboard.type(text);
}

// Out of a text, so that letters are commands again.
export const leave = (page) => page.keyboard.press("Escape");
