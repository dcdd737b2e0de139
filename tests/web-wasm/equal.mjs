// Runs every case natively, in node and in Chromium, and compares exit code, both outputs, and so the trace hash.
//   node equal.mjs IPOS WASM_FOLDER PROJECT PLANTS [node|chromium|both]
// WASM_FOLDER has ipos.js and ipos.wasm, PLANTS a folder for each random plant. Prints what differs; exit 1 then.
import { spawnSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";

import { exampleCases, filesOf, languageCases, plantCases } from "./cases.mjs";
import "./instance.js";

const [ipos_program, wasm_folder, project, plants, where = "both"] = process.argv.slice(2);
const groups = { examples: exampleCases(project), plants: plantCases(plants), language: languageCases(project) };

function native({ folder, words }) {
  const { status, stdout, stderr } = spawnSync(ipos_program, words, { cwd: folder, encoding: "utf8" });
  return { code: status, out: stdout, err: stderr };
}

const wasm_bytes = readFileSync(join(wasm_folder, "ipos.wasm"));

async function nodeRunner() {
  const ipos = createRequire(import.meta.url)(join(wasm_folder, "ipos.js"));
  const wasm = await WebAssembly.compile(wasm_bytes);
  return { run: (asked) => globalThis.runVerb(ipos, wasm, asked), close: async () => undefined };
}

async function chromiumRunner() {
  const { launch } = await import(join(process.cwd(), "test/browser.mjs"));
  const browser = await launch();
  const page = await browser.newPage();
  await page.goto("about:blank");
  await page.addScriptTag({ path: join(wasm_folder, "ipos.js") });
  await page.addScriptTag({ content: readFileSync(new URL("instance.js", import.meta.url), "utf8") });
  await page.evaluate(async (bytes) => {
    globalThis.wasm = await WebAssembly.compile(Uint8Array.from(atob(bytes), (c) => c.charCodeAt(0)));
  }, wasm_bytes.toString("base64"));
  return {
    run: (asked) => page.evaluate((asked) => globalThis.runVerb(globalThis.ipos, globalThis.wasm, asked), asked),
    close: () => browser.close(),
  };
}

const runners = {};
if (where !== "chromium") runners.node = await nodeRunner();
if (where !== "node") runners.chromium = await chromiumRunner();

let different = 0;
for (const [group, cases] of Object.entries(groups)) {
  let equal = 0;
  let hashes = 0;
  for (const one of cases) {
    const files = filesOf(one.own ?? one.folder);
    const expected = native(one);
    if (/trace hash [0-9a-f]{16}/.test(expected.err)) ++hashes;
    for (const [name, runner] of Object.entries(runners)) {
      const { code, out, err } = await runner.run({ folder: one.folder, files, words: one.words });
      if (code === expected.code && out === expected.out && err === expected.err) ++equal;
      else {
        ++different;
        console.log(`${group} ${one.name} differs in ${name}: ${JSON.stringify({ code, out: out.slice(0, 400), err: err.slice(0, 400) })}`);
        console.log(`  native: ${JSON.stringify({ ...expected, out: expected.out.slice(0, 400), err: expected.err.slice(0, 400) })}`);
      }
    }
  }
  console.log(`${group}: ${cases.length} cases, ${hashes} with a trace hash, ${equal} of ${cases.length * Object.keys(runners).length} runs equal`);
}
for (const runner of Object.values(runners)) await runner.close();
process.exit(different === 0 ? 0 : 1);
