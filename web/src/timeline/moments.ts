// Where on the timeline the plant stands, and how one goes to another moment. A slider that is dragged orders more than the
// server can do: of what waits only the newest order counts, and one that takes long is replaced.
import { computed, signal } from "@preact/signals";

import { request, subscribe } from "../server/connection";
import { hello, time } from "../server/live";
import type { Dropped, Mark } from "../server/protocol";
import { complain } from "../shell/notice";

const patience_ms = 150;

export const marks = signal<Mark[]>([]);
// What a person has lost by running on from an earlier moment, until he goes to another one.
export const dropped = signal<Dropped | null>(null);
// Ordered, and not there yet.
const wanted = signal<number | null>(null);

export const nowMs = computed(() => wanted.value ?? Math.floor(time.value.us / 1000));
export const furthestMs = computed(() => Math.max(nowMs.value, Math.floor((time.value.furthest_us ?? time.value.us) / 1000)));

// Why there is nothing to drag.
export const noPast = computed(() =>
  hello.value?.mode === "device"
    ? "A real drive has no past to go back to: its time is that of the world."
    : hello.value?.live
      ? "This plant has real ports: its time is that of the world outside, and does not go back."
      : "",
);

let ordered_at = 0;
let under_way = 0;
let next: number | null = null;
let timer: ReturnType<typeof setTimeout> | undefined;

function order(): void {
  clearTimeout(timer);
  if (next === null) return;
  const left = patience_ms - (performance.now() - ordered_at);
  if (under_way > 0 && left > 0) {
    timer = setTimeout(order, left);
    return;
  }
  const ms = next;
  next = null;
  ordered_at = performance.now();
  ++under_way;
  request({ do: "go", us: ms * 1000 })
    .catch(complain)
    .finally(() => {
      --under_way;
      if (next !== null) order();
      else if (under_way === 0) wanted.value = null;
    });
}

export function goTo(ms: number): void {
  if (noPast.peek()) return;
  dropped.value = null;
  next = wanted.value = Math.max(0, Math.min(furthestMs.peek(), Math.floor(ms)));
  order();
}

// As long as the timeline is there.
export function followTimeline(): () => void {
  let seen = "null";
  return subscribe("timeline", { rate: 10 }, (event) => {
    marks.value = (event.marks ?? []) as Mark[];
    const told = JSON.stringify(event.dropped ?? null);
    if (told !== seen) dropped.value = event.dropped as Dropped | null;
    seen = told;
  });
}
