// What the programs of tests/bench and the plants of 64 drives take in WebAssembly and natively, as time of processors and on the
// clock: the same command line in turn, the best of several rounds each. The engine of JavaScript compiles hot functions once more
// on another processor, which the first of the two times has in it. Prints a table.
//   node speed.mjs IPOS WASM_FOLDER PROJECT PLANTS [ROUNDS]      PLANTS is of `ipos_bench_plant write`
import { spawnSync } from "node:child_process";
import { readFileSync, readdirSync } from "node:fs";
import { createRequire } from "node:module";
import { cpus } from "node:os";
import { join } from "node:path";

import { filesOf } from "./cases.mjs";
import "./instance.js";

const [program, wasm_folder, project, plants, rounds = "5"] = process.argv.slice(2);
const ipos = createRequire(import.meta.url)(join(wasm_folder, "ipos.js"));
const wasm = await WebAssembly.compile(readFileSync(join(wasm_folder, "ipos.wasm")));

// `small` is what start, reading and compiling take, which is taken off.
const cases = [
  ...readdirSync(join(project, "tests/bench/programs"))
    .filter((name) => name.endsWith(".IPC"))
    .map((name) => ({
      name: name.slice(0, -4),
      folder: join(project, "tests/bench/programs"),
      words: ["run", name, "--unit", "mdxb", "--speed", "1000000", "--engine", "fast"],
      long: ["--until", "end"],
      small: ["--for", "0ms"],
    })),
  ...["busy", "travel"].map((name) => ({
    name: `64 drives, ${name}`,
    folder: join(plants, name),
    words: ["run", "plant.toml", "--engine", "fast"],
    long: ["--for", "20s"],
    small: ["--for", "0ms"],
  })),
];

async function inWasm({ folder }, files, words) {
  const began = process.cpuUsage();
  const since = performance.now();
  const { code, err } = await globalThis.runVerb(ipos, wasm, { folder, files, words });
  const clock = performance.now() - since;
  if (code !== 0) throw new Error(`${words.join(" ")}: ${err}`);
  const { user, system } = process.cpuUsage(began);
  return { cpu: (user + system) / 1000, clock };
}

function natively({ folder }, words) {
  const timed = ["-c", 'TIMEFORMAT="%U %S %R"; time "$@"', "bash", program, ...words];
  const { status, stderr } = spawnSync("bash", timed, { cwd: folder, encoding: "utf8" });
  if (status !== 0) throw new Error(`${words.join(" ")}: ${stderr}`);
  const [user, system, clock] = stderr.trim().split("\n").pop().split(" ").map(Number);
  return { cpu: (user + system) * 1000, clock: clock * 1000 };
}

console.log(`${cpus()[0]?.model}, node ${process.version}, best of ${rounds}`);
console.log("| program | native, ms | WebAssembly, ms | ratio | ratio on the clock |\n| --- | --- | --- | --- | --- |");
for (const one of cases) {
  const files = filesOf(one.folder);
  const best = {};
  const take = (name, { cpu, clock }) => {
    best[name] ??= { cpu: Infinity, clock: Infinity };
    best[name].cpu = Math.min(best[name].cpu, cpu);
    best[name].clock = Math.min(best[name].clock, clock);
  };
  for (let round = 0; round < Number(rounds); ++round) {
    take("native", natively(one, [...one.words, ...one.long]));
    take("wasm", await inWasm(one, files, [...one.words, ...one.long]));
    take("native_small", natively(one, [...one.words, ...one.small]));
    take("wasm_small", await inWasm(one, files, [...one.words, ...one.small]));
  }
  const native = (time) => best.native[time] - best.native_small[time];
  const in_wasm = (time) => best.wasm[time] - best.wasm_small[time];
  const ratio = (time) => (in_wasm(time) / native(time)).toFixed(2);
  console.log(`| ${one.name} | ${native("cpu").toFixed(0)} | ${in_wasm("cpu").toFixed(0)} | ${ratio("cpu")} | ${ratio("clock")} |`);
}
