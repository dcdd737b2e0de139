// What stands along the way of a machine: limit switches and cams with their level, software limits, the reference point,
// the target and where the profile is.
import { bitSet } from "../plant/state";
import type { MachinePicture, Plant, Station, StationState } from "../server/protocol";
import { inUnit, shaft_turn, unitText, wrapped } from "./units";

export interface Mark {
  kind: "switch" | "limit" | "reference" | "target" | "setpoint" | "barrier";
  text: string;
  from: number; // in the unit; both the same: a point
  to: number;
  on: boolean; // a switch that is reached, a barrier with a part in it
}

function levelOf(plant: Plant, input: string, states: (station: string) => StationState | null): { on: boolean; text: string } {
  const dot = input.lastIndexOf(".");
  const station = plant.stations.find((one) => one.name === input.slice(0, dot));
  const terminal = station?.inputs.find((one) => one.name === input.slice(dot + 1));
  const state = states(input.slice(0, dot));
  return {
    on: bitSet(state?.in, terminal?.bit ?? 32),
    text: terminal?.function && !/^NO FUNCTION$/i.test(terminal.function) ? `${terminal.name} ${terminal.function}` : input.slice(dot + 1),
  };
}

// Counts of switches go on from power-on, those of the unit begin anew with a reference travel: `shift` is between them.
export function shiftOf(state: StationState): number {
  return wrapped((state.position ?? 0) - (state.machine?.shaft ?? state.position ?? 0));
}

export function switchMarks(
  station: Station,
  machine: MachinePicture,
  plant: Plant,
  state: StationState,
  states: (station: string) => StationState | null,
): Mark[] {
  const shift = shiftOf(state);
  const marks: Mark[] = [];
  for (const cam of plant.switches) {
    if (cam.input.slice(0, cam.input.lastIndexOf(".")) !== station.name) continue;
    const { on, text } = levelOf(plant, cam.input, states);
    const ends = [cam.from, cam.to].map((end, n) => (end === null ? (n === 0 ? -Infinity : Infinity) : inUnit(machine, end + shift)));
    // A machine that goes backwards has its ends the other way round.
    const [a, b] = ends as [number, number];
    const back = machine.per_turn < 0;
    const open = (value: number) => (back && !Number.isFinite(value) ? -value : value);
    marks.push({ kind: "switch", text, from: Math.min(open(a), open(b)), to: Math.max(open(a), open(b)), on: on === cam.active_high });
  }
  for (const barrier of plant.barriers ?? []) {
    if (barrier.belt !== station.name) continue;
    const { on, text } = levelOf(plant, barrier.input, states);
    const own = barrier.input.slice(0, barrier.input.lastIndexOf(".")) === station.name;
    marks.push({
      kind: "barrier",
      text: own ? text : barrier.input,
      from: barrier.at,
      to: barrier.at,
      on: on === barrier.active_high,
    });
  }
  return marks;
}

// Without a target H492 follows the axis, a little late; that is none to go to.
export function isAway(state: StationState, place: number | undefined): place is number {
  const passes = (Math.abs(state.speed ?? 0) * shaft_turn) / 60_000; // increments a millisecond
  return place !== undefined && Math.abs(wrapped(place - (state.position ?? 0))) > 2 * passes + 1;
}

export function pointMarks(machine: MachinePicture, state: StationState): Mark[] {
  const point = (kind: Mark["kind"], text: string, increments: number): Mark => {
    const at = inUnit(machine, increments);
    return { kind, text, from: at, to: at, on: false };
  };
  const marks: Mark[] = [];
  const { target, setpoint, referenced } = state.machine ?? {};
  if (machine.limits) {
    marks.push(point("limit", "software limit CCW", machine.limits[0]), point("limit", "software limit CW", machine.limits[1]));
  }
  if (machine.reference !== null && referenced) marks.push(point("reference", "reference point", machine.reference));
  if (isAway(state, target)) marks.push(point("target", `target ${unitText(machine, inUnit(machine, target))}`, target));
  if (isAway(state, setpoint)) marks.push(point("setpoint", "setpoint", setpoint));
  return marks;
}
