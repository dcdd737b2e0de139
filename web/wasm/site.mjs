// Makes what runs in a browser alone of the page, its worker, and ipos as WebAssembly: ipos.html, one file, and the folder
// site, where ipos.wasm lies beside index.html.
//   node site.mjs PAGE WORKER IPOS_FOLDER OUT       IPOS_FOLDER has ipos.js and ipos.wasm
import { execFileSync } from "node:child_process";
import { copyFileSync, mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { bytesOfText, textOf } from "../src/alone/text_bytes.mjs";

const [page_file, worker_file, ipos_folder, out] = process.argv.slice(2);
const most_bytes = 2_500_000; // of ipos.html

mkdirSync(join(out, "site"), { recursive: true });

// zopfli makes what any browser inflates, 5 % smaller than zlib does.
function packed(bytes) {
  const file = join(out, "to-pack");
  writeFileSync(file, bytes);
  const small = execFileSync("zopfli", ["--i5", "-c", file], { maxBuffer: 2 * most_bytes });
  rmSync(file);
  return small;
}

const page = readFileSync(page_file, "utf8");
const script = `${readFileSync(join(ipos_folder, "ipos.js"), "utf8")}\n${readFileSync(worker_file, "utf8")}`;

function element(id, bytes) {
  const small = packed(bytes);
  return `<script type="text/plain" id="${id}" data-bytes="${small.length}">${textOf(small)}</script>\n`;
}

// Before the page's own script, which looks for them.
const worker = element("ipos-worker", script);
const before = '<div id="page"></div>\n';
const place = page.indexOf(before) + before.length;
function pageWith(wasm_element, end) {
  return page.slice(0, place) + worker + wasm_element + end;
}

// In the one file the page's own script is packed, too: this one unpacks and begins it.
async function begin(bytesOfText) {
  const page = document.getElementById("ipos-page");
  const bytes = bytesOfText(page.textContent, Number(page.dataset.bytes));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  const script = document.createElement("script");
  script.textContent = await new Response(stream).text();
  document.body.append(script);
}
const rest = page.slice(place);
const own = rest.slice(rest.indexOf("<script>") + "<script>".length, rest.lastIndexOf("</script>"));

const alone = pageWith(element("ipos-wasm", readFileSync(join(ipos_folder, "ipos.wasm"))), rest.replace(own, () => `(${begin})(${bytesOfText})`).replace("<script>", () => `${element("ipos-page", own)}<script>`));
writeFileSync(join(out, "ipos.html"), alone);
writeFileSync(
  join(out, "site/index.html"),
  pageWith('<script type="text/plain" id="ipos-wasm" data-address="ipos.wasm"></script>\n', rest),
);
copyFileSync(join(ipos_folder, "ipos.wasm"), join(out, "site/ipos.wasm"));
const size = Buffer.byteLength(alone);
console.log(`ipos.html: ${size} bytes`);
if (size > most_bytes) throw new Error(`ipos.html has ${size} bytes, at most ${most_bytes} are wanted`);
