// Bundles the page into one HTML document without any other request, dist/index.html; the worker that it has where no server
// is, dist/index.worker.js; and the page of a plot with the picture alone, dist/plot.html, which `ipos run --plot` fills with a
// recording.
//   node build.mjs [FILE [PLOT]]     writes them somewhere else, for the test that compares
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

import { build } from "esbuild";
import { minify } from "terser";

const here = dirname(fileURLToPath(import.meta.url));
const output = process.argv[2] ?? join(here, "dist/index.html");
const plot = process.argv[3] ?? join(dirname(output), "plot.html");

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

// Terser makes it 3 % smaller, packed, than esbuild alone.
async function smaller(script) {
  const { code } = await minify(script, { ecma: 2020, compress: { passes: 2 } });
  return code;
}

const style = await bundle("style/page.css", {});
const script = await smaller(await bundle("main.tsx", { format: "iife", jsx: "automatic", jsxImportSource: "preact" }));
function write(file, template, parts) {
  let html = readFileSync(join(here, "src", template), "utf8");
  for (const [name, text] of Object.entries(parts)) html = html.replace(`/*${name}*/`, () => text.replaceAll(`</${name}`, `<\\/${name}`));
  mkdirSync(dirname(file), { recursive: true });
  writeFileSync(file, html);
  console.log(`${file}: ${html.length} characters`);
}

write(output, "page.html", { style, script });
write(plot, "picture/plot.html", {
  script: await bundle("picture/plot_page.ts", { format: "iife", loader: { ".css": "text" } }),
});
writeFileSync(output.replace(/\.html$/, ".worker.js"), (await bundle("alone/worker.ts", { format: "iife" })) + "\n");
