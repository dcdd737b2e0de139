// ipos-wasm: plants of IPOSplus-style drives in node and browsers.

/** Texts and bytes of files by their names; a plant file names its programs relative to itself. */
export type Files = Record<string, string | Uint8Array>;

export interface Message {
  /** "E0203" */
  code: string;
  line: number;
  column: number;
  text: string;
}
export interface Mistake {
  file: string;
  line: number;
  column: number;
  text: string;
}

/** What every refused call throws; `mistakes` are those of the files of a plant. */
export class IposError extends Error {
  readonly mistakes: Mistake[];
}

/** Compiles the WebAssembly and makes an instance. `wasm` is ipos.wasm as bytes, as a module or its address; default: beside index.js. */
export function load(options?: { wasm?: string | URL | BufferSource | WebAssembly.Module }): Promise<Ipos>;

export interface Ipos {
  readonly version: string;
  /** Compiles a program (*.IPC). `image` is null when a message is an error. */
  compile(files: Files, main: string, options?: { unit?: string }): { image: Uint8Array | null; messages: Message[] };
  /**
   * Opens a plant file (*.toml) or a program, which makes a plant of one station. It stands at time 0.
   * `speed`: commands a millisecond of every task; 0: as the unit's parameters say.
   */
  open(files: Files, main: string, options?: { speed?: number; seed?: number }): Plant;
}

export type Kind = "any" | "variable" | "parameter" | "input" | "output" | "analog" | "state" | "word" | "signal";

export interface Frame {
  /** ms, of the end of the last bit */
  time: number;
  id: number;
  length: number;
  data: Uint8Array;
  extended: boolean;
  remote: boolean;
  error: boolean;
  own: boolean;
}

/** A plant. Signals are "station.name", "name" alone where there is one station: "hoist.speed", "H430", "P130", "DI00". */
export interface Plant {
  readonly stations: { name: string; unit: string; title: string; program: string }[];
  readonly buses: { name: string; kind: "can" | "serial" | "profibus"; baud: number }[];
  /** ms since power-on; it passes in run() and step() only */
  readonly time: number;
  readonly journal: { time: number; weight: "why" | "warning" | "fault"; station: string; text: string }[];

  run(ms: number): void;
  /** One millisecond. */
  step(): void;

  /** The names that a station has of a kind. */
  names(station: string, kind: Kind): string[];
  signal(name: string): { name: string; unit: string; factor: number; decimals: number; kind: Kind; writable: boolean };
  /** The plain number; people read it times signal().factor. */
  read(name: string): number;
  /** "1500.0 rpm" */
  text(name: string): string;
  /** A number, or a text with unit for parameters and analog inputs: "2.5 s". */
  write(name: string, value: number | boolean | string): void;
  /** Holds a value against program, wires and telegrams, until release(). */
  force(name: string, value: number | boolean): void;
  release(name: string): void;

  /** Why the drive does not run; "enabled" when it does. */
  why(station: string): string;
  power(station: string, on: boolean): void;
  /** Raises a drive fault, 1..255; 0 resets what is pending. */
  fault(station: string, number: number): void;

  /** What a CAN line has carried since the last call; without a name the first bus. */
  frames(bus?: string): Frame[];
  send(frame: { id: number; data?: ArrayLike<number>; extended?: boolean; remote?: boolean }, bus?: string): void;

  /** One number over everything that has happened, as `ipos run --trace-hash` prints it. */
  hash(): string;
  close(): void;
}
