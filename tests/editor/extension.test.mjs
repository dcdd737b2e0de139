// The extension out of its package, with stand-ins for the functions of VS Code: what its manifest names is there, it
// starts the language server, hands it an open program and shows the message that comes back; its Test Explorer finds
// the tests of a project and shows which fail, and where.
//   IPOS_PROGRAM=.../ipos IPOS_VSIX=.../ipos.vsix node --test extension.test.mjs
import assert from "node:assert";
import { spawnSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import Module, { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import test, { after } from "node:test";
import { pathToFileURL } from "node:url";

const { IPOS_PROGRAM: program, IPOS_VSIX: vsix } = process.env;
assert.ok(program && vsix, "IPOS_PROGRAM and IPOS_VSIX name the program and the package");

const folder = mkdtempSync(join(tmpdir(), "ipos-vsix-"));
after(() => rmSync(folder, { recursive: true }));
const unpacked = spawnSync("python3", ["-m", "zipfile", "-e", vsix, folder], { encoding: "utf8" });
assert.strictEqual(unpacked.status, 0, unpacked.stderr);
const root = join(folder, "extension");
const manifest = JSON.parse(readFileSync(join(root, "package.json"), "utf8"));

test("every file that the manifest names is in the package", () => {
  const { languages, grammars, snippets } = manifest.contributes;
  const named = [manifest.main, ...languages.map((row) => row.configuration), ...grammars.map((row) => row.path),
                 ...snippets.map((row) => row.path)];
  assert.ok(named.length >= 4);
  for (const name of named) assert.ok(existsSync(join(root, name)), name);
  for (const name of named.filter((name) => name.endsWith(".json")))
    assert.doesNotThrow(() => JSON.parse(readFileSync(join(root, name), "utf8")), name);
  assert.ok(!existsSync(join(root, "node_modules")), "all scripts are in one file");
});

// What is not written out below is a function, a class and an object at once, of which nothing comes.
const anything = () =>
  new Proxy(class {}, {
    get: (target, name) => {
      if (name === "prototype" || name in target) return target[name];
      if (name === Symbol.toPrimitive) return () => "";
      if (name === "then") return undefined;  // who awaits it has it at once
      return (target[name] = anything());
    },
    apply: () => ({ dispose() {} }),
  });

class Uri {
  constructor(text) { this.text = text; }
  static parse(text) { return new Uri(text); }
  static file(path) { return new Uri(pathToFileURL(path).toString()); }
  get scheme() { return this.text.split(":")[0]; }
  get fsPath() { return new URL(this.text).pathname; }
  toString() { return this.text; }
}
class Position { constructor(line, character) { Object.assign(this, { line, character }); } }
class Range {
  constructor(line, character, endLine, endCharacter) {
    this.start = new Position(line, character);
    this.end = new Position(endLine, endCharacter);
  }
}
class Diagnostic { constructor(range, message, severity) { Object.assign(this, { range, message, severity }); } }
class EventEmitter {
  listeners = [];
  event = (listener, self) => { this.listeners.push(listener.bind(self)); return { dispose() {} }; };
  fire(what) { for (const listener of this.listeners) listener(what); }
  dispose() {}
}

class Disposable {
  constructor(act) { this.dispose = act; }
  static from(...all) { return new Disposable(() => { for (const one of all) one.dispose(); }); }
}
class CancellationTokenSource {
  token = { isCancellationRequested: false, onCancellationRequested: () => ({ dispose() {} }) };
  cancel() { this.token.isCancellationRequested = true; }
  dispose() {}
}

// The Test Explorer's items and runs, as far as an extension sees them.
class Items extends Map {
  add(item) { this.set(item.id, item); }
  replace(items) { this.clear(); for (const item of items) this.add(item); }
  forEach(act) { for (const item of this.values()) act(item); }
  *[Symbol.iterator]() { yield* this.entries(); }
}
class Explorer {
  items = new Items();
  profiles = [];
  runs = [];
  createTestItem(id, label, uri) { return { id, label, uri, children: new Items() }; }
  createRunProfile(label, kind, run) { this.profiles.push({ label, run }); return disposable; }
  createTestRun() {
    const run = { log: [], ended: false };
    for (const what of ["started", "passed", "failed", "errored", "skipped"])
      run[what] = (item, messages) => run.log.push({ what, id: item.id, messages });
    run.end = () => { run.ended = true; };
    this.runs.push(run);
    return run;
  }
  dispose() {}
}

const disposable = { dispose() {} };
const event = () => disposable;
const program_text = "long lTeeth;\nmain()\n{\n    lTooth = 2;\n}\n";
const file = join(folder, "SAW.IPC");
writeFileSync(file, program_text);
const project = spawnSync(program, ["new", "line"], { cwd: folder, encoding: "utf8" });
assert.strictEqual(project.status, 0, project.stderr);
const document = { uri: Uri.file(file), languageId: "ipos", version: 1, getText: () => program_text, isDirty: false };
const shown = new Map();
const registered = { commands: [], debuggers: [], tasks: [], schemes: [], errors: [] };
const explorer = new Explorer();

const real = {
  Uri, Position, Range, Diagnostic, EventEmitter, Disposable, CancellationTokenSource,
  Location: class { constructor(uri, range) { Object.assign(this, { uri, range }); } },
  TestMessage: class { constructor(message) { this.message = message; } },
  version: manifest.engines.vscode.replace("^", ""),
  env: { appName: "test", language: "en" },
  DiagnosticSeverity: { Error: 0, Warning: 1, Information: 2, Hint: 3 },
  languages: Object.assign(anything(), {
    createDiagnosticCollection: () => ({
      set: (uri, messages) => shown.set(uri.toString(), messages), delete: (uri) => shown.delete(uri.toString()),
      clear: () => shown.clear(), dispose() {},
    }),
    match: (selector, asked) => [selector].flat().some((row) => row.language === asked.languageId) ? 10 : 0,
  }),
  window: Object.assign(anything(), {
    createOutputChannel: () => ({ append() {}, appendLine() {}, show() {}, dispose() {} }),
    showErrorMessage: (message) => { registered.errors.push(message); return Promise.resolve(); },
    visibleTextEditors: [], activeTextEditor: undefined, tabGroups: Object.assign(anything(), { all: [] }),
  }),
  workspace: Object.assign(anything(), {
    workspaceFolders: [{ uri: Uri.file(folder), name: "test", index: 0 }],
    textDocuments: [document], notebookDocuments: [],
    getConfiguration: () => ({ get: (name, otherwise) => (name === "path" ? program : otherwise) }),
    createFileSystemWatcher: () => ({ onDidCreate: event, onDidChange: event, onDidDelete: event, dispose() {} }),
    registerTextDocumentContentProvider: (scheme) => { registered.schemes.push(scheme); return disposable; },
  }),
  commands: Object.assign(anything(), {
    registerCommand: (name) => { registered.commands.push(name); return disposable; },
  }),
  debug: Object.assign(anything(), {
    registerDebugAdapterDescriptorFactory: (type) => { registered.debuggers.push(type); return disposable; },
  }),
  tests: { createTestController: () => explorer },
  tasks: Object.assign(anything(), {
    registerTaskProvider: (type) => { registered.tasks.push(type); return disposable; },
  }),
};
const vscode = new Proxy(real, {
  get: (target, name) => (name in target ? target[name] : (target[name] = anything())),
});
const load = Module._load;
Module._load = (name, ...rest) => (name === "vscode" ? vscode : load(name, ...rest));
const extension = createRequire(import.meta.url)(join(root, manifest.main));
after(() => extension.deactivate());

async function comes(what) {
  for (;;) {
    const value = what();
    if (value) return value;
    await new Promise((resolve) => setTimeout(resolve, 20));
  }
}

test("it starts, and the message of a program comes to the editor", { timeout: 60000 }, async () => {
  await extension.activate({ subscriptions: [] });
  assert.deepStrictEqual(registered.errors, []);
  const lenses = ["ipos.run", "ipos.debug", "ipos.test", "ipos.open"];  // the server names them, no menu does
  assert.deepStrictEqual(registered.commands.filter((name) => name.startsWith("ipos.")),
                         [...manifest.contributes.commands.map((row) => row.command), ...lenses]);
  assert.deepStrictEqual(registered.debuggers, manifest.contributes.debuggers.map((row) => row.type));
  assert.deepStrictEqual(registered.tasks, manifest.contributes.taskDefinitions.map((row) => row.type));
  assert.deepStrictEqual(registered.schemes, ["ipos"]);

  const [message] = await comes(() => shown.get(document.uri.toString())?.length && shown.get(document.uri.toString()));
  assert.match(message.message, /lTooth/);
  assert.strictEqual(message.range.start.line, 3);
  assert.strictEqual(message.severity, 0);
});

test("the Test Explorer finds the test of a new project, runs it, and shows what fails where", { timeout: 60000 }, async () => {
  const [item] = await comes(() => explorer.items.size && [...explorer.items.values()]);
  assert.strictEqual(item.label, join("line", "line.test.toml"));
  const [one] = item.children.values();
  assert.strictEqual(item.children.size, 1);
  assert.strictEqual(one.range.start.line, 0);

  const [profile] = explorer.profiles;
  const token = new CancellationTokenSource().token;
  await profile.run({ include: [one] }, token);
  await profile.run({}, token);
  for (const run of explorer.runs) {
    assert.deepStrictEqual(run.log.map(({ what, id }) => [what, id]), [["started", one.id], ["passed", one.id]]);
    assert.ok(run.ended);
  }

  const wrong = readFileSync(item.uri.fsPath, "utf8").replace("equals = 40960", "equals = 40000");
  writeFileSync(item.uri.fsPath, wrong);
  await profile.run({ include: [item] }, token);
  const [, failed] = explorer.runs.at(-1).log;
  assert.deepStrictEqual([failed.what, failed.id], ["failed", one.id]);
  assert.strictEqual(failed.messages.length, 1);
  const [{ message, location }] = failed.messages;
  assert.match(message, /^position of leader is 40960 at 3900 ms, expected 39980 to 40020\n/);
  assert.strictEqual(location.uri.fsPath, item.uri.fsPath);
  const named = wrong.split("\n")[location.range.line];
  assert.match(named, /expect|equals|note/);
});
