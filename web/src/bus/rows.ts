// A row an identifier, and the load of the lines, as the server tells them.
import { effect, signal } from "@preact/signals";

import { subscribe } from "../server/connection";
import { generation, hello } from "../server/live";
import type { BusRow, BusState } from "../server/protocol";
import { shared } from "../server/shared";

export const rows = signal<Map<string, BusRow>>(new Map());
export const states = signal<Record<string, BusState>>({});

export function keyOf(telegram: { bus: string; id: number; extended: boolean; remote: boolean }): string {
  return `${telegram.bus} ${telegram.extended ? 1 : 0}${telegram.remote ? 1 : 0} ${String(telegram.id).padStart(10, "0")}`;
}

// When the server or time has gone back, the rows begin anew.
export const followRows = shared(() => {
  let stop: (() => void) | undefined;
  const end = effect(() => {
    void generation.value;
    void hello.value;
    stop?.();
    rows.value = new Map();
    stop = subscribe("bus", { rate: 10 }, (event) => {
      const changed = (event.rows ?? []) as BusRow[];
      if (changed.length > 0) {
        const next = new Map(rows.peek());
        for (const row of changed) next.set(keyOf(row), row);
        rows.value = next;
      }
      states.value = { ...states.peek(), ...((event.buses ?? {}) as Record<string, BusState>) };
    });
  });
  return () => {
    end();
    stop?.();
  };
});
