// Round numbers on an axis, and as many digits as they differ in.

export function ticks(least: number, most: number, wanted: number): number[] {
  if (!(most > least)) return [];
  const rough = (most - least) / Math.max(1, wanted);
  const power = 10 ** Math.floor(Math.log10(rough));
  const ratio = rough / power;
  const step = power * (ratio < 1.5 ? 1 : ratio < 3.5 ? 2 : ratio < 7.5 ? 5 : 10);
  const all: number[] = [];
  for (let n = Math.ceil(least / step - 1e-9); n * step <= most + 1e-9 * step; ++n) all.push(n === 0 ? 0 : n * step);
  return all;
}

export function labels(values: number[]): string[] {
  const step = values.length > 1 ? (values[1] as number) - (values[0] as number) : 1;
  const places = Math.floor(Math.log10(Math.abs(step)) + 1e-9);
  const greatest = Math.max(1, ...values.map(Math.abs));
  if (greatest >= 1e7) {
    const digits = Math.min(15, Math.max(1, Math.floor(Math.log10(greatest)) - places + 1));
    return values.map((value) => (value === 0 ? "0" : value.toPrecision(digits)));
  }
  return values.map((value) => value.toFixed(Math.min(9, Math.max(0, -places))));
}
