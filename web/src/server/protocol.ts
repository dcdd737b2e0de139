// What the server sends, as docs/reference/serve.md describes it.
import type { Channel } from "../picture/channel";

export type { Channel };

export interface Hello {
  protocol: number;
  version: string;
  mode: "plant" | "device" | "gallery";
  title: string;
  writable: boolean;
  live?: boolean; // a plant with real ports: time is that of the world outside
}

// A real port of a line. Without `since_us` it has been so from the start.
export interface PortState {
  bus: string;
  name: string;
  there: boolean;
  text: string; // why not
  since_us: number | null;
}

// Manual operation of a real drive.
export interface Manual {
  moves: boolean;
  alarm: string; // the drive has not answered the stop: in red, on every tab
  left: string[]; // parameters that are not the drive's own values yet, and why
}

export interface Stopped {
  reason: string;
  text: string;
  station?: string;
  task?: number;
  file?: string;
  line?: number;
  cost?: { us: number; commands: number }; // since the plant stood before
}

export interface Time {
  us: number;
  running: boolean;
  speed: number;
  rate: number;
  generation: number;
  furthest_us?: number; // of a plant: the latest moment one can go to
  over: boolean;
  stopped: Stopped | null;
}

export interface Terminal {
  name: string;
  bit: number;
  function: string;
  used?: boolean; // false: no function, no wire, named nowhere
}

export interface Analog {
  name: string;
  units: string[];
  least: number;
  most: number;
}

export interface Station {
  name: string;
  unit: string;
  title: string;
  program: string;
  drive: boolean;
  ideal_motor?: boolean; // the plant describes none
  inputs: Terminal[];
  outputs: Terminal[];
  analog: Analog[];
  analog_outputs?: { name: string; function: string }[];
  lines: string[];
}

// What a kind of fault takes when it is planted.
export interface FaultRule {
  text: string;
  station: "must" | "may" | "none";
  rate: boolean;
  identifier: boolean;
}

export interface Line {
  name: string;
  kind: string;
  baud: number;
  stations: string[];
  faults: string[];
  fault_rules: Record<string, FaultRule>;
}

export interface Wire {
  from: string;
  to: string;
  invert: boolean;
}

export interface Cam {
  input: string;
  from: number | null;
  to: number | null;
  active_high: boolean;
}

// A light barrier over the belt of a station.
export interface Barrier {
  input: string;
  belt: string;
  at: number;
  active_high: boolean;
}

export interface Plant {
  stations: Station[];
  buses: Line[];
  controls: { name: string; bus: string }[];
  wires: Wire[];
  switches: Cam[];
  barriers?: Barrier[];
  story?: string; // at the head of the plant file
  planned?: Planned[];
}

// What the plant file plans.
export interface Planned {
  us: number;
  every_us: number; // 0: once
  times: number; // with every_us; 0: for ever
  text: string;
}

// What a station drives. `limits` and `reference` are in increments of H511, the others in the unit.
export interface MachinePicture {
  kind: "axis" | "hoist" | "conveyor" | "turntable" | "winder" | "fan" | "shaft";
  unit: string;
  per_turn: number;
  given: boolean; // by the plant file
  from: number | null;
  to: number | null;
  limits: [number, number] | null;
  reference: number | null;
  part_length?: number;
}

// In increments; without positioning only the shaft.
export interface MachineState {
  shaft: number; // turned ever
  target?: number;
  setpoint?: number;
  in_position?: boolean;
  referenced?: boolean;
  parts?: number[]; // fronts, in the unit
}

export interface StationState {
  in: number;
  forced: number;
  out: number;
  analog?: Record<string, string>;
  analog_outputs?: Record<string, string>;
  powered: boolean;
  mains?: boolean; // without them the unit runs on its 24 V supply; absent: it has none of its own
  state?: string;
  enabled?: boolean;
  ordered?: boolean; // somebody wants it to run
  why?: string;
  display?: string;
  status?: number;
  fault?: number;
  fault_text?: string;
  error?: boolean;
  speed?: number;
  setpoint?: number;
  position?: number;
  shaft?: number;
  machine?: MachineState;
  current?: number;
  torque?: number;
  dc_link?: number;
  pd_out?: string[];
  pd_in?: string[];
}

export interface PlantedFault {
  kind: string;
  station?: string | null;
  rate?: number;
  id?: number;
}

export interface LineState {
  load: number;
  frames: number;
  lost: number;
  faults: PlantedFault[];
}

export interface WatchName {
  name: string;
  group: string;
  unit: string;
  text: string;
  writable: boolean;
}

export interface WatchValue {
  value: number;
  text: string;
  hex: string;
  forced: boolean;
}

export interface Trigger {
  kind: "none" | "level" | "edge" | "fault" | "telegram" | "line";
  signal?: string;
  value?: number;
  below?: boolean;
  slope?: "rising" | "falling" | "either";
  station?: string;
  bus?: string;
  id?: number;
  file?: string;
  line?: number;
  stop?: boolean;
}

export interface ScopeState {
  recording: number;
  most?: number; // channels
  channels: Channel[];
  trigger: Trigger;
  pre: number;
  length_ms: number;
  state: "free" | "armed" | "triggered" | "done";
  single: boolean;
  trigger_us: number | null;
  trigger_text: string;
  computes?: string[]; // channels whose past is not there yet
  first_us: number;
  last_us: number;
  later_us?: number | null; // after the way back: the last moment of what was recorded of later times
}

export interface ParameterGroup {
  number: string;
  name: string;
}

export interface ParameterValue {
  value: number | null;
  text: string;
  changed: boolean;
}

export interface Parameter extends ParameterValue {
  number: string;
  index: number;
  name: string;
  group: string;
  unit: string;
  access: string;
  default: string | null;
  least: string | null;
  most: string | null;
  choices: string[];
  shows?: string | null; // the parameter whose value this one shows, too
}

export interface ParameterDifference {
  number: string;
  index: number;
  name: string;
  text: string | null; // null: it has none
  with: string | null;
}

// Of PROFIBUS only; null where the frame has none.
export interface FrameAddresses {
  source?: number | null;
  destination?: number | null;
  ssap?: number | null;
  dsap?: number | null;
}

export interface BusRow extends FrameAddresses {
  bus: string;
  id: number;
  extended: boolean;
  remote: boolean;
  count: number;
  rate: number;
  data: string;
  changed: number[];
  text: string;
}

export interface BusState {
  load: number;
  frames: number;
  errors: number;
  state: string;
}

export interface TraceFrame extends FrameAddresses {
  n: number;
  us: number;
  took_us?: number; // on the line, up to `us`
  bus: string;
  id: number;
  extended: boolean;
  remote: boolean;
  error: boolean;
  sender: string; // empty: several at once, or nobody knows
  ours: boolean; // of the plant; else from outside, over a port
  dlc: number;
  data: string;
  text: string;
}

// A value in a telegram, with the signal that follows it.
export interface TelegramField {
  signal: string;
  meaning: string;
  value: number;
  bits: number; // of a bit field; 0: a number
}

export interface TelegramDetail {
  telegram: TraceFrame;
  from_us: number;
  fields: TelegramField[];
  channels: boolean; // fields are channels of the scope
  answer: TraceFrame | null;
  question: TraceFrame | null;
}

export interface SourceFile {
  name: string;
  text: string | null; // as it was compiled; null: nobody knows it
  lines: number[];
}

export interface TaskState {
  task: number;
  state: string;
  file?: string;
  line?: number;
  function?: string;
}

export interface Breakpoint {
  number: number;
  station: string;
  file: string;
  line: number;
  condition?: string;
  hits: number;
}

// What happened at a moment that one can go to.
export interface Mark {
  us: number;
  kind: "fault" | "check" | "journal" | "trigger" | "breakpoint" | "click";
  what: string;
  station: string;
  text: string; // a whole sentence, where there is one
}

// What does not come any more, as the plant went on from an earlier moment.
export interface Dropped {
  us: number;
  clicks: number;
}

export interface JournalEntry {
  n: number;
  us: number;
  station: string;
  weight: "why" | "warning" | "fault";
  text: string;
}
