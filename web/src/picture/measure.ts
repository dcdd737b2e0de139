// What is measured between two cursors, of every millisecond from the one to the other, both included.
//   overshoot  how far it went beyond its last value, in % of the way from the first to the last value
//   settling   ms from the first sample until it stays within 2 % of that way around the last value
//   period     ms from one rise through the middle of least and greatest to the next, on average
// They are the definitions of a campaign's measures, too (docs/guide/workbench.md). A value that does not come from
// anywhere has no overshoot and no settling time.

export interface Measures {
  least: number;
  greatest: number;
  mean: number;
  overshoot_percent: number | null;
  settling_ms: number | null;
  period_ms: number | null;
}

export const settling_band = 0.02;

function overshoot(values: Float64Array, least: number, greatest: number): number | null {
  const first = values[0] as number;
  const last = values[values.length - 1] as number;
  if (first === last) return null;
  const beyond = last > first ? greatest - last : last - least;
  return (Math.max(0, beyond) / Math.abs(last - first)) * 100;
}

function settling(values: Float64Array): number | null {
  const last = values[values.length - 1] as number;
  const band = Math.abs(last - (values[0] as number)) * settling_band;
  if (band === 0) return null;
  let n = values.length - 1;
  while (n > 0 && Math.abs((values[n - 1] as number) - last) <= band) --n;
  return n;
}

function period(values: Float64Array, least: number, greatest: number): number | null {
  const middle = (least + greatest) / 2;
  let first = -1;
  let last = -1;
  let rises = 0;
  for (let n = 1; n < values.length; ++n) {
    if (!((values[n - 1] as number) < middle && (values[n] as number) >= middle)) continue;
    if (first < 0) first = n;
    else ++rises;
    last = n;
  }
  return rises > 0 ? (last - first) / rises : null;
}

// Null where a millisecond has no value.
export function measure(values: Float64Array): Measures | null {
  if (values.length === 0) return null;
  let least = Infinity;
  let greatest = -Infinity;
  let sum = 0;
  for (const value of values) {
    if (Number.isNaN(value)) return null;
    if (value < least) least = value;
    if (value > greatest) greatest = value;
    sum += value;
  }
  return {
    least,
    greatest,
    mean: sum / values.length,
    overshoot_percent: overshoot(values, least, greatest),
    settling_ms: settling(values),
    period_ms: period(values, least, greatest),
  };
}
