// Which channels the scope has, for all who add one: the form, the tree, the trace.
import { computed } from "@preact/signals";

import type { Place } from "../picture/channel";
import { request } from "../server/connection";
import type { ScopeState } from "../server/protocol";
import { command, complain } from "../shell/notice";
import { setting } from "../shell/settings";
import { scope } from "./window";

export const channelNames = computed(() => scope.value?.channels.map((channel) => channel.name) ?? []);
export const mostChannels = computed(() => scope.value?.most ?? 8);
// By the name of the channel.
export const places = setting<Record<string, Place>>("scope.places", {});

export function placesOf(names: string[]): Place[] {
  return names.map((name) => places.value[name] ?? "");
}

export function setPlace(name: string, place: Place): void {
  const { [name]: _old, ...rest } = places.peek();
  places.value = place === "" ? rest : { ...rest, [name]: place };
}

export async function setChannels(names: string[]): Promise<void> {
  if (names.length > 0) await command({ do: "scope", channels: names });
}

async function add(name: string): Promise<void> {
  try {
    const state = (await request({ do: "scope" })) as unknown as ScopeState;
    const names = state.channels.map((channel) => channel.name);
    if (names.includes(name)) return;
    if (names.length >= (state.most ?? names.length + 1))
      return complain(`The scope has ${state.most} channels at most, so that its memory stays below 66 MB. Remove one first.`);
    await setChannels([...names, name]);
  } catch (reason) {
    complain(reason);
  }
}

// Also where the scope is not open. One after the other, so that none is lost.
let added = Promise.resolve();
export function addChannel(name: string): Promise<void> {
  if (name) added = added.then(() => add(name));
  return added;
}

export function removeChannel(name: string): void {
  void setChannels(channelNames.peek().filter((one) => one !== name));
}
