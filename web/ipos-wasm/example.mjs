// node example.mjs FOLDER, which is examples/hoist of the project: a hoist goes down to its limit switch and up.
import { readFile } from "node:fs/promises";
import { join } from "node:path";

import { load } from "./index.js"; // "ipos-wasm" where it is installed

const files = {};
for (const name of ["hoist.toml", "HOIST.IPC"]) files[name] = await readFile(join(process.argv[2], name), "utf8");

const ipos = await load();
const plant = ipos.open(files, "hoist.toml");
for (let n = 0; n < 8; ++n) {
  plant.run(500);
  console.log(`${plant.time} ms  ${plant.text("hoist.speed")}  ${plant.why("hoist")}`);
}
console.log(plant.hash());
plant.close();
