// The grammar for tree-sitter, read with the words of its language standing in for tree-sitter itself: every rule it
// names is there, and every word of the compiler is in it.
//   node tree_sitter_test.mjs FOLDER
import assert from "node:assert";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join, resolve } from "node:path";

const folder = resolve(process.argv[2]);
const named = new Set();
const texts = new Set();
const note = (parts) => {
  for (const part of parts.flat()) if (typeof part === "string") texts.add(part);
  return parts;
};
const rule = (...parts) => note(parts);
for (const word of ["choice", "seq", "repeat", "optional", "token"]) globalThis[word] = rule;
globalThis.token.immediate = rule;
globalThis.prec = (_level, part) => note([part]);
globalThis.field = (_name, part) => note([part]);
const $ = new Proxy({}, { get: (_, name) => (named.add(name), { name }) });
globalThis.grammar = (made) => made;

const made = createRequire(import.meta.url)(join(folder, "grammar.js"));
made.extras($);
made.word($);
for (const [name, body] of Object.entries(made.rules)) assert.ok(body($) !== undefined, name);
for (const name of named) assert.ok(name in made.rules, `there is no rule ${String(name)}`);
const words = JSON.parse(readFileSync(join(folder, "words.json"), "utf8"));
for (const kind of ["control", "type", "modifier", "operator", "foreign", "directive", "punctuator"])
  for (const word of words[kind]) assert.ok(texts.has(word), `${word} (${kind}) is not in the grammar`);
const queries = readFileSync(join(folder, "queries/highlights.scm"), "utf8");
for (const [, name] of queries.matchAll(/\(([a-z_]+)[ )]/g)) assert.ok(name in made.rules, `no rule ${name} to colour`);
console.log(`${named.size} rules, ${texts.size} texts`);
