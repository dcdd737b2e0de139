// What a person has set on the page and finds again: the server keeps it with the plant, so it outlives a reload, another
// port and another browser.
import { effect, signal, type Signal } from "@preact/signals";

import { request } from "../server/connection";
import { hello } from "../server/live";

const kept: { name: string; take: (value: unknown) => void; tell: () => void }[] = [];
const followers: (() => void)[] = [];
let known: Record<string, unknown> | undefined;

// A signal that is kept under this name. What comes from the server takes the place of `first`.
export function setting<Value>(name: string, first: Value): Signal<Value> {
  const value = signal(first);
  let told = JSON.stringify(first);
  const tell = () => {
    const text = JSON.stringify(value.value);
    if (text === told || !known) return;
    told = text;
    void request({ do: "settings.set", name, value: value.value }).catch(() => undefined);
  };
  kept.push({
    name,
    take: (from_server) => {
      told = JSON.stringify(from_server);
      value.value = from_server as Value;
    },
    tell,
  });
  effect(tell);
  return value;
}

// Called whenever the settings of a server have come.
export function whenSettingsCome(act: () => void): void {
  followers.push(act);
}

// Again with each server that comes.
export function followSettings(): void {
  hello.subscribe((server) => {
    if (!server) return;
    request({ do: "settings" })
      .then((reply) => {
        known = reply.settings as Record<string, unknown>;
        for (const { name, take, tell } of kept) {
          if (name in known) take(known[name]);
          else tell(); // what was set before the server came
        }
        for (const act of followers) act();
      })
      .catch(() => undefined);
  });
}
