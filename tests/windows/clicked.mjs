// Looks at the page that a double click has opened: it has an element of that role and name, within a minute.
//   node clicked.mjs PACKAGES ADDRESS ROLE NAME      PACKAGES: a copy of web with its packages installed
import { pathToFileURL } from "node:url";

const [packages, address, role, name] = process.argv.slice(2);
const { launch, openPage } = await import(pathToFileURL(`${packages}/test/browser.mjs`));
const browser = await launch();
const { page } = await openPage(browser, address);
await page.getByRole(role, { name, exact: true }).waitFor({ timeout: 60_000 });
await browser.close();
