// Makes what runs in a browser alone of the page, its worker, and ipos as WebAssembly: ipos.html, one file, and the folder
// site, where ipos.wasm lies beside index.html.
//   node site.mjs PAGE WORKER IPOS_FOLDER OUT       IPOS_FOLDER has ipos.js and ipos.wasm
import { copyFileSync, mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { constants, gzipSync } from "node:zlib";

const [page_file, worker_file, ipos_folder, out] = process.argv.slice(2);
const most_bytes = 2_500_000; // of ipos.html

const packed = (bytes) => gzipSync(bytes, { level: constants.Z_BEST_COMPRESSION });
const page = readFileSync(page_file, "utf8");
const script = `${readFileSync(join(ipos_folder, "ipos.js"), "utf8")}\n${readFileSync(worker_file, "utf8")}`;
const wasm = packed(readFileSync(join(ipos_folder, "ipos.wasm")));

// Before the page's own script, which looks for them.
function pageWith(wasm_element) {
  const worker = `<script type="text/plain" id="ipos-worker">${packed(script).toString("base64")}</script>`;
  const before = '<div id="page"></div>\n';
  const place = page.indexOf(before) + before.length;
  return page.slice(0, place) + worker + "\n" + wasm_element + "\n" + page.slice(place);
}

const alone = pageWith(`<script type="text/plain" id="ipos-wasm">${wasm.toString("base64")}</script>`);
mkdirSync(join(out, "site"), { recursive: true });
writeFileSync(join(out, "ipos.html"), alone);
writeFileSync(
  join(out, "site/index.html"),
  pageWith('<script type="text/plain" id="ipos-wasm" data-address="ipos.wasm"></script>'),
);
copyFileSync(join(ipos_folder, "ipos.wasm"), join(out, "site/ipos.wasm"));
const size = Buffer.byteLength(alone);
console.log(`ipos.html: ${size} bytes`);
if (size > most_bytes) throw new Error(`ipos.html has ${size} bytes, at most ${most_bytes} are wanted`);
