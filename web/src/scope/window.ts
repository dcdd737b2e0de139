// Which part of the recording the scope shows, and where its two cursors stand.
import { computed, signal } from "@preact/signals";

import { time } from "../server/live";
import type { ScopeState } from "../server/protocol";

export interface Window {
  from_us: number;
  to_us: number;
}

export const scope = signal<ScopeState | null>(null);
// Of it the parts that others follow, so that an event without news asks for nothing.
export const recording = computed(() => scope.value?.recording);
export const triggerTime = computed(() => scope.value?.trigger_us ?? null);
// What a person has zoomed to; null: the newest part, or that around the trigger.
export const zoomed = signal<Window | null>(null);
export type CursorName = "A" | "B";
export const cursors = signal<Record<CursorName, number | null>>({ A: null, B: null });
export const activeCursor = signal<CursorName>("A");

const least_window_us = 5_000;
const greatest_window_us = 1_000_000_000;

export const shownWindow = computed<Window>(() => {
  if (zoomed.value) return zoomed.value;
  const state = scope.value;
  const length_us = (state?.length_ms ?? 5000) * 1000;
  if (state && state.trigger_us !== null && state.state !== "free") {
    const from_us = state.trigger_us - (length_us * state.pre) / 100;
    return { from_us, to_us: from_us + length_us };
  }
  const last_us = Math.max(time.value.us, length_us);
  return { from_us: last_us - length_us, to_us: last_us };
});

export function zoomTo(from_us: number, to_us: number): void {
  const width = Math.min(greatest_window_us, Math.max(least_window_us, to_us - from_us));
  const from = Math.max(-width / 2, (from_us + to_us - width) / 2);
  zoomed.value = { from_us: from, to_us: from + width };
}

// Factor below 1 shows less; `at_us` stays where it is.
export function zoomBy(factor: number, at_us?: number): void {
  const { from_us, to_us } = shownWindow.peek();
  const at = at_us ?? (from_us + to_us) / 2;
  zoomTo(at - (at - from_us) * factor, at + (to_us - at) * factor);
}

export function moveBy(part: number): void {
  const { from_us, to_us } = shownWindow.peek();
  const by = (to_us - from_us) * part;
  zoomTo(from_us + by, to_us + by);
}

export function follow(): void {
  zoomed.value = null;
}

export function putCursor(name: CursorName, us: number | null): void {
  cursors.value = { ...cursors.peek(), [name]: us === null ? null : Math.max(0, Math.round(us / 1000) * 1000) };
  activeCursor.value = name;
}

export function moveCursor(by_ms: number): void {
  const at = cursors.peek()[activeCursor.peek()];
  if (at !== null) putCursor(activeCursor.peek(), at + by_ms * 1000);
}

// From the journal: the moment in the middle, cursor A on it.
export function showMoment(us: number): void {
  const width = (scope.peek()?.length_ms ?? 5000) * 1000;
  zoomTo(us - width / 2, us + width / 2);
  putCursor("A", us);
}
