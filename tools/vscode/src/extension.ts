// The extension: language client, debugger, tasks, and the text of built-in headers.
import * as vscode from "vscode";
import { LanguageClient, TransportKind } from "vscode-languageclient/node";

import * as launch from "./launch";
import { testExplorer } from "./tests";

let client: LanguageClient | undefined;

function settings(): launch.Settings {
  const all = vscode.workspace.getConfiguration("ipos");
  return {
    path: all.get("path", "ipos"),
    includeDirs: all.get("includeDirs", []),
    defines: all.get("defines", []),
    unit: all.get("unit", ""),
    warnings: all.get("warnings", []),
    atomic: all.get("atomic", false),
  };
}

async function startServer(): Promise<void> {
  const { command, args } = launch.serverCommand(settings());
  client = new LanguageClient(
    "ipos",
    "ipos",
    { command, args, transport: TransportKind.stdio },
    {
      documentSelector: [
        { language: "ipos", scheme: "file" },
        { language: "ipos", scheme: "untitled" },
        // Plants and tests; the server leaves other files of this kind alone.
        { pattern: "**/*.toml", scheme: "file" },
      ],
      initializationOptions: launch.serverOptions(settings()),
      synchronize: { fileEvents: vscode.workspace.createFileSystemWatcher("**/*.{IPC,ipc,h,H,toml}") },
    },
  );
  try {
    await client.start();
  } catch (error) {
    client = undefined;
    const reason = error instanceof Error ? error.message : String(error);
    void vscode.window.showErrorMessage(`ipos: '${command} ${args.join(" ")}' did not start: ${reason}. See ipos.path.`);
  }
}

async function restartServer(): Promise<void> {
  await client?.stop();
  await startServer();
}

// const.h and its like live in the compiler.
const headers: vscode.TextDocumentContentProvider = {
  async provideTextDocumentContent(uri: vscode.Uri): Promise<string> {
    const answer = await client?.sendRequest<{ text: string }>("ipos/header", { uri: uri.toString() });
    return answer?.text ?? "";
  },
};

const debuggers: vscode.DebugAdapterDescriptorFactory = {
  createDebugAdapterDescriptor(session: vscode.DebugSession): vscode.DebugAdapterDescriptor {
    const { command, args } = launch.debugCommand(session.configuration as launch.LaunchConfiguration, settings());
    return new vscode.DebugAdapterExecutable(command, args);
  },
};

const configurations: vscode.DebugConfigurationProvider = {
  resolveDebugConfigurationWithSubstitutedVariables(
    _folder: vscode.WorkspaceFolder | undefined,
    configuration: vscode.DebugConfiguration,
  ): vscode.DebugConfiguration | undefined {
    const mistake = launch.launchMistake(configuration as launch.LaunchConfiguration);
    if (mistake === "") return configuration;
    void vscode.window.showErrorMessage(mistake);
    return undefined;
  },
  resolveDebugConfiguration(
    _folder: vscode.WorkspaceFolder | undefined,
    configuration: vscode.DebugConfiguration,
  ): vscode.DebugConfiguration {
    // F5 without launch.json.
    if (configuration.type) return configuration;
    return { type: "ipos", request: "launch", name: "Debug the open program", program: "${file}" };
  },
};

function makeTask(definition: launch.TaskDefinition & vscode.TaskDefinition): vscode.Task {
  const { command, args } = launch.taskCommand(definition, settings(), { file: "${file}", folder: "${fileDirname}" });
  const task = new vscode.Task(
    definition,
    vscode.TaskScope.Workspace,
    `${definition.task} ${definition.file ?? (definition.task === "mutate" ? "the open folder" : "the open file")}`,
    "ipos",
    new vscode.ProcessExecution(command, args),
    launch.taskMatchers(definition),
  );
  if (definition.task === "build") task.group = vscode.TaskGroup.Build;
  return task;
}

const tasks: vscode.TaskProvider = {
  provideTasks: () => (["build", "fmt", "mutate"] as const).map((task) => makeTask({ type: "ipos", task })),
  resolveTask: (task) => makeTask(task.definition as launch.TaskDefinition & vscode.TaskDefinition),
};

// The lenses of the server.
function runInTerminal(name: string, command: launch.Command): void {
  const terminal = vscode.window.createTerminal({ name, shellPath: command.command, shellArgs: command.args });
  terminal.show();
}

const lenses: Record<string, (uri: string, more?: unknown) => unknown> = {
  "ipos.run": (uri) => {
    const file = vscode.Uri.parse(uri).fsPath;
    runInTerminal("ipos run", launch.runCommand(file, settings()));
  },
  "ipos.debug": (uri) => {
    const file = vscode.Uri.parse(uri).fsPath;
    const configuration = { type: "ipos", request: "launch", name: "Debug", ...launch.debugConfiguration(file) };
    return vscode.debug.startDebugging(vscode.workspace.getWorkspaceFolder(vscode.Uri.parse(uri)), configuration);
  },
  "ipos.test": (uri, name) => {
    const { command, args } = launch.testCommand(
      vscode.Uri.parse(uri).fsPath,
      settings(),
      typeof name === "string" ? name : undefined,
    );
    const report = args.indexOf("--json");
    runInTerminal("ipos test", { command, args: args.filter((_, n) => n !== report && n !== report + 1) });
  },
  "ipos.open": async (uri, position) => {
    const { line, character } = position as { line: number; character: number };
    const at = new vscode.Position(line, character);
    await vscode.window.showTextDocument(vscode.Uri.parse(uri), { selection: new vscode.Range(at, at) });
  },
};

// In the menu of a variable; the answer stands in the debug console, too.
async function whoChangedIt(menu?: launch.VariableInMenu): Promise<void> {
  const asked = launch.whoArguments(menu);
  const session = vscode.debug.activeDebugSession;
  if (asked === undefined || session?.type !== "ipos") return;
  try {
    const { result } = (await session.customRequest("who", asked)) as { result: string };
    vscode.debug.activeDebugConsole.appendLine(result);
    void vscode.window.showInformationMessage(result);
  } catch (error) {
    void vscode.window.showErrorMessage(`ipos: ${error instanceof Error ? error.message : String(error)}`);
  }
}

export async function activate(context: vscode.ExtensionContext): Promise<void> {
  context.subscriptions.push(
    vscode.workspace.registerTextDocumentContentProvider("ipos", headers),
    vscode.debug.registerDebugAdapterDescriptorFactory("ipos", debuggers),
    vscode.debug.registerDebugConfigurationProvider("ipos", configurations),
    vscode.tasks.registerTaskProvider("ipos", tasks),
    vscode.commands.registerCommand("ipos.restart", restartServer),
    vscode.commands.registerCommand("ipos.who", whoChangedIt),
    ...Object.entries(lenses).map(([name, act]) => vscode.commands.registerCommand(name, act)),
    testExplorer(settings),
    vscode.workspace.onDidChangeConfiguration(async (change) => {
      if (change.affectsConfiguration("ipos.path")) await restartServer();
      else if (change.affectsConfiguration("ipos"))
        await client?.sendNotification("workspace/didChangeConfiguration", {
          settings: { ipos: launch.serverOptions(settings()) },
        });
    }),
  );
  await startServer();
}

export async function deactivate(): Promise<void> {
  await client?.stop();
}
