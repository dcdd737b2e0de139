// Lanes and the axis of time below the panels: levels, bits, strips of words, and strokes of telegrams.
import { labels, ticks } from "./axis";
import { wordsOf, type Channel, type Lane } from "./channel";
import type { Track, Window } from "./control";
import type { Points } from "./points";

export const lane_height = 20;
export const axis_height = 30;
const level_height = 12;

export interface Area {
  left: number;
  right: number;
  width: number;
}
export interface Ink {
  text: string;
  quiet: string;
  line: string;
  ground: string;
  colour(channel: number): string;
}

export const font = "11px system-ui, sans-serif";

function fitting(ctx: CanvasRenderingContext2D, text: string, room: number): string {
  if (ctx.measureText(text).width <= room) return text;
  let letters = text.length;
  while (letters > 1 && ctx.measureText(`${text.slice(0, letters)}…`).width > room) --letters;
  return letters > 1 ? `${text.slice(0, letters)}…` : "";
}

function isStrip(lane: Lane, channel: Channel): boolean {
  return channel.kind === "words" || (channel.kind === "word" && lane.bit === null);
}

// Stretches of equal values: [first point, point after the last, least, greatest].
function* stretches(low: Float64Array, high: Float64Array, mask: number): Generator<[number, number, number, number]> {
  const part = (value: number) => (mask === -1 ? value : value & mask);
  for (let n = 0; n < low.length; ) {
    let end = n + 1;
    const a = part(low[n] as number);
    const b = part(high[n] as number);
    while (end < low.length && part(low[end] as number) === a && part(high[end] as number) === b) ++end;
    if (!Number.isNaN(low[n] as number)) yield [n, end, low[n] as number, high[n] as number];
    n = end;
  }
}

function drawLane(ctx: CanvasRenderingContext2D, lane: Lane, channel: Channel, points: Points, area: Area, xOf: (us: number) => number, y: number, ink: Ink): void {
  const low = points.least[lane.channel] as Float64Array;
  const high = points.greatest[lane.channel] as Float64Array;
  const colour = ink.colour(lane.channel);
  const words = isStrip(lane, channel);
  const mask = lane.bit !== null ? 1 << lane.bit : words ? (channel.mask ?? -1) : -1;
  ctx.strokeStyle = ink.line;
  ctx.strokeRect(area.left, y + level_height + 3.5, area.right - area.left, 0);
  for (const [begin, end, least, greatest] of stretches(low, high, mask)) {
    const from = Math.max(area.left, xOf(points.first_us + begin * points.step_us));
    const to = Math.min(area.right, xOf(points.first_us + end * points.step_us));
    if (to < area.left || from > area.right) continue;
    const width = Math.max(1, to - from);
    const always = lane.bit !== null ? (least >> lane.bit) & 1 : least;
    const ever = lane.bit !== null ? (greatest >> lane.bit) & 1 : greatest;
    ctx.fillStyle = colour;
    if (!words) {
      ctx.globalAlpha = always !== 0 && always === ever ? 0.55 : ever !== 0 ? 0.8 : 0;
      ctx.fillRect(from, y + 3, width, level_height);
      ctx.globalAlpha = 1;
      continue;
    }
    const text = wordsOf(channel, least, greatest);
    ctx.globalAlpha = text === null ? 0.7 : 0.22;
    ctx.fillRect(from, y + 2, width, level_height + 2);
    ctx.globalAlpha = 1;
    ctx.fillRect(from, y + 2, 1, level_height + 2);
    ctx.fillStyle = ink.text;
    if (text !== null && width > 24) ctx.fillText(fitting(ctx, text, width - 6), from + 4, y + 12);
  }
}

function drawTrack(ctx: CanvasRenderingContext2D, track: Track, area: Area, xOf: (us: number) => number, y: number, ink: Ink): void {
  ctx.strokeStyle = ink.quiet;
  ctx.beginPath();
  let before = -1;
  for (const us of track.times_us) {
    const x = xOf(us);
    if (x < area.left || x > area.right || x - before < 0.5) continue;
    before = x;
    ctx.moveTo(x, y + 3);
    ctx.lineTo(x, y + 3 + level_height);
  }
  ctx.stroke();
}

// A name stands at the beginning of its lane, of a strip of words at its end.
function drawName(ctx: CanvasRenderingContext2D, text: string, area: Area, y: number, ink: Ink, atEnd = false): void {
  const shown = fitting(ctx, text, Math.min(area.right - area.left, 260));
  const width = ctx.measureText(shown).width;
  const x = atEnd ? area.right - width - 4 : area.left + 4;
  ctx.fillStyle = ink.ground;
  ctx.globalAlpha = 0.72;
  ctx.fillRect(x - 2, y + 1, width + 4, level_height + 3);
  ctx.globalAlpha = 1;
  ctx.fillStyle = ink.text;
  ctx.fillText(shown, x, y + 12);
}

function drawAxis(ctx: CanvasRenderingContext2D, window: Window, area: Area, xOf: (us: number) => number, y: number, ink: Ink): void {
  const seconds = ticks(window.from_us / 1e6, window.to_us / 1e6, Math.max(2, Math.floor((area.right - area.left) / 90)));
  const texts = labels(seconds);
  ctx.strokeStyle = ctx.fillStyle = ink.quiet;
  ctx.beginPath();
  ctx.moveTo(area.left, y + 0.5);
  ctx.lineTo(area.right, y + 0.5);
  seconds.forEach((s, n) => {
    const x = xOf(s * 1e6);
    ctx.moveTo(x, y);
    ctx.lineTo(x, y + 4);
    const text = `${texts[n]} s`;
    const half = ctx.measureText(text).width / 2;
    ctx.fillText(text, Math.min(area.width - 2 * half - 1, Math.max(0, x - half)), y + 17);
  });
  ctx.stroke();
}

export function lanesHeight(lanes: Lane[], tracks: Track[]): number {
  return (lanes.length + tracks.length) * lane_height + axis_height;
}

export function drawLanes(
  ctx: CanvasRenderingContext2D,
  { lanes, tracks, channels, points, window, area, xOf, ink }: {
    lanes: Lane[]; tracks: Track[]; channels: Channel[]; points: Points; window: Window; area: Area; xOf: (us: number) => number; ink: Ink;
  },
): void {
  ctx.font = font;
  let y = 0;
  for (const lane of lanes) {
    const channel = channels[lane.channel] as Channel;
    drawLane(ctx, lane, channel, points, area, xOf, y, ink);
    drawName(ctx, lane.text, area, y, ink, isStrip(lane, channel));
    y += lane_height;
  }
  for (const track of tracks) {
    drawTrack(ctx, track, area, xOf, y, ink);
    drawName(ctx, track.name, area, y, ink);
    y += lane_height;
  }
  drawAxis(ctx, window, area, xOf, y, ink);
}
