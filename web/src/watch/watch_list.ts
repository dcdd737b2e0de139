// Which names the watch shows: those found, and before them those a person has pinned; and their values.
import { computed, signal, type Signal } from "@preact/signals";

import { request, subscribe } from "../server/connection";
import { hello } from "../server/live";
import type { WatchName, WatchValue } from "../server/protocol";
import { complain } from "../shell/notice";
import type { Range } from "../shell/rows";
import { setting } from "../shell/settings";

const most_names = 1000;
const scroll_rest_ms = 60;

export const searchText = signal("");
export const chosenStation = signal("");
export const chosenGroup = signal<string | null>(null);
export const groups = signal<string[]>([]);
export const found = signal<WatchName[]>([]);
export const total = signal(0);
export const pinned = setting<WatchName[]>("watch.pinned", []);
export const shown = computed(() => {
  const names = new Set(pinned.value.map((one) => one.name));
  return [...pinned.value, ...found.value.filter((one) => !names.has(one.name))].slice(0, most_names);
});

// Only what is in sight is watched: of a plant with many drives there are a thousand.
export const inSight = signal<Range>({ first: 0, end: 0 });

const values = new Map<string, Signal<WatchValue | null>>();

export function valueOf(name: string): Signal<WatchValue | null> {
  let value = values.get(name);
  if (!value) values.set(name, (value = signal<WatchValue | null>(null)));
  return value;
}

export function pin(one: WatchName): void {
  const without = pinned.peek().filter((other) => other.name !== one.name);
  pinned.value = without.length === pinned.peek().length ? [...without, one] : without;
}

// Of a real drive nothing is searched: names are given, those below to begin with (speed, current, DC link).
const first_of_a_drive = "P000 P004 P008";

async function nameValues(): Promise<void> {
  const names = (searchText.value || first_of_a_drive).split(/[\s,]+/).filter(Boolean);
  try {
    found.value = (await request({ do: "watch", names })).names as WatchName[];
  } catch {
    found.value = []; // a name that is not complete yet
  }
  total.value = found.value.length;
  groups.value = [];
}

async function search(): Promise<void> {
  if (hello.peek()?.mode === "device") return nameValues();
  const text = searchText.value;
  const station = chosenStation.value;
  // Without a search the variables of the programs stand there, as in a watch window that was just opened.
  const group = chosenGroup.value ?? (text ? "" : "variables");
  const reply = await request({
    do: "search",
    text,
    limit: most_names,
    ...(station ? { station } : {}),
    ...(group ? { group } : {}),
  });
  if (text !== searchText.peek() || station !== chosenStation.peek()) return;
  found.value = reply.names as WatchName[];
  total.value = (reply.total as number | undefined) ?? found.value.length;
  if (Array.isArray(reply.groups)) groups.value = reply.groups as string[];
}

let asked = "";

async function watchShown(names: string[]): Promise<void> {
  const list = names.join("\n");
  if (list === asked) return;
  asked = list;
  await request({ do: "watch", names });
}

// As long as the tab is open: searches when what is looked for changes, watches what is shown.
export function followWatch(): () => void {
  let wait: ReturnType<typeof setTimeout> | undefined;
  const stopSearch = hello.subscribe((known) => {
    // A server that came back knows no list.
    asked = "";
    if (known) void search().catch(complain);
  });
  const stops = [searchText, chosenStation, chosenGroup].map((what) => {
    let first = true;
    return what.subscribe(() => {
      if (first) {
        first = false;
        return;
      }
      clearTimeout(wait);
      wait = setTimeout(() => void search().catch(complain), 120);
    });
  });
  const watched = computed(() => shown.value.slice(inSight.value.first, inSight.value.end).map((one) => one.name));
  let rest: ReturnType<typeof setTimeout> | undefined;
  const stopShown = watched.subscribe((list) => {
    clearTimeout(rest);
    if (list.length > 0) rest = setTimeout(() => void watchShown(list).catch(complain), scroll_rest_ms);
  });
  const stopTopic = subscribe("watch", { rate: 10 }, (event) => {
    for (const [name, value] of Object.entries(event.values as Record<string, WatchValue | null>))
      valueOf(name).value = value;
  });
  return () => {
    clearTimeout(wait);
    clearTimeout(rest);
    stopSearch();
    for (const stop of stops) stop();
    stopShown();
    stopTopic();
    asked = "";
  };
}
