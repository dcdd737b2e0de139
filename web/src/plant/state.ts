// The states of stations and lines as they come; a signal each, so that a change draws one card and not all.
import { signal, type Signal } from "@preact/signals";

import { subscribe } from "../server/connection";
import { plant } from "../server/live";
import type { LineState, StationState } from "../server/protocol";

const stations = new Map<string, Signal<StationState | null>>();
const lines = new Map<string, Signal<LineState | null>>();

function of<T>(map: Map<string, Signal<T | null>>, name: string): Signal<T | null> {
  let found = map.get(name);
  if (!found) map.set(name, (found = signal<T | null>(null)));
  return found;
}

export const stationState = (name: string) => of(stations, name);
export const lineState = (name: string) => of(lines, name);

// Twenty times a second; a large plant less often, so that the browser has time for other things.
export function followPlant(): () => void {
  const count = plant.value?.stations.length ?? 1;
  return subscribe("plant", { rate: Math.max(4, Math.min(20, Math.round(320 / count))) }, (event) => {
    for (const [name, state] of Object.entries((event.stations ?? {}) as Record<string, StationState>))
      stationState(name).value = state;
    for (const [name, state] of Object.entries((event.buses ?? {}) as Record<string, LineState>))
      lineState(name).value = state;
  });
}

export function bitSet(mask: number | undefined, bit: number): boolean {
  return mask !== undefined && Math.floor(mask / 2 ** bit) % 2 === 1;
}
