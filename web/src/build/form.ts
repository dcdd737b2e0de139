// What the server says of a new table of the plant (docs/reference/serve.md, `form`).
import type { Message } from "../server/connection";

export type Table = "station" | "bus" | "wire" | "control";

export interface Setting {
  number: string;
  name: string;
  value: string;
}

export interface Line {
  key: string;
  bus: string;
  parameters: Setting[];
  values: Record<string, number>;
}

export interface Form {
  name: string;
  keys: { key: string; words: string[] }[];
  units?: string[];
  runs_programs?: boolean;
  lines?: Line[];
  templates?: string[];
  programs?: string[];
  from?: string[];
  to?: string[];
}

// What a person has filled in.
export interface Filled {
  table: Table;
  values: Record<string, unknown>;
  written: Record<string, string>;
  parameters: Record<string, string>;
  program: string; // a new file, from the template
  template: string;
}

export function empty(table: Table): Filled {
  return { table, values: {}, written: {}, parameters: {}, program: "", template: "" };
}

export function insertion(filled: Filled): Message {
  const { table, values, written, parameters, program, template } = filled;
  return { table, values, written, parameters, ...(program ? { program, template } : {}) };
}
