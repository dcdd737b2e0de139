// The package ipos-wasm against the native program: trace hashes of all examples and of random plants, images of all programs of
// the examples byte by byte; and each function of it does what index.d.ts says.
//   node package.mjs IPOS PACKAGE PROJECT PLANTS
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, readdirSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, relative } from "node:path";

import { exampleCases, filesOf, plantCases } from "./cases.mjs";

const [program, folder, project, plants] = process.argv.slice(2);
const { IposError, load } = await import(join(folder, "index.js"));
const ipos = await load();
const work = mkdtempSync(join(tmpdir(), "ipos-package-"));
const seconds = 3;

function filesBelow(root) {
  return Object.fromEntries(Object.entries(filesOf(root)).map(([path, bytes]) => [relative(root, path), Buffer.from(bytes, "base64")]));
}
function native(cwd, ...words) {
  return spawnSync(program, words, { cwd, encoding: "utf8" });
}

// Trace hashes.
let hashes = 0;
function compareHash(root, files, main, name) {
  const expected = /trace hash ([0-9a-f]{16})/.exec(native(root, "run", main, "--for", `${seconds}s`, "--trace-hash").stderr);
  if (expected === null) return;
  const plant = ipos.open(files, main);
  plant.run(seconds * 1000);
  assert.equal(plant.time, seconds * 1000);
  assert.equal(plant.hash(), expected[1], name);
  plant.close();
  ++hashes;
}
const examples = join(project, "examples");
const example_files = filesBelow(examples);
for (const one of exampleCases(project)) compareHash(examples, example_files, relative(examples, join(one.folder, one.words[1])), one.name);
const of_examples = hashes;
assert.ok(of_examples >= 20, `${of_examples} examples`);
for (const one of plantCases(plants)) compareHash(one.folder, filesBelow(one.folder), "plant.toml", one.name);
assert.ok(hashes - of_examples >= 20, `${hashes - of_examples} plants`);

// Images.
let images = 0;
for (const name of Object.keys(example_files).filter((one) => one.endsWith(".IPC"))) {
  const output = join(work, "native.ipx");
  const made = native(examples, "build", name, "-o", output);
  const { image, messages } = ipos.compile(example_files, name);
  assert.equal(image !== null, made.status === 0, name);
  if (image === null) continue;
  assert.ok(readFileSync(output).equals(Buffer.from(image)), name);
  assert.ok(messages.every((one) => !one.code.startsWith("E")));
  ++images;
}
assert.ok(images >= 20, `${images} programs`);

// What else there is.
const source = "#include <const.h>\nlong sum;\nmain() { while (1) { sum = sum + 1; _Wait(10); } }\n";
const alone = ipos.open({ "P.IPC": source }, "P.IPC", { speed: 1000 }); // a turn takes 10 ms then
assert.equal(alone.stations.length, 1);
alone.run(95);
assert.equal(alone.read("sum"), 10);
for (let n = 0; n < 10; ++n) alone.step();
assert.equal(alone.time, 105);
assert.equal(alone.read("sum"), 11);
alone.write("sum", 100);
alone.run(10);
assert.equal(alone.read("sum"), 101);
alone.force("sum", 7);
alone.run(100);
assert.equal(alone.read("sum"), 7);
alone.release("sum");
alone.run(10);
assert.equal(alone.read("sum"), 8);
assert.equal(alone.signal("sum").kind, "variable");
assert.equal(alone.signal("sum").writable, true);
assert.deepEqual(alone.names(alone.stations[0].name, "variable"), ["sum"]);
assert.throws(() => alone.read("none"), IposError);
assert.throws(() => alone.run(-1), IposError);
alone.close();

const { image, messages } = ipos.compile({ "P.IPC": "main() { x = 1; }\n" }, "P.IPC");
assert.equal(image, null);
assert.deepEqual([messages[0].code[0], messages[0].line], ["E", 1]);
assert.throws(() => ipos.compile({ "P.IPC": source }, "P.IPC", { unit: "none" }), /no unit/);
assert.throws(
  () => ipos.open({ "p.toml": '[[station]]\nname = "a"\nunit = "none"\n' }, "p.toml"),
  (trouble) => trouble instanceof IposError && trouble.mistakes[0].line === 3,
);

// 1053 1610 p. 57: SCOM1 sends 1024 every 100 ms, eight bytes.
const scom = ipos.open(example_files, "scom/scom.toml");
scom.run(1000);
const frames = scom.frames().filter((one) => one.id === 1024);
assert.ok(frames.length >= 9 && frames.length <= 10, `${frames.length}`);
assert.deepEqual([...frames[0].data], [0x55, 0x66, 0x77, 0x88, 0x11, 0x22, 0x33, 0x44]);
assert.ok(Math.abs(frames[2].time - frames[1].time - 100) < 1);
assert.deepEqual(scom.frames(), []);
scom.send({ id: 0x123, data: [1, 2, 3] });
scom.run(5);
const own = scom.frames().find((one) => one.own);
assert.deepEqual([own.id, own.length, ...own.data], [0x123, 3, 1, 2, 3]);
assert.throws(() => scom.frames("none"), /no bus/);
scom.close();

const example = spawnSync(process.execPath, [join(folder, "example.mjs"), join(examples, "hoist")], { encoding: "utf8" });
assert.equal(example.status, 0, example.stderr);
assert.equal(example.stdout.split("\n").filter((line) => line.includes("rpm")).length, 8);

const types = readFileSync(join(folder, "index.d.ts"), "utf8");
for (const name of Object.getOwnPropertyNames(Object.getPrototypeOf(ipos.open({ "P.IPC": source }, "P.IPC"))))
  if (name !== "constructor") assert.match(types, new RegExp(`\\b${name}\\b`));
const packaged = JSON.parse(readFileSync(join(folder, "package.json"), "utf8"));
assert.deepEqual([...packaged.files].sort(), readdirSync(folder).filter((name) => name !== "package.json").sort());
assert.equal(native(".", "--version").stdout.includes(packaged.version), true);
console.log(`${of_examples} examples and ${hashes - of_examples} plants with equal trace hashes, ${images} images equal`);
