// The states of stations, machines and lines as they come; a signal each, so that a change draws one card and not all.
import { effect, signal, type Signal } from "@preact/signals";

import { subscribe } from "../server/connection";
import { plant, time } from "../server/live";
import type { LineState, MachinePicture, Station, StationState } from "../server/protocol";

const stations = new Map<string, Signal<StationState | null>>();
const machines = new Map<string, Signal<MachinePicture | null>>();
const lines = new Map<string, Signal<LineState | null>>();

function of<T>(map: Map<string, Signal<T | null>>, name: string): Signal<T | null> {
  let found = map.get(name);
  if (!found) map.set(name, (found = signal<T | null>(null)));
  return found;
}

export const stationState = (name: string) => of(stations, name);
export const machinePicture = (name: string) => of(machines, name);
export const lineState = (name: string) => of(lines, name);

function take<T>(map: Map<string, Signal<T | null>>, news: unknown): void {
  for (const [name, value] of Object.entries((news ?? {}) as Record<string, T>)) of(map, name).value = value;
}

let followers = 0;
let stop: (() => void) | undefined;

// Twenty times a second; a large plant less often, so that the browser has time for other things. Views that stand side by
// side share what comes.
export function followPlant(): () => void {
  if (followers++ === 0)
    stop = effect(() => {
      const count = plant.value?.stations.length ?? 1;
      return subscribe("plant", { rate: Math.max(4, Math.min(20, Math.round(320 / count))) }, (event) => {
        take(stations, event.stations);
        take(machines, event.machines);
        take(lines, event.buses);
      });
    });
  return () => {
    if (--followers === 0) stop?.();
  };
}

export function bitSet(mask: number | undefined, bit: number): boolean {
  return mask !== undefined && Math.floor(mask / 2 ** bit) % 2 === 1;
}

// Where a person wants to see the card of a station, and that it is a new wish.
export const wanted = signal<{ station: string } | null>(null);

// --- what is not well ---

const silent_after_us = 1_000_000;

export function isUnwell(state: StationState | null): boolean {
  if (!state?.powered) return false;
  return Boolean(state.fault) || (state.ordered === true && state.enabled === false);
}

// Without a telegram in the last second, or with a planted fault. Nobody could have spoken at the beginning.
export function lineTrouble(state: LineState | null): string {
  if (!state) return "";
  if (state.faults.length > 0) return state.faults.map((fault) => fault.kind + (fault.station ? ` at ${fault.station}` : "")).join(", ");
  return state.load === 0 && time.value.us >= silent_after_us ? "silent" : "";
}

export function isOnSilentLine(station: Station): boolean {
  return station.lines.some((line) => lineTrouble(lineState(line).value) === "silent");
}
