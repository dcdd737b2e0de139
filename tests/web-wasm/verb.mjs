// node verb.mjs WASM_FOLDER WORD...: a verb of ipos in WebAssembly, as the native program has it on a command line. It sees no
// files of this machine.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";

import "./instance.js";

const [folder, ...words] = process.argv.slice(2);
const ipos = createRequire(import.meta.url)(join(folder, "ipos.js"));
const wasm = await WebAssembly.compile(readFileSync(join(folder, "ipos.wasm")));
const { code, out, err } = await globalThis.runVerb(ipos, wasm, { folder: "/", files: {}, words });
process.stdout.write(out);
process.stderr.write(err);
process.exitCode = code;
