// How the extension starts ipos: pure functions of the settings, so that they are tested without an editor.

export interface Settings {
  path: string;
  includeDirs: string[];
  defines: string[];
  unit: string;
  warnings: string[];
  atomic: boolean;
}

export interface Command {
  command: string;
  args: string[];
}

export function serverCommand(settings: Settings): Command {
  return { command: settings.path, args: ["lsp"] };
}

// What `ipos lsp` takes as initializationOptions and in didChangeConfiguration.
export function serverOptions(settings: Settings): Omit<Settings, "path"> {
  const { includeDirs, defines, unit, warnings, atomic } = settings;
  return { includeDirs, defines, unit, warnings, atomic };
}

function compileArguments(settings: Settings): string[] {
  return [
    ...settings.includeDirs.map((directory) => `-I${directory}`),
    ...settings.defines.map((define) => `-D${define}`),
    ...settings.warnings.map((warning) => `-W${warning}`),
    ...(settings.unit === "" ? [] : ["--unit", settings.unit]),
    ...(settings.atomic ? ["--atomic"] : []),
  ];
}

export interface TaskDefinition {
  task: "build" | "fmt" | "mutate";
  file?: string;
  args?: string[];
}

// `mutate` is of the tests of a folder.
export function taskCommand(definition: TaskDefinition, settings: Settings, open: { file: string; folder: string }): Command {
  const mutate = definition.task === "mutate";
  const file = definition.file ?? (mutate ? open.folder : open.file);
  const verb = mutate ? ["test", "--mutate"] : [definition.task];
  const own = definition.task === "fmt" ? [] : compileArguments(settings);
  return { command: settings.path, args: [...verb, file, ...own, ...(definition.args ?? [])] };
}

// What no test notices is shown by the language server.
export function taskMatchers(definition: TaskDefinition): string[] {
  return definition.task === "mutate" ? [] : ["$ipos"];
}

// What the menu of a variable hands over, as far as it is used here.
export interface VariableInMenu {
  container?: { variablesReference?: number };
  variable?: { name?: string };
}

// What `ipos dap` takes in its request `who`; nothing where the menu has no variable.
export function whoArguments(menu: VariableInMenu | undefined): { variablesReference: number; name: string } | undefined {
  const name = menu?.variable?.name;
  return name === undefined ? undefined : { variablesReference: menu?.container?.variablesReference ?? 0, name };
}

export interface LaunchConfiguration {
  request?: string;
  program?: string;
  plant?: string;
  args?: string[];
}

// The adapter reads program, plant and the rest from the launch request.
export function debugCommand(configuration: LaunchConfiguration, settings: Settings): Command {
  return { command: settings.path, args: ["dap", ...(configuration.args ?? [])] };
}

// Why a launch configuration cannot be started; empty when it can.
export function launchMistake(configuration: LaunchConfiguration): string {
  if (configuration.request === "attach") return "";  // the run knows its file
  const given = [configuration.program, configuration.plant].filter((path) => path !== undefined && path !== "");
  return given.length === 1 ? "" : "ipos: a launch configuration names either a program or a plant";
}

// What the lens "Run" starts in a terminal.
export function runCommand(file: string, settings: Settings): Command {
  const own = file.endsWith(".toml") ? [] : compileArguments(settings);
  return { command: settings.path, args: ["run", file, "--watch", ...own] };
}

// What the lens "Debug" launches.
export function debugConfiguration(file: string): LaunchConfiguration {
  return file.endsWith(".toml") ? { plant: file } : { program: file };
}

// The tests of a file, or those whose names have the filter in them; the report comes on standard output.
export function testCommand(file: string, settings: Settings, filter?: string): Command {
  const chosen = filter === undefined || filter === "" ? [] : ["--filter", filter];
  return { command: settings.path, args: ["test", file, "--json", "-", ...chosen, ...compileArguments(settings)] };
}

// The names and places of the tests there are, a line each: "examples/hoist/hoist  examples/hoist/hoist.test.toml:1".
export function listCommand(folder: string, settings: Settings): Command {
  return { command: settings.path, args: ["test", folder, "--list", ...compileArguments(settings)] };
}

export interface ListedTest {
  name: string;
  file: string;
  line: number;
}

export function listedTests(output: string): ListedTest[] {
  const tests: ListedTest[] = [];
  for (const row of output.split("\n")) {
    const [, name, file, line] = /^(.+?) {2,}(.+):(\d+)$/.exec(row) ?? [];
    if (name !== undefined && file !== undefined) tests.push({ name, file, line: Number(line) });
  }
  return tests;
}

export interface Finding {
  file: string;
  line: number;
  column: number;
  message: string;
  values: string[];
}

export interface TestResult {
  name: string;
  file: string;
  line: number;
  outcome: string;
  seconds: number;
  messages: string;
  findings: Finding[];
}

// The results in the report of testCommand(); none where it is no report.
export function testResults(output: string): TestResult[] {
  try {
    const report = JSON.parse(output) as { results?: TestResult[] };
    return report.results ?? [];
  } catch {
    return [];
  }
}

// What the Test Explorer shows of a finding: the message, and below it what was seen.
export function findingText(finding: Finding): string {
  return [finding.message, ...finding.values].join("\n");
}
