// What the extension starts, what its manifest promises, and that its problem matcher reads what ipos prints.
import assert from "node:assert";
import { type SpawnSyncReturns, spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import test from "node:test";

import * as launch from "../src/launch";

const root = join(__dirname, "..", "..");
const read = (name: string): string => readFileSync(join(root, name), "utf8");

interface Manifest {
  contributes: {
    problemMatchers: { name: string; severity?: string; pattern: { regexp: string } }[];
    debuggers: { type: string; configurationAttributes: { launch: { properties: Record<string, unknown> } } }[];
    taskDefinitions: { properties: { task: { enum: string[] } } }[];
  };
}
const manifest = JSON.parse(read("package.json")) as Manifest;

const settings: launch.Settings = {
  path: "/opt/ipos",
  includeDirs: ["inc"],
  defines: ["A=1"],
  unit: "mdxb",
  warnings: ["error"],
  atomic: true,
};

test("the server takes all settings but the path", () => {
  assert.deepStrictEqual(launch.serverCommand(settings), { command: "/opt/ipos", args: ["lsp"] });
  assert.deepStrictEqual(launch.serverOptions(settings), {
    includeDirs: ["inc"],
    defines: ["A=1"],
    unit: "mdxb",
    warnings: ["error"],
    atomic: true,
  });
});

test("tasks name the verb, the file and the settings of the compiler", () => {
  const open = { file: "a.IPC", folder: "/p" };
  assert.deepStrictEqual(launch.taskCommand({ task: "build" }, settings, open).args, [
    "build", "a.IPC", "-Iinc", "-DA=1", "-Werror", "--unit", "mdxb", "--atomic",
  ]);
  assert.deepStrictEqual(launch.taskCommand({ task: "fmt", file: "b.IPC", args: ["--check"] }, settings, open).args, [
    "fmt", "b.IPC", "--check",
  ]);
  assert.deepStrictEqual(manifest.contributes.taskDefinitions[0]?.properties.task.enum, ["build", "fmt", "mutate"]);
  assert.deepStrictEqual(launch.taskCommand({ task: "mutate" }, { ...settings, unit: "", warnings: [], atomic: false }, open).args, [
    "test", "--mutate", "/p", "-Iinc", "-DA=1",
  ]);
  assert.deepStrictEqual(launch.taskMatchers({ task: "build" }), ["$ipos"]);
  assert.deepStrictEqual(launch.taskMatchers({ task: "mutate" }), []);
});

test("the debugger is ipos dap, for a program or a plant", () => {
  const [debuggerType] = manifest.contributes.debuggers;
  assert.strictEqual(debuggerType?.type, "ipos");
  assert.ok("program" in debuggerType.configurationAttributes.launch.properties);
  assert.ok("plant" in debuggerType.configurationAttributes.launch.properties);
  assert.deepStrictEqual(launch.debugCommand({ program: "a.IPC" }, settings).args, ["dap"]);
  assert.strictEqual(launch.launchMistake({ program: "a.IPC" }), "");
  assert.strictEqual(launch.launchMistake({ plant: "p.toml" }), "");
  assert.notStrictEqual(launch.launchMistake({}), "");
  assert.notStrictEqual(launch.launchMistake({ program: "a.IPC", plant: "p.toml" }), "");
});

test("the problem matcher reads the messages of ipos build", (context) => {
  const program = process.env["IPOS_PROGRAM"];
  if (program === undefined) return context.skip("IPOS_PROGRAM names no ipos");
  const folder = mkdtempSync(join(tmpdir(), "ipos-vscode-"));
  try {
    const file = join(folder, "bad.IPC");
    writeFileSync(file, "long unused;\nmain() { speed = 1; H0 = 5 / 0; }\n");
    const { stderr, status } = spawnSync(program, ["build", file], { encoding: "utf8" });
    assert.strictEqual(status, 65);
    const pattern = new RegExp(manifest.contributes.problemMatchers[0]?.pattern.regexp ?? "");
    const found = stderr.split("\n").flatMap((line) => {
      const match = pattern.exec(line);
      return match === null ? [] : [[match[1], match[2], match[3], match[4], match[6]].join("|")];
    });
    assert.ok(found.includes(`${file}|2|10|error|E0201`), stderr);
    assert.ok(found.some((one) => one.includes("|warning|W0206")), stderr);
  } finally {
    rmSync(folder, { recursive: true });
  }
  return undefined;
});

test("the problem matcher of mutate reads what no test notices, and nothing else", (context) => {
  const program = process.env["IPOS_PROGRAM"];
  if (program === undefined) return context.skip("IPOS_PROGRAM names no ipos");
  const folder = mkdtempSync(join(tmpdir(), "ipos-vscode-"));
  try {
    const file = join(folder, "A.IPC");
    writeFileSync(file, "long a, b;\nmain()\n{\n    a = 5;\n    b = 6;\n}\n// expect a == 5\n");
    const { stdout, status } = spawnSync(program, ["test", "--mutate", folder], { encoding: "utf8" });
    assert.strictEqual(status, 1);
    const matcher = manifest.contributes.problemMatchers.find((one) => one.name === "ipos-mutate");
    assert.strictEqual(matcher?.severity, "warning");
    const pattern = new RegExp(matcher.pattern.regexp);
    const found = stdout.split("\n").flatMap((line) => {
      const match = pattern.exec(line);
      return match === null ? [] : [match.slice(1, 5).join("|")];
    });
    assert.deepStrictEqual(found, [`${file}|5|5|removed: b = 6;`, `${file}|5|9|6 became 7`]);
  } finally {
    rmSync(folder, { recursive: true });
  }
  return undefined;
});

test("grammar, snippets and configuration are JSON; snippets need no more than they name", () => {
  for (const name of ["syntaxes/ipos.tmLanguage.json", "language-configuration.json"]) JSON.parse(read(name));
  const snippets = JSON.parse(read("snippets/ipos.json")) as Record<string, { prefix: string; body: string[] }>;
  for (const [name, one] of Object.entries(snippets)) assert.ok(one.prefix !== "" && one.body.length > 0, name);
});

test("snippets compile", (context) => {
  const program = process.env["IPOS_PROGRAM"];
  if (program === undefined) return context.skip("IPOS_PROGRAM names no ipos");
  const snippets = JSON.parse(read("snippets/ipos.json")) as Record<string, { body: string[] }>;
  const plain = (body: string[]): string =>
    body.join("\n").replace(/\$\{\d+\|([^,|]*)[^}]*\}/g, "$1").replace(/\$\{\d+:([^}]*)\}/g, "$1").replace(/\$\d+/g, "");
  const declarations = "MOVLNK Ml; MLDATA Data; SCTRCYCL Tr; SCREC Rec; long lData, i, condition, value;\n";
  const folder = mkdtempSync(join(tmpdir(), "ipos-vscode-"));
  try {
    for (const [name, one] of Object.entries(snippets)) {
      const text = plain(one.body);
      const whole = text.includes("main()")
        ? text
        : text.includes("name()")
          ? `${text}\nmain() { name(); }\n`
          : `#include <const.h>\n${declarations}main() {\n${text}\n}\n`;
      const file = join(folder, "snippet.IPC");
      writeFileSync(file, whole);
      const result: SpawnSyncReturns<string> = spawnSync(program, ["build", file], { encoding: "utf8" });
      assert.strictEqual(result.status, 0, `${name}: ${result.stderr}`);
    }
  } finally {
    rmSync(folder, { recursive: true });
  }
  return undefined;
});

test("the menu of a variable asks for it in its list", () => {
  assert.deepStrictEqual(launch.whoArguments({ container: { variablesReference: 7 }, variable: { name: "lCount" } }), {
    variablesReference: 7,
    name: "lCount",
  });
  assert.strictEqual(launch.whoArguments(undefined), undefined);
  assert.strictEqual(launch.whoArguments({ container: {} }), undefined);
  const { commands, menus } = (JSON.parse(read("package.json")) as {
    contributes: { commands: { command: string }[]; menus: Record<string, { command: string }[]> };
  }).contributes;
  const named = commands.map((one) => one.command);
  for (const menu of Object.values(menus)) for (const one of menu) assert.ok(named.includes(one.command), one.command);
});

test("the lenses start what they say", () => {
  assert.deepStrictEqual(launch.runCommand("/p/line.toml", settings).args, ["run", "/p/line.toml", "--watch"]);
  assert.deepStrictEqual(launch.runCommand("/p/A.IPC", settings).args.slice(0, 4), ["run", "/p/A.IPC", "--watch", "-Iinc"]);
  assert.deepStrictEqual(launch.debugConfiguration("/p/line.toml"), { plant: "/p/line.toml" });
  assert.deepStrictEqual(launch.debugConfiguration("/p/A.IPC"), { program: "/p/A.IPC" });
});

test("the Test Explorer reads what ipos test lists and reports", () => {
  const ipos = process.env.IPOS_PROGRAM;
  assert.ok(ipos, "IPOS_PROGRAM names the ipos to test");
  const folder = mkdtempSync(join(tmpdir(), "ipos-tests-"));
  try {
    const station = '[[station]]\nname = "a"\nunit = "md60a"\n[[expect]]\nstate = "powered"\nequals = ';
    writeFileSync(join(folder, "good.test.toml"), station + "1\n");
    writeFileSync(join(folder, "bad.test.toml"), station + "7\n");
    const own = { path: ipos, includeDirs: [], defines: [], unit: "", warnings: [], atomic: false };
    const shell = ({ command, args }: launch.Command): string =>
      spawnSync(command, args, { cwd: folder, encoding: "utf8" }).stdout;
    const listed = launch.listedTests(shell(launch.listCommand(".", own)));
    assert.deepStrictEqual(
      listed.map((one) => [join(folder, one.file), one.line]).sort(),
      [
        [join(folder, "bad.test.toml"), 1],
        [join(folder, "good.test.toml"), 1],
      ],
    );
    const [good] = launch.testResults(shell(launch.testCommand("good.test.toml", own)));
    assert.strictEqual(good?.outcome, "passed");
    assert.ok(listed.some((one) => one.name === good?.name), "the names are those of the list");
    const [bad] = launch.testResults(shell(launch.testCommand("bad.test.toml", own)));
    assert.strictEqual(bad?.outcome, "failed");
    const [finding] = bad.findings;
    assert.ok(finding);
    assert.match(launch.findingText(finding), /expected 7/);
    assert.strictEqual(finding.line, 4);
    assert.deepStrictEqual(launch.testResults("no report"), []);
  } finally {
    rmSync(folder, { recursive: true });
  }
});
