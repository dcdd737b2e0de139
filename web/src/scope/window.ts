// Which part of the recording the scope shows, and where its two cursors stand.
import { computed, signal } from "@preact/signals";

import * as picture from "../picture/control";
import { time } from "../server/live";
import type { ScopeState } from "../server/protocol";

export type { CursorName, Cursors, Window } from "../picture/control";
type Window = picture.Window;
type CursorName = picture.CursorName;

export const scope = signal<ScopeState | null>(null);
// Of it the parts that others follow, so that an event without news asks for nothing.
export const recording = computed(() => scope.value?.recording);
export const triggerTime = computed(() => scope.value?.trigger_us ?? null);
// Up to where there are curves: now, or after the way back what was recorded of later times.
export const lastRecorded = computed(() => Math.max(time.value.us, scope.value?.later_us ?? 0));
// What a person has zoomed to; null: the newest part, or that around the trigger.
export const zoomed = signal<Window | null>(null);
export const cursors = signal<picture.Cursors>({ A: null, B: null });
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
  // After the way back this moment stands in the middle, as far as what follows is known.
  const last_us = Math.max(Math.min(lastRecorded.value, time.value.us + length_us / 2), length_us);
  return { from_us: last_us - length_us, to_us: last_us };
});

export function zoomTo(from_us: number, to_us: number): void {
  const width = Math.min(greatest_window_us, Math.max(least_window_us, to_us - from_us));
  const from = Math.max(-width / 2, (from_us + to_us - width) / 2);
  zoomed.value = { from_us: from, to_us: from + width };
}

export function follow(): void {
  zoomed.value = null;
}

export function putCursor(name: CursorName, us: number | null): void {
  cursors.value = { ...cursors.peek(), [name]: us === null ? null : Math.max(0, Math.round(us / 1000) * 1000) };
  activeCursor.value = name;
}

// What the picture moves.
export const control: picture.Control = {
  window: () => shownWindow.peek(),
  cursors: () => cursors.peek(),
  active: () => activeCursor.peek(),
  zoomTo,
  all: follow,
  put: putCursor,
};

// Factor below 1 shows less.
export function zoomBy(factor: number): void {
  picture.zoomBy(control, factor);
}

export function moveBy(part: number): void {
  const { from_us, to_us } = shownWindow.peek();
  picture.moveBy(control, (to_us - from_us) * part);
}

export function moveCursor(by_ms: number): void {
  picture.moveCursor(control, by_ms);
}

// The button of a cursor: chooses it, puts it into the picture, takes it away.
export function toggleCursor(name: CursorName): void {
  const { from_us, to_us } = shownWindow.peek();
  const set = cursors.peek()[name] !== null;
  if (activeCursor.peek() === name || !set) putCursor(name, set ? null : from_us + (to_us - from_us) * (name === "A" ? 0.4 : 0.6));
  else activeCursor.value = name;
}

// From the journal: the moment in the middle, cursor A on it.
export function showMoment(us: number): void {
  const width = (scope.peek()?.length_ms ?? 5000) * 1000;
  zoomTo(us - width / 2, us + width / 2);
  putCursor("A", us);
}
