// The parameters of one station: list, groups, live values, differences to another one.
import { signal, type Signal } from "@preact/signals";

import { request, requestParts, subscribe } from "../server/connection";
import { hello, isGateway, plant } from "../server/live";
import type { Parameter, ParameterDifference, ParameterGroup, ParameterValue } from "../server/protocol";
import { shared } from "../server/shared";
import { complain } from "../shell/notice";

export const station = signal("");
export const groups = signal<ParameterGroup[]>([]);
export const parameters = signal<Parameter[]>([]);
// A station, or a file that a person has chosen; of a plant file its station of this name counts.
export interface Other {
  name: string;
  text?: string;
}
export const comparedWith = signal<Other | null>(null);
export const differences = signal<Map<number, ParameterDifference>>(new Map());

let other_file = ""; // what the other one has where they differ, as a file of ipos param

const values = new Map<number, Signal<ParameterValue>>();

export function valueOf(parameter: Parameter): Signal<ParameterValue> {
  let value = values.get(parameter.index);
  if (!value) values.set(parameter.index, (value = signal<ParameterValue>(parameter)));
  return value;
}

async function read(name: string): Promise<void> {
  const parts = await requestParts({ do: "parameters", station: name });
  if (name !== station.peek()) return;
  values.clear();
  groups.value = parts.flatMap((part) => (part.groups ?? []) as ParameterGroup[]);
  const rows = parts.flatMap((part) => (part.parameters ?? []) as Parameter[]);
  // By P number; what has none, the system's indices, comes behind.
  const keyOf = (row: Parameter) => (row.number ? `0${row.number}` : `1${String(row.index).padStart(6, "0")}`);
  parameters.value = rows.sort((a, b) => (keyOf(a) < keyOf(b) ? -1 : 1));
}

export async function compare(): Promise<void> {
  const other = comparedWith.peek();
  if (!other) {
    differences.value = new Map();
    return;
  }
  const station_now = station.peek();
  const parts = await requestParts({
    do: "parameters.compare",
    station: station_now,
    ...(other.text === undefined ? { with: other.name } : { text: other.text }),
  });
  if (other !== comparedWith.peek() || station_now !== station.peek()) return;
  const rows = parts.flatMap((part) => (part.rows ?? []) as ParameterDifference[]);
  other_file = parts.map((part) => (part.file as string | undefined) ?? "").join("");
  differences.value = new Map(rows.map((row) => [row.index, row]));
}

// What the other one has, all at once; a refusal is told and the rest is set.
export async function copyAll(): Promise<string> {
  const outcome = await load(other_file);
  await compare();
  return outcome;
}

function follow(name: string): () => void {
  void read(name).catch(complain);
  void compare().catch(complain);
  return subscribe("parameters", { station: name, rate: 5 }, (event) => {
    if (event.station !== name) return;
    for (const [index, value] of Object.entries(event.values as Record<string, ParameterValue>)) {
      const known = values.get(Number(index));
      if (known) known.value = value;
      else values.set(Number(index), signal(value));
    }
  });
}

// As long as a view is open.
export const followParameters = shared(() => {
  let stop: (() => void) | undefined;
  let followed = "";
  const stopPlant = plant.subscribe((description) => {
    const names = description?.stations.filter((one) => !isGateway(one)).map((one) => one.name) ?? [];
    if (!names.includes(station.peek()) && names[0]) station.value = names[0];
  });
  const change = (name: string) => {
    if (name === followed) return;
    followed = name;
    stop?.();
    stop = name ? follow(name) : undefined;
  };
  const stopStation = station.subscribe(change);
  const stopHello = hello.subscribe(() => {
    followed = "";
    change(station.peek());
  });
  const stopCompared = comparedWith.subscribe(() => void compare().catch(complain));
  return () => {
    stopPlant();
    stopStation();
    stopHello();
    stopCompared();
    stop?.();
  };
});

// For `ipos param`, or the lines of a plant file.
export async function save(form: "parameters.save" | "parameters.toml"): Promise<{ file: string; text: string }> {
  const parts = await requestParts({ do: form, station: station.peek() });
  const file = parts.map((part) => part.file).find((name) => typeof name === "string");
  return { file: (file as string | undefined) ?? `${station.peek()}.param`, text: parts.map((part) => (part.text as string | undefined) ?? "").join("") };
}

export async function load(text: string): Promise<string> {
  const reply = await request({ do: "parameters.load", station: station.peek(), text });
  const refused = (reply.refused ?? []) as { number: string; text: string }[];
  await read(station.peek());
  return [`${String(reply.set)} parameters set, ${refused.length} refused.`, ...refused.map((one) => `${one.number}: ${one.text}`)].join(" ");
}
