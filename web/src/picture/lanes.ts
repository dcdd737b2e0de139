// Lanes and the axis of time below the panels: levels, bits, strips of words, and strokes of telegrams.
import { labels, ticks } from "./axis";
import { wordsOf, type Channel, type Lane } from "./channel";
import type { Track, Window } from "./control";
import type { Points } from "./points";

export const axis_height = 30;
const lane_height = 20;
const least_lane = 14; // its name can still be read

export interface Area {
  left: number;
  right: number;
  width: number;
}
// How high lanes are drawn where so many shall leave so much room for what is above them.
export function laneHeight(count: number, room: number): number {
  return Math.max(least_lane, Math.min(lane_height, Math.floor((room - axis_height) / Math.max(1, count))));
}

// Of a lane of that height what is drawn: the rest keeps it apart from the next one.
const levelOf = (lane: number) => Math.min(12, lane - 5);

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

function drawLane(ctx: CanvasRenderingContext2D, lane: Lane, channel: Channel, points: Points, area: Area, xOf: (us: number) => number, y: number, lane_height: number, ink: Ink): void {
  const level = levelOf(lane_height);
  const low = points.least[lane.channel] as Float64Array;
  const high = points.greatest[lane.channel] as Float64Array;
  const colour = ink.colour(lane.channel);
  const words = isStrip(lane, channel);
  const mask = lane.bit !== null ? 1 << lane.bit : words ? (channel.mask ?? -1) : -1;
  ctx.strokeStyle = ink.line;
  ctx.strokeRect(area.left, y + level + 3.5, area.right - area.left, 0);
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
      ctx.fillRect(from, y + 3, width, level);
      ctx.globalAlpha = 1;
      continue;
    }
    const text = wordsOf(channel, least, greatest);
    ctx.globalAlpha = text === null ? 0.7 : 0.22;
    ctx.fillRect(from, y + 2, width, level + 2);
    ctx.globalAlpha = 1;
    ctx.fillRect(from, y + 2, 1, level + 2);
    ctx.fillStyle = ink.text;
    if (text !== null && width > 24) ctx.fillText(fitting(ctx, text, width - 6), from + 4, y + level);
  }
}

function drawTrack(ctx: CanvasRenderingContext2D, track: Track, area: Area, xOf: (us: number) => number, y: number, lane_height: number, ink: Ink): void {
  ctx.strokeStyle = ink.quiet;
  ctx.beginPath();
  let before = -1;
  for (const us of track.times_us) {
    const x = xOf(us);
    if (x < area.left || x > area.right || x - before < 0.5) continue;
    before = x;
    ctx.moveTo(x, y + 3);
    ctx.lineTo(x, y + 3 + levelOf(lane_height));
  }
  ctx.stroke();
}

// A name stands at the beginning of its lane, of a strip of words at its end.
function drawName(ctx: CanvasRenderingContext2D, text: string, area: Area, y: number, lane_height: number, ink: Ink, atEnd = false): void {
  const level = levelOf(lane_height);
  const shown = fitting(ctx, text, Math.min(area.right - area.left, 260));
  const width = ctx.measureText(shown).width;
  const x = atEnd ? area.right - width - 4 : area.left + 4;
  ctx.fillStyle = ink.ground;
  ctx.globalAlpha = 0.72;
  ctx.fillRect(x - 2, y + 1, width + 4, level + 3);
  ctx.globalAlpha = 1;
  ctx.fillStyle = ink.text;
  ctx.fillText(shown, x, y + level);
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

export function lanesHeight(count: number, lane_height: number): number {
  return count * lane_height + axis_height;
}

export function drawLanes(
  ctx: CanvasRenderingContext2D,
  { lanes, tracks, lane_height, channels, points, window, area, xOf, ink }: {
    lanes: Lane[]; tracks: Track[]; lane_height: number; channels: Channel[]; points: Points; window: Window; area: Area; xOf: (us: number) => number; ink: Ink;
  },
): void {
  ctx.font = font;
  let y = 0;
  for (const lane of lanes) {
    const channel = channels[lane.channel] as Channel;
    drawLane(ctx, lane, channel, points, area, xOf, y, lane_height, ink);
    drawName(ctx, lane.text, area, y, lane_height, ink, isStrip(lane, channel));
    y += lane_height;
  }
  for (const track of tracks) {
    drawTrack(ctx, track, area, xOf, y, lane_height, ink);
    drawName(ctx, track.name, area, y, lane_height, ink);
    y += lane_height;
  }
  drawAxis(ctx, window, area, xOf, y, ink);
}
