// The parameters of one station: list, groups, live values, differences to another one.
import { signal, type Signal } from "@preact/signals";

import { request, requestParts, subscribe } from "../server/connection";
import { hello, isGateway, plant } from "../server/live";
import type { Parameter, ParameterDifference, ParameterGroup, ParameterValue } from "../server/protocol";
import { complain } from "../shell/notice";

export const station = signal("");
export const groups = signal<ParameterGroup[]>([]);
export const parameters = signal<Parameter[]>([]);
export const comparedWith = signal("");
export const differences = signal<Map<number, ParameterDifference>>(new Map());

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
  parameters.value = parts.flatMap((part) => (part.parameters ?? []) as Parameter[]);
}

export async function compare(): Promise<void> {
  const other = comparedWith.peek();
  if (!other) {
    differences.value = new Map();
    return;
  }
  const parts = await requestParts({ do: "parameters.compare", station: station.peek(), with: other });
  const rows = parts.flatMap((part) => (part.rows ?? []) as ParameterDifference[]);
  differences.value = new Map(rows.map((row) => [row.index, row]));
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

// As long as the tab is open.
export function followParameters(): () => void {
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
}

export async function save(): Promise<{ file: string; text: string }> {
  const parts = await requestParts({ do: "parameters.save", station: station.peek() });
  const file = parts.map((part) => part.file).find((name) => typeof name === "string");
  return { file: (file as string | undefined) ?? `${station.peek()}.param`, text: parts.map((part) => (part.text as string | undefined) ?? "").join("") };
}

export async function load(text: string): Promise<string> {
  const reply = await request({ do: "parameters.load", station: station.peek(), text });
  const refused = (reply.refused ?? []) as { number: string; text: string }[];
  await read(station.peek());
  return [`${String(reply.set)} parameters set, ${refused.length} refused.`, ...refused.map((one) => `${one.number}: ${one.text}`)].join(" ");
}
