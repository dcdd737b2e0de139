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
  task: "build" | "fmt";
  file?: string;
  args?: string[];
}

export function taskCommand(definition: TaskDefinition, settings: Settings, openFile: string): Command {
  const file = definition.file ?? openFile;
  const own = definition.task === "build" ? compileArguments(settings) : [];
  return { command: settings.path, args: [definition.task, file, ...own, ...(definition.args ?? [])] };
}

export interface LaunchConfiguration {
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
  const given = [configuration.program, configuration.plant].filter((path) => path !== undefined && path !== "");
  return given.length === 1 ? "" : "ipos: a launch configuration names either a program or a plant";
}
