// What the whole page knows of the server: who it is, how its time passes, what the plant has.
import { signal } from "@preact/signals";

import { listen, request } from "./connection";
import type { Hello, Manual, Plant, PortState, Station, Time } from "./protocol";

export const hello = signal<Hello | null>(null);
export const time = signal<Time>({
  us: 0,
  running: false,
  speed: 1,
  rate: 0,
  generation: 0,
  over: false,
  stopped: null,
});
// Of `time` the one part that many follow, so that they need not look 20 times a second.
export const generation = signal(0);
export const plant = signal<Plant | null>(null);
export const ports = signal<PortState[]>([]);
const standing: Manual = { moves: false, alarm: "", left: [] };
export const manual = signal<Manual>(standing);

export function secondsText(us: number): string {
  return `${(us / 1e6).toFixed(3)} s`;
}

// A gateway has no drive, parameters or program.
export function isGateway(station: Station): boolean {
  return station.unit === "gateway";
}

export function stationNames(): string[] {
  return plant.value?.stations.filter((station) => !isGateway(station)).map((station) => station.name) ?? [];
}

function askForPlant(): void {
  request({ do: "plant" })
    .then((reply) => (plant.value = reply.plant as Plant))
    .catch(() => (plant.value = { stations: [], buses: [], controls: [], wires: [], switches: [] }));
}

export function listenToServer(): void {
  listen("hello", (event) => {
    hello.value = event as unknown as Hello;
    ports.value = [];
    manual.value = standing;
    document.title = `${hello.value.title} · ipos`;
    askForPlant();
  });
  // A plant that was built anew may have other stations.
  listen("rebuilt", askForPlant);
  listen("ports", (event) => {
    ports.value = event.ports as PortState[];
  });
  listen("manual", (event) => {
    manual.value = event as unknown as Manual;
  });
  listen("time", (event) => {
    time.value = event as unknown as Time;
    generation.value = time.value.generation;
  });
}
