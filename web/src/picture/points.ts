// Points of all channels over a stretch of time. A point stands for one millisecond or for many: then it has the least and
// the greatest value of them (of a word the bits of all and of any), so that no spike is lost at any zoom.

export interface Points {
  from_us: number; // of the window that was asked for
  to_us: number;
  first_us: number; // of the first point
  step_us: number;
  count: number;
  least: Float64Array[]; // by channel; NaN: no value
  greatest: Float64Array[];
}

// Samples as they were recorded, one a millisecond.
export interface Samples {
  first_us: number;
  values: Float64Array[];
}

export const ms_us = 1000;

export function emptyPoints(channels: number): Points {
  const none = () => Array.from({ length: channels }, () => new Float64Array(0));
  return { from_us: 0, to_us: 1, first_us: 0, step_us: ms_us, count: 0, least: none(), greatest: none() };
}

// The point in which a time lies; -1: before the first or behind the last one.
export function pointAt(points: Points, us: number): number {
  const n = Math.floor((us - points.first_us) / points.step_us + (points.step_us === ms_us ? 0.5 : 0));
  return n >= 0 && n < points.count ? n : -1;
}

// Samples in at most `most` points; what lies outside of them is left out.
export function thin(samples: Samples, isWord: boolean[], from_us: number, to_us: number, most: number): Points {
  const total = samples.values[0]?.length ?? 0;
  const begin = Math.min(total, Math.max(0, Math.ceil((from_us - samples.first_us) / ms_us) - 1));
  const end = Math.max(begin, Math.min(total, Math.floor((to_us - samples.first_us) / ms_us) + 2));
  const step = Math.max(1, Math.ceil((end - begin) / most));
  const count = Math.ceil((end - begin) / step);
  const least: Float64Array[] = [];
  const greatest: Float64Array[] = [];
  samples.values.forEach((values, channel) => {
    const low = new Float64Array(count);
    const high = step === 1 ? low : new Float64Array(count);
    for (let point = 0, n = begin; point < count; ++point) {
      const stop = Math.min(end, n + step);
      let a = values[n] as number;
      let b = a;
      for (; n < stop; ++n) {
        const value = values[n] as number;
        if (isWord[channel]) {
          a &= value;
          b |= value;
        } else if (value < a) a = value;
        else if (value > b) b = value;
      }
      low[point] = a;
      high[point] = b;
    }
    least.push(low);
    greatest.push(high);
  });
  return { from_us, to_us, first_us: samples.first_us + begin * ms_us, step_us: step * ms_us, count, least, greatest };
}
