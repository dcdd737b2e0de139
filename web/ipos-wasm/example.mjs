// node example.mjs: a hoist goes down to its limit switch and up; its speed each half second.
import { readFile } from "node:fs/promises";

const { load } = await import(process.env.IPOS_WASM ?? "./index.js"); // "ipos-wasm" where it is installed
const examples = new URL("../../examples/hoist/", import.meta.url);
const files = {};
for (const name of ["hoist.toml", "HOIST.IPC"]) files[name] = await readFile(new URL(name, examples), "utf8");

const ipos = await load();
const plant = ipos.open(files, "hoist.toml");
for (let n = 0; n < 8; ++n) {
  plant.run(500);
  console.log(`${plant.time} ms  ${plant.text("hoist.speed")}  ${plant.why("hoist")}`);
}
console.log(plant.hash());
plant.close();
