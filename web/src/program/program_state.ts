// The program of one station: its files, where its tasks stand, what was executed, breakpoints.
import { signal } from "@preact/signals";

import { requestParts, subscribe } from "../server/connection";
import { generation, hello, plant, time } from "../server/live";
import type { Breakpoint, SourceFile, TaskState } from "../server/protocol";
import { complain } from "../shell/notice";

export const station = signal("");
export const files = signal<SourceFile[]>([]);
export const openFile = signal("");
export const tasks = signal<TaskState[]>([]);
export const covered = signal<ReadonlyMap<string, ReadonlySet<number>>>(new Map());
export const breakpoints = signal<Breakpoint[]>([]);
export const chosenTask = signal(1);

async function read(name: string): Promise<void> {
  const parts = await requestParts({ do: "program", station: name });
  if (name !== station.peek()) return;
  files.value = parts.flatMap((part) => (part.files ?? []) as SourceFile[]);
  if (!openFile.peek() || (!files.value.some((file) => file.name === openFile.peek()) && !openFile.peek().endsWith(".toml")))
    openFile.value = files.value[0]?.name ?? "";
}

// The plant stands at another moment: the next event has everything.
let elsewhere = false;

function addCovered(event: Record<string, number[]>): void {
  const next = new Map(elsewhere ? [] : covered.peek());
  elsewhere = false;
  for (const [file, lines] of Object.entries(event)) next.set(file, new Set([...(next.get(file) ?? []), ...lines]));
  covered.value = next;
}

let followed = "";
let version = ""; // of the program that was read

function follow(name: string): () => void {
  if (followed !== name) files.value = [];
  followed = name;
  tasks.value = [];
  covered.value = new Map();
  version = "";
  if (!name) return () => undefined;
  return subscribe("program", { station: name, rate: 10 }, (event) => {
    if (event.station !== name) return;
    if (event.version !== version) {
      version = event.version as string;
      elsewhere = true;
      void read(name).catch(complain);
    }
    if (event.tasks) tasks.value = event.tasks as TaskState[];
    if (event.covered) addCovered(event.covered as Record<string, number[]>);
    if (event.breakpoints) breakpoints.value = event.breakpoints as Breakpoint[];
  });
}

// As long as the tab is open.
export function followProgram(): () => void {
  let stop: (() => void) | undefined;
  const again = () => {
    stop?.();
    stop = follow(station.peek());
  };
  const stopPlant = plant.subscribe((description) => {
    const with_program = description?.stations.filter((one) => one.program) ?? [];
    if (!with_program.some((one) => one.name === station.peek())) station.value = with_program[0]?.name ?? "";
  });
  let seen = generation.peek();
  const stopGeneration = generation.subscribe((now) => {
    if (now !== seen) elsewhere = true;
    seen = now;
  });
  const stopStation = station.subscribe(again);
  // A server that came back may have compiled other sources.
  let server = hello.peek();
  const stopHello = hello.subscribe((now) => {
    if (now !== server) again();
    server = now;
  });
  // A stop at a place opens it.
  const stopTime = time.subscribe(({ running, stopped }) => {
    if (running || !stopped?.file || !stopped.station) return;
    if (station.peek() !== stopped.station && stopped.reason === "breakpoint") station.value = stopped.station;
    if (station.peek() === stopped.station) openFile.value = stopped.file;
    if (stopped.task) chosenTask.value = stopped.task;
  });
  return () => {
    stopPlant();
    stopGeneration();
    stopStation();
    stopHello();
    stopTime();
    stop?.();
  };
}
