// Positions in the unit of a machine: from increments, as text, and the part of the travel that is drawn.
import type { MachinePicture } from "../server/protocol";

export const shaft_turn = 4096; // increments

export function inUnit(machine: MachinePicture, increments: number): number {
  return (increments * machine.per_turn) / shaft_turn;
}

// As many digits as an increment is worth, three at most.
export function unitText(machine: MachinePicture, value: number): string {
  const step = Math.abs(machine.per_turn) / shaft_turn;
  const digits = Math.max(0, Math.min(3, Math.ceil(-Math.log10(step) - 1e-9)));
  const text = value.toFixed(digits);
  return `${Number(text) === 0 ? text.replace("-", "") : text} ${machine.unit}`;
}

// Between counts that wrap at 32 bits.
export function wrapped(difference: number): number {
  return difference | 0;
}

export interface Window {
  from: number;
  to: number;
}

// A little more than all of these, in round numbers, so that it does not grow with each millisecond.
export function windowOf(places: number[]): Window {
  const least = Math.min(...places);
  const most = Math.max(...places);
  const step = 10 ** Math.floor(Math.log10(Math.max(most - least, 1e-3))) / 4;
  return { from: (Math.floor(least / step) - 1) * step, to: (Math.ceil(most / step) + 1) * step };
}

// Round numbers for a scale of about `count` steps.
export function scaleOf(window: Window, count: number): number[] {
  const raw = (window.to - window.from) / Math.max(count, 1);
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = ([1, 2, 5, 10].find((one) => one * power >= raw) ?? 10) * power;
  const steps = [];
  for (let n = Math.ceil(window.from / step); n * step <= window.to; ++n) steps.push(Number((n * step).toPrecision(12)));
  return steps;
}
