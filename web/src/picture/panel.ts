// One panel: curves of one unit over time, drawn by uPlot. The range and the numbers of its axis are counted here, so that
// all panels of a picture begin at the same place and no number is cut.
import uPlot from "uplot";

import { labels, ticks } from "./axis";
import { isSetpoint, type Channel, type Panel } from "./channel";
import type { Window } from "./control";
import { font, type Ink } from "./lanes";
import type { Points } from "./points";

export const right_margin = 14;
const colours_before_dashes = 8;

export interface PanelScale {
  least: number;
  most: number;
  splits: number[];
  texts: string[];
}

// Zero belongs to the picture unless all values are far from it.
export function scaleOf(panel: Panel, points: Points, height: number): PanelScale {
  let least = Infinity;
  let most = -Infinity;
  for (const channel of panel.channels) {
    for (const value of points.least[channel] ?? []) if (value < least) least = value;
    for (const value of points.greatest[channel] ?? []) if (value > most) most = value;
  }
  if (!(least <= most)) [least, most] = [0, 1];
  if (least > 0 && least < 0.5 * most) least = 0;
  if (most < 0 && most > 0.5 * least) most = 0;
  if (most - least < 1e-9 * Math.max(1, Math.abs(most))) [least, most] = [least - 1, most + 1];
  const margin = 0.07 * (most - least);
  least -= margin;
  most += margin;
  const splits = ticks(least, most, Math.max(2, Math.floor(height / 32)));
  return { least, most, splits, texts: labels(splits) };
}

// Least and greatest stand one above the other.
function column(low: Float64Array, high: Float64Array, per: number): (number | null)[] {
  const values: (number | null)[] = new Array<number | null>(low.length * per);
  for (let n = 0; n < low.length; ++n) {
    const value = low[n] as number;
    values[n * per] = Number.isNaN(value) ? null : value;
    if (per === 2) values[n * per + 1] = Number.isNaN(value) ? null : (high[n] as number);
  }
  return values;
}

export class DrawnPanel {
  readonly plot: uPlot;
  private scale: PanelScale = { least: 0, most: 1, splits: [], texts: [] };
  private window: Window = { from_us: 0, to_us: 1 };
  private left = 50;
  private seconds: number[] = [];

  constructor(
    readonly panel: Panel,
    channels: Channel[],
    size: { width: number; height: number },
    ink: Ink,
    parent: HTMLElement,
  ) {
    const grid = { stroke: ink.line, width: 1 };
    this.plot = new uPlot(
      {
        ...size,
        legend: { show: false },
        cursor: { show: false },
        padding: [18, right_margin, 6, 0],
        scales: {
          x: { time: false, range: () => [this.window.from_us / 1e6, this.window.to_us / 1e6] },
          y: { range: () => [this.scale.least, this.scale.most] },
        },
        axes: [
          { size: 0, grid, ticks: { show: false }, splits: () => this.seconds, values: () => [] },
          {
            stroke: ink.quiet,
            font,
            grid,
            ticks: { stroke: ink.line, width: 1, size: 4 },
            size: () => this.left,
            gap: 4,
            splits: () => this.scale.splits,
            values: () => this.scale.texts,
          },
        ],
        series: [
          {},
          ...panel.channels.map((number) => {
            const channel = channels[number] as Channel;
            const wide = isSetpoint(channel);
            return {
              label: channel.name,
              scale: "y",
              stroke: ink.colour(number),
              alpha: wide ? 0.5 : 1,
              width: wide ? 5 : 1.5,
              dash: number >= colours_before_dashes ? [6, 3] : [],
              points: { show: false },
            };
          }),
        ],
      },
      [[], ...panel.channels.map(() => [])],
      parent,
    );
  }

  show(points: Points, window: Window, scale: PanelScale, left: number, seconds: number[]): void {
    this.window = window;
    this.scale = scale;
    const moves = this.left !== left;
    this.left = left;
    this.seconds = seconds;
    const per = points.least[0] === points.greatest[0] ? 1 : 2;
    const times = new Float64Array(points.count * per);
    for (let n = 0; n < points.count; ++n) times.fill((points.first_us + n * points.step_us) / 1e6, n * per, (n + 1) * per);
    const columns = this.panel.channels.map((channel) =>
      column(points.least[channel] ?? new Float64Array(0), points.greatest[channel] ?? new Float64Array(0), per),
    );
    this.plot.setData([times, ...columns]);
    if (moves) this.plot.redraw(true, true); // uPlot measures its axes only when a scale changes
  }

  destroy(): void {
    this.plot.destroy();
  }
}
