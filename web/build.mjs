// Bundles the page into one HTML document without any other request: dist/index.html.
//   node build.mjs [FILE]     writes it somewhere else, for the test that compares
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

import { build } from "esbuild";

const here = dirname(fileURLToPath(import.meta.url));
const output = process.argv[2] ?? join(here, "dist/index.html");

async function bundle(entry, options) {
  const result = await build({
    entryPoints: [join(here, "src", entry)],
    absWorkingDir: here,
    bundle: true,
    minify: true,
    write: false,
    charset: "utf8",
    legalComments: "none",
    target: ["chrome105", "firefox110", "safari16"],
    ...options,
  });
  return result.outputFiles[0].text.trim();
}

const style = await bundle("style/page.css", {});
const script = await bundle("main.tsx", { format: "iife", jsx: "automatic", jsxImportSource: "preact" });
const html = readFileSync(join(here, "src/page.html"), "utf8")
  .replace("/*style*/", () => style.replaceAll("</style", "<\\/style"))
  .replace("/*script*/", () => script.replaceAll("</script", "<\\/script"));
mkdirSync(dirname(output), { recursive: true });
writeFileSync(output, html);
console.log(`${output}: ${html.length} characters`);
