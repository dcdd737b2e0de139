// What runs natively and in WebAssembly: examples, random plants, and the programs of tests/language. A case is a folder, the
// files that belong to it, and the words of a command line.
import { readdirSync, readFileSync } from "node:fs";
import { dirname, join, relative } from "node:path";

function below(folder) {
  return readdirSync(folder, { withFileTypes: true })
    .flatMap((entry) => (entry.isDirectory() ? below(join(folder, entry.name)) : [join(folder, entry.name)]))
    .sort();
}

function isPlant(path) {
  return path.endsWith(".toml") && !/\.(test|campaign)\.toml$/.test(path);
}

const is_source = /\.(IPC|h|toml|ipx)$/i;

// By path from `root`, as base64; below /root where they run.
export function filesOf(folder) {
  return Object.fromEntries(
    below(folder)
      .filter((path) => is_source.test(path))
      .map((path) => [path, readFileSync(path).toString("base64")]),
  );
}

export function exampleCases(project) {
  const plants = below(join(project, "examples")).filter((path) => isPlant(path) && /^\s*\[\[station\]\]/m.test(readFileSync(path, "utf8")));
  return plants.map((path) => ({
    name: relative(project, path),
    folder: dirname(path),
    words: ["run", relative(dirname(path), path), "--for", "10s", "--trace-hash"],
  }));
}

export function plantCases(folder) {
  return readdirSync(folder)
    .sort((a, b) => a - b)
    .map((seed) => ({
      name: `plant ${seed}`,
      folder: join(folder, seed),
      words: ["run", "plant.toml", "--for", "3s", "--trace-hash"],
    }));
}

// Those without messages and faults have a hash; of all of them exit code and texts are compared.
export function languageCases(project) {
  const folder = join(project, "tests/language");
  return below(folder)
    .filter((path) => path.endsWith(".IPC"))
    .map((path) => {
      const unit = /\/\/ unit (\w+)/.exec(readFileSync(path, "latin1"));
      const name = relative(folder, path);
      return {
        name,
        folder,
        own: dirname(path),
        words: ["run", name, "--for", "1s", "--speed", "1000", "--trace-hash", ...(unit ? ["--unit", unit[1]] : [])],
      };
    });
}
