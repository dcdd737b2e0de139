// Makes the package: node pack.mjs SOURCE CORE_FOLDER OUT VERSION LICENCE. CORE_FOLDER has core.js and core.wasm of
// emscripten, and OUT already NOTICES.txt. ipos-plant.js is a classic script of all, with the WebAssembly inside, so that a page of a folder can have the
// element without a server.
import { copyFileSync, mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { constants, gzipSync } from "node:zlib";

const [source, core_folder, out, version, licence] = process.argv.slice(2);
const text = (name) => readFileSync(join(source, name), "utf8");
mkdirSync(out, { recursive: true });
for (const name of ["index.js", "index.d.ts", "element.js", "example.mjs", "README.md"]) copyFileSync(join(source, name), join(out, name));
copyFileSync(licence, join(out, "LICENSE"));
writeFileSync(join(out, "package.json"), `${JSON.stringify({ ...JSON.parse(text("package.json")), version }, null, 2)}\n`);
copyFileSync(join(core_folder, "core.wasm"), join(out, "ipos.wasm"));
const core = readFileSync(join(core_folder, "core.js"), "utf8");
writeFileSync(join(out, "core.js"), `${core}\nexport default ipos_core;\n`);

const notices = readFileSync(join(out, "NOTICES.txt"), "utf8");
const inlined = (name) =>
  text(name)
    .replace(/^import .* from ".*";$/gm, "")
    .replace(/^export /gm, "")
    .replaceAll("import.meta.url", "document.baseURI");
const wasm = gzipSync(readFileSync(join(core_folder, "core.wasm")), { level: constants.Z_BEST_COMPRESSION }).toString("base64");
writeFileSync(
  join(out, "ipos-plant.js"),
  `/*! <ipos-plant> in one classic script: ipos-wasm ${version}.
${notices.replaceAll("*/", "* /")}
*/
(() => {
${core}
const createCore = ipos_core;
${inlined("index.js")}
${inlined("element.js")}
const packed = Uint8Array.from(atob("${wasm}"), (one) => one.charCodeAt(0));
configure({ wasm: new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer() });
})();
`,
);
