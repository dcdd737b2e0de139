// The Test Explorer: the tests that `ipos test --list` names, and what `ipos test --json` says of them.
import { execFile } from "node:child_process";
import * as path from "node:path";

import * as vscode from "vscode";

import * as launch from "./launch";

// Standard output, whatever the exit code: failed tests give 1.
function outputOf(command: launch.Command, folder: string, cancelled?: vscode.CancellationToken): Promise<string> {
  return new Promise((resolve) => {
    const child = execFile(command.command, command.args, { cwd: folder, maxBuffer: 1 << 28 }, (_error, output) => {
      resolve(output);
    });
    cancelled?.onCancellationRequested(() => child.kill());
  });
}

interface Known {
  folder: string; // of the workspace
  file: string;
}

export function testExplorer(settings: () => launch.Settings): vscode.Disposable {
  const controller = vscode.tests.createTestController("ipos", "ipos");
  const known = new WeakMap<vscode.TestItem, Known>();

  async function discover(): Promise<void> {
    const items: vscode.TestItem[] = [];
    for (const { uri } of vscode.workspace.workspaceFolders ?? []) {
      const output = await outputOf(launch.listCommand(".", settings()), uri.fsPath);
      const files = new Map<string, vscode.TestItem>();
      for (const one of launch.listedTests(output)) {
        const file = path.resolve(uri.fsPath, one.file);
        let parent = files.get(file);
        if (parent === undefined) {
          parent = controller.createTestItem(file, path.relative(uri.fsPath, file), vscode.Uri.file(file));
          known.set(parent, { folder: uri.fsPath, file });
          files.set(file, parent);
          items.push(parent);
        }
        const item = controller.createTestItem(one.name, path.basename(one.name), vscode.Uri.file(file));
        item.range = new vscode.Range(one.line - 1, 0, one.line - 1, 0);
        known.set(item, { folder: uri.fsPath, file });
        parent.children.add(item);
      }
    }
    controller.items.replace(items);
  }

  function tell(run: vscode.TestRun, item: vscode.TestItem, result: launch.TestResult, folder: string): void {
    const milliseconds = result.seconds * 1000;
    if (result.outcome === "passed") {
      run.passed(item, milliseconds);
      return;
    }
    const messages = result.findings.map((finding) => {
      const message = new vscode.TestMessage(launch.findingText(finding));
      message.location = new vscode.Location(
        vscode.Uri.file(path.resolve(folder, finding.file)),
        new vscode.Position(Math.max(finding.line - 1, 0), Math.max(finding.column - 1, 0)),
      );
      return message;
    });
    if (messages.length === 0) messages.push(new vscode.TestMessage(result.messages));
    if (result.outcome === "failed") run.failed(item, messages, milliseconds);
    else run.errored(item, messages, milliseconds);
  }

  async function runTests(request: vscode.TestRunRequest, cancelled: vscode.CancellationToken): Promise<void> {
    const run = controller.createTestRun(request);
    const chosen: vscode.TestItem[] = [];
    if (request.include) chosen.push(...request.include);
    else controller.items.forEach((item) => chosen.push(item));
    for (const item of chosen) {
      const place = known.get(item);
      if (place === undefined || cancelled.isCancellationRequested) continue;
      const tests: vscode.TestItem[] = [];
      item.children.forEach((child) => tests.push(child));
      const whole = tests.length !== 0;
      if (!whole) tests.push(item);
      for (const one of tests) run.started(one);
      const file = path.relative(place.folder, place.file);
      const command = launch.testCommand(file, settings(), whole ? undefined : item.id);
      const results = launch.testResults(await outputOf(command, place.folder, cancelled));
      for (const one of tests) {
        const result = results.find((candidate) => candidate.name === one.id);
        if (result === undefined) run.skipped(one);
        else tell(run, one, result, place.folder);
      }
    }
    run.end();
  }

  controller.resolveHandler = async (item) => {
    if (item === undefined) await discover();
  };
  controller.refreshHandler = discover;
  controller.createRunProfile("Run", vscode.TestRunProfileKind.Run, runTests, true);
  const watcher = vscode.workspace.createFileSystemWatcher("**/*.{toml,IPC,ipc}");
  watcher.onDidCreate(discover);
  watcher.onDidDelete(discover);
  void discover();
  return vscode.Disposable.from(controller, watcher);
}
