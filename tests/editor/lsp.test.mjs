// ipos lsp as an editor meets it: a process, driven by the packages VS Code itself uses.
//   IPOS_PROGRAM=.../ipos node --test lsp.test.mjs
import assert from "node:assert";
import { spawn, spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import test from "node:test";
import { pathToFileURL } from "node:url";

import rpc from "vscode-jsonrpc/node.js";
import lsp from "vscode-languageserver-protocol";

const program = process.env.IPOS_PROGRAM;
assert.ok(program, "IPOS_PROGRAM names the ipos to test");

const header = "#define SLAVE 1 // address of the slave\nlong shared;\n";
const main = `#include <const.h>
#include "common.h"
typedef struct { long target; long speed[2]; } Axis;
Axis left;
long speed;  // in rpm
MOVLNK Ml;
main()
{
  Ml.Index = 8318;
  Ml.Address = SLAVE;
  left.speed[1] = speed + H7;
  StatusWord;
  shared = 1;
  while (1) { step(); _Wait(100); }
}
step() { speed++; }
`;
const other = '#include "common.h"\nlong taken;\nmain() { taken = shared; }\n';

// A server with a folder of two programs that share a header; `use` gets the connection and helpers.
async function session(use, options = {}) {
  const folder = mkdtempSync(join(tmpdir(), "ipos-lsp-"));
  // A server on Windows gets names with a drive, as VS Code writes them.
  const root = process.env.IPOS_DRIVE ? `file:///${process.env.IPOS_DRIVE}%3A/` : "file:///";
  const uri = (name) => pathToFileURL(join(folder, name)).toString().replace("file:///", root);
  const folderUri = uri(".");
  for (const [name, text] of Object.entries({ "common.h": header, "MAIN.IPC": main, "OTHER.IPC": other }))
    writeFileSync(join(folder, name), text);
  const child = spawn(program, ["lsp"], { stdio: ["pipe", "pipe", "inherit"] });
  const ended = new Promise((resolve) => child.on("exit", resolve));
  const connection = rpc.createMessageConnection(
    new rpc.StreamMessageReader(child.stdout),
    new rpc.StreamMessageWriter(child.stdin),
  );
  const diagnostics = new Map();
  const waiting = [];
  connection.onNotification(lsp.PublishDiagnosticsNotification.type, (params) => {
    diagnostics.set(params.uri, params.diagnostics);
    for (const one of waiting.splice(0)) one();
  });
  connection.listen();
  const published = async (name, holds) => {
    while (!diagnostics.has(uri(name)) || !holds(diagnostics.get(uri(name))))
      await new Promise((resolve) => waiting.push(resolve));
    return diagnostics.get(uri(name));
  };
  const open = (name, text) =>
    connection.sendNotification(lsp.DidOpenTextDocumentNotification.type, {
      textDocument: { uri: uri(name), languageId: "ipos", version: 1, text: text ?? readFileSync(join(folder, name), "utf8") },
    });
  // Place of the n-th `word` in a text of the folder.
  const place = (name, word, nth = 1, text = readFileSync(join(folder, name), "utf8")) => {
    let at = -1;
    for (let n = 0; n < nth; ++n) at = text.indexOf(word, at + 1);
    assert.ok(at >= 0, `${word} is not in ${name}`);
    const before = text.slice(0, at).split("\n");
    return { textDocument: { uri: uri(name) }, position: { line: before.length - 1, character: before.at(-1).length } };
  };
  try {
    const result = await connection.sendRequest(lsp.InitializeRequest.type, {
      processId: process.pid,
      rootUri: null,
      workspaceFolders: [{ uri: folderUri, name: "test" }],
      capabilities: {},
      ...options,
    });
    await connection.sendNotification(lsp.InitializedNotification.type, {});
    await use({ connection, uri, open, place, published, result, folder });
    await connection.sendRequest(lsp.ShutdownRequest.type);
    await connection.sendNotification(lsp.ExitNotification.type);
    assert.strictEqual(await ended, 0);
  } finally {
    connection.dispose();
    child.kill();
    rmSync(folder, { recursive: true });
  }
}

function applied(text, edits) {
  const lines = text.split("\n");
  const offset = ({ line, character }) => lines.slice(0, line).join("\n").length + (line > 0 ? 1 : 0) + character;
  return [...edits]
    .sort((a, b) => offset(b.range.start) - offset(a.range.start))
    .reduce((out, edit) => out.slice(0, offset(edit.range.start)) + edit.newText + out.slice(offset(edit.range.end)), text);
}

test("diagnostics come with code, place and notes, and go when they are mended", () =>
  session(async ({ connection, open, uri, published }) => {
    await open("MAIN.IPC", main.replace("step() { speed++; }", "step() { sped++; }"));
    const all = await published("MAIN.IPC", (some) => some.some((one) => one.severity === 1));
    const error = all.find((one) => one.severity === 1);
    assert.match(error.message, /sped/);
    assert.match(error.code, /^E\d{4}$/);
    assert.strictEqual(error.source, "ipos");
    assert.deepStrictEqual(error.range.start, { line: 15, character: 9 });
    assert.ok(error.relatedInformation.some((note) => note.message.includes("speed")));
    await connection.sendNotification(lsp.DidChangeTextDocumentNotification.type, {
      textDocument: { uri: uri("MAIN.IPC"), version: 2 },
      contentChanges: [
        { range: { start: { line: 15, character: 9 }, end: { line: 15, character: 13 } }, text: "speed" },
      ],
    });
    await published("MAIN.IPC", (all) => !all.some((one) => one.severity === 1));
  }));

test("what no test notices appears beside the program when the tests were tried, and goes with a change", async () => {
  const cache = mkdtempSync(join(tmpdir(), "ipos-cache-"));
  process.env.XDG_CACHE_HOME = cache;
  try {
    await session(async ({ connection, folder, open, uri, published }) => {
      const text = "long a, b;\nmain()\n{\n    a = 5;\n    b = 6;\n}\n// expect a == 5\n";
      writeFileSync(join(folder, "T.IPC"), text);
      await open("T.IPC");
      const ours = (all) => all.filter((one) => one.source === "ipos test");
      await published("T.IPC", (all) => ours(all).length === 0);
      const tried = spawnSync(program, ["test", "--mutate", "T.IPC"], { cwd: folder, encoding: "utf8" });
      assert.strictEqual(tried.status, 1, tried.stderr);
      const shown = ours(await published("T.IPC", (all) => ours(all).length > 0));
      assert.deepStrictEqual(
        shown.map((one) => `${one.severity} ${one.range.start.line}:${one.range.start.character} ${one.message}`),
        ["3 4:4 no test notices: removed: b = 6;", "3 4:8 no test notices: 6 became 7"],
      );
      await connection.sendNotification(lsp.DidChangeTextDocumentNotification.type, {
        textDocument: { uri: uri("T.IPC"), version: 2 },
        contentChanges: [{ text: text.replace("6", "8") }],
      });
      await published("T.IPC", (all) => ours(all).length === 0);
    });
  } finally {
    delete process.env.XDG_CACHE_HOME;
    rmSync(cache, { recursive: true });
  }
});

test("hover tells meaning, number, unit and manual page", () =>
  session(async ({ connection, open, place }) => {
    await open("MAIN.IPC");
    const hover = async (...where) => (await connection.sendRequest(lsp.HoverRequest.type, place(...where))).contents.value;
    assert.match(await hover("MAIN.IPC", "_Wait"), /milliseconds/);
    assert.match(await hover("MAIN.IPC", "StatusWord"), /H473[^]*IPOSplus p\. 34/);
    assert.match(await hover("MAIN.IPC", "8318"), /Speed[^]*8318/i);
    const speed = await hover("MAIN.IPC", "speed;  //");
    assert.match(speed, /H424/);
    assert.match(speed, /in rpm/);
    assert.match(speed, /written in step/);
    assert.match(await hover("MAIN.IPC", "speed[1]"), /H422/);
    assert.match(await hover("MAIN.IPC", "SLAVE"), /#define SLAVE 1[^]*address of the slave/);
    assert.match(await hover("MAIN.IPC", "Index"), /MOVLNK\.Index[^]*H429/);
  }));

test("definition leads into the program, the header and the built-in header", () =>
  session(async ({ connection, open, place, uri }) => {
    await open("MAIN.IPC");
    const definition = (...where) => connection.sendRequest(lsp.DefinitionRequest.type, place(...where));
    assert.deepStrictEqual(await definition("MAIN.IPC", "shared = 1"), [
      { uri: uri("common.h"), range: { start: { line: 1, character: 5 }, end: { line: 1, character: 11 } } },
    ]);
    assert.strictEqual((await definition("MAIN.IPC", "SLAVE"))[0].range.start.line, 0);
    assert.strictEqual((await definition("MAIN.IPC", "step();"))[0].range.start.line, 15);
    assert.strictEqual((await definition("MAIN.IPC", "common.h")).uri, uri("common.h"));
    const [status] = await definition("MAIN.IPC", "StatusWord");
    assert.strictEqual(status.uri, "ipos:/const.h");
    const { text } = await connection.sendRequest("ipos/header", { uri: status.uri });
    assert.match(text.split("\n")[status.range.start.line], /#define StatusWord/);
  }));

test("completion knows members while the statement is broken, and all names elsewhere", () =>
  session(async ({ connection, open, place }) => {
    const text = main.replace("shared = 1;", "left.\n  ");
    await open("MAIN.IPC", text);
    const labels = async (where) => (await connection.sendRequest(lsp.CompletionRequest.type, where)).map((one) => one.label);
    const behind = place("MAIN.IPC", "left.\n", 1, text);
    behind.position.character += 5;
    assert.deepStrictEqual(await labels(behind), ["target", "speed"]);
    const names = await labels(place("MAIN.IPC", "while", 1, text));
    for (const name of ["left", "speed", "step", "SLAVE", "_MoviLink", "SCREC", "switch", "StatusWord"])
      assert.ok(names.includes(name), name);
  }));

test("signature help follows the arguments", () =>
  session(async ({ connection, open, place }) => {
    const text = main.replace("shared = 1;", "_BitMove(H1, ");
    await open("MAIN.IPC", text);
    const where = place("MAIN.IPC", "_BitMove(H1, ", 1, text);
    where.position.character += "_BitMove(H1, ".length;
    const help = await connection.sendRequest(lsp.SignatureHelpRequest.type, where);
    assert.strictEqual(help.signatures[0].label, "_BitMove(variable, bit, variable, bit)");
    assert.strictEqual(help.activeParameter, 1);
  }));

test("references and rename reach every program of the folder, and the result compiles to the same image", () =>
  session(async ({ connection, open, place, uri, folder }) => {
    await open("MAIN.IPC");
    const where = place("MAIN.IPC", "shared = 1");
    const all = await connection.sendRequest(lsp.ReferencesRequest.type, { ...where, context: { includeDeclaration: true } });
    assert.deepStrictEqual(all.map((one) => one.uri).sort(), [uri("MAIN.IPC"), uri("OTHER.IPC"), uri("common.h")]);

    const image = (name) => {
      const { status, stdout, stderr } = spawnSync(program, ["build", join(folder, name), "--emit=asm"], { encoding: "utf8" });
      assert.strictEqual(status, 0, stderr);
      return stdout;
    };
    const before = ["MAIN.IPC", "OTHER.IPC"].map(image);
    assert.strictEqual((await connection.sendRequest(lsp.PrepareRenameRequest.type, where)).placeholder, "shared");
    const { changes } = await connection.sendRequest(lsp.RenameRequest.type, { ...where, newName: "common" });
    for (const name of ["MAIN.IPC", "OTHER.IPC", "common.h"]) {
      const path = join(folder, name);
      writeFileSync(path, applied(readFileSync(path, "utf8"), changes[uri(name)]));
      assert.ok(!readFileSync(path, "utf8").includes("shared"));
    }
    assert.deepStrictEqual(["MAIN.IPC", "OTHER.IPC"].map(image), before);
  }));

test("rename refuses system names and clashes", () =>
  session(async ({ connection, open, place }) => {
    await open("MAIN.IPC");
    const refused = (word, newName, reason) =>
      assert.rejects(connection.sendRequest(lsp.RenameRequest.type, { ...place("MAIN.IPC", word), newName }), reason);
    await refused("_Wait", "Pause", /name of the language/);
    await refused("StatusWord", "Status", /built-in const\.h/);
    await refused("H7", "H8", /name of the language/);
    await refused("Index", "Idx", /name of the language/);
    await refused("main()", "start", /task 1/);
    await refused("shared = 1", "speed", /MAIN\.IPC/);
    await refused("shared = 1", "taken", /OTHER\.IPC/);
    await refused("speed;  //", "while", /word of the language/);
    await refused("speed;  //", "H12", /variable of the unit/);
    await refused("speed;  //", "2fast", /no name/);
    await refused("speed;  //", "SLAVE", /MAIN\.IPC/);
  }));

test("symbols of the file and of the folder", () =>
  session(async ({ connection, open, uri }) => {
    await open("MAIN.IPC");
    const outline = await connection.sendRequest(lsp.DocumentSymbolRequest.type, { textDocument: { uri: uri("MAIN.IPC") } });
    assert.deepStrictEqual(outline.map((one) => one.name).sort(), ["Axis", "Ml", "left", "main", "speed", "step"]);
    assert.deepStrictEqual(outline.find((one) => one.name === "Axis").children.map((one) => one.name), ["target", "speed"]);
    const found = await connection.sendRequest(lsp.WorkspaceSymbolRequest.type, { query: "tkn" });
    assert.deepStrictEqual(found.map((one) => [one.name, one.location.uri]), [["taken", uri("OTHER.IPC")]]);
  }));

test("formatting gives what ipos fmt gives", () =>
  session(async ({ connection, open, uri, folder }) => {
    await open("MAIN.IPC");
    const edits = await connection.sendRequest(lsp.DocumentFormattingRequest.type, {
      textDocument: { uri: uri("MAIN.IPC") },
      options: { tabSize: 4, insertSpaces: true },
    });
    const path = join(folder, "MAIN.IPC");
    assert.strictEqual(spawnSync(program, ["fmt", path]).status, 0);
    assert.strictEqual(applied(main, edits), readFileSync(path, "utf8"));
  }));

test("columns count UTF-16 units, or bytes when the editor asks for UTF-8", async () => {
  const text = "main() { /* 🙂ü */ speed = 1; }\nlong speed;\n";
  const at = (length) => ({ line: 0, character: length });
  const column = (options, character) =>
    session(async ({ connection, open, uri, result }) => {
      assert.strictEqual(result.capabilities.positionEncoding, options ? "utf-8" : "utf-16");
      await open("MAIN.IPC", text);
      const [place] = await connection.sendRequest(lsp.DefinitionRequest.type, {
        textDocument: { uri: uri("MAIN.IPC") },
        position: at(character),
      });
      assert.strictEqual(place.range.start.line, 1);
    }, options ? { capabilities: { general: { positionEncodings: ["utf-8", "utf-16"] } } } : {});
  await column(false, text.indexOf("speed"));
  await column(true, Buffer.byteLength(text.slice(0, text.indexOf("speed"))));
});

test("a cancelled request is answered as such or not cancelled any more; later ones are answered", () =>
  session(async ({ connection, open, place }) => {
    await open("MAIN.IPC");
    const source = new rpc.CancellationTokenSource();
    const first = connection.sendRequest(lsp.WorkspaceSymbolRequest.type, { query: "" });
    // It may be refused before `first` is answered, so who looks at that stands there from the start.
    const second = connection
      .sendRequest(lsp.HoverRequest.type, place("MAIN.IPC", "_Wait"), source.token)
      .catch((error) => assert.strictEqual(error.code, lsp.LSPErrorCodes.RequestCancelled));
    source.cancel();
    await first;
    await second;
    assert.ok(await connection.sendRequest(lsp.HoverRequest.type, place("MAIN.IPC", "_Wait")));
  }));

test("unknown requests and broken parameters are refused, the server goes on", () =>
  session(async ({ connection, open, place, uri }) => {
    await open("MAIN.IPC");
    await assert.rejects(connection.sendRequest("textDocument/nonsense", {}), { code: -32601 });
    await assert.rejects(connection.sendRequest("textDocument/hover", { textDocument: 7 }), { code: -32602 });
    await assert.rejects(connection.sendRequest("textDocument/hover", { textDocument: { uri: uri("MAIN.IPC") } }), { code: -32602 });
    assert.ok(await connection.sendRequest(lsp.HoverRequest.type, place("MAIN.IPC", "_Wait")));
  }));
