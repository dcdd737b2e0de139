// One channel against another: a curve of every millisecond of the window, from light to dark as time passes.
import { labels, ticks } from "./axis";
import type { Channel } from "./channel";
import { font } from "./lanes";

const left = 62;
const bottom = 34;
const top = 18;
const right = 14;
const pieces = 16; // of the way from light to dark

export interface Plane {
  x: Channel;
  y: Channel;
  xs: Float64Array;
  ys: Float64Array;
}

function range(values: Float64Array): [number, number] {
  let least = Infinity;
  let most = -Infinity;
  for (const value of values) {
    if (value < least) least = value;
    if (value > most) most = value;
  }
  if (!(least <= most)) return [0, 1];
  const margin = most > least ? 0.07 * (most - least) : Math.max(1, Math.abs(most) * 0.1);
  return [least - margin, most + margin];
}

export function drawPlane(canvas: HTMLCanvasElement, width: number, height: number, plane: Plane): void {
  const dots = devicePixelRatio || 1;
  canvas.width = Math.round(width * dots);
  canvas.height = Math.round(height * dots);
  canvas.style.width = `${width}px`;
  canvas.style.height = `${height}px`;
  const ctx = canvas.getContext("2d");
  if (!ctx) return;
  const themed = (name: string) => getComputedStyle(canvas).getPropertyValue(name).trim();
  ctx.setTransform(dots, 0, 0, dots, 0, 0);
  ctx.clearRect(0, 0, width, height);
  ctx.font = font;
  const [x0, x1] = range(plane.xs);
  const [y0, y1] = range(plane.ys);
  const px = (value: number) => left + ((value - x0) / (x1 - x0)) * (width - left - right);
  const py = (value: number) => height - bottom - ((value - y0) / (y1 - y0)) * (height - top - bottom);
  ctx.strokeStyle = themed("--line");
  ctx.fillStyle = themed("--quiet");
  const xTicks = ticks(x0, x1, Math.max(2, Math.floor(width / 100)));
  const yTicks = ticks(y0, y1, Math.max(2, Math.floor(height / 40)));
  ctx.beginPath();
  for (const value of xTicks) {
    ctx.moveTo(px(value), top);
    ctx.lineTo(px(value), height - bottom);
  }
  for (const value of yTicks) {
    ctx.moveTo(left, py(value));
    ctx.lineTo(width - right, py(value));
  }
  ctx.stroke();
  ctx.textAlign = "center";
  labels(xTicks).forEach((text, n) => ctx.fillText(text, px(xTicks[n] as number), height - bottom + 14));
  ctx.textAlign = "right";
  labels(yTicks).forEach((text, n) => ctx.fillText(text, left - 5, py(yTicks[n] as number) + 4));
  ctx.fillStyle = themed("--text");
  const name = (channel: Channel) => (channel.unit ? `${channel.name} [${channel.unit}]` : channel.name);
  ctx.fillText(name(plane.x), width - right, height - 4);
  ctx.textAlign = "left";
  ctx.fillText(name(plane.y), 6, 12);
  ctx.strokeStyle = themed("--s1");
  ctx.lineWidth = 1.5;
  const count = Math.min(plane.xs.length, plane.ys.length);
  for (let piece = 0; piece < pieces; ++piece) {
    const begin = Math.floor((count * piece) / pieces);
    const end = Math.min(count - 1, Math.floor((count * (piece + 1)) / pieces));
    ctx.globalAlpha = 0.3 + (0.7 * (piece + 1)) / pieces;
    ctx.beginPath();
    let pen = false;
    for (let n = begin; n <= end; ++n) {
      const x = plane.xs[n] as number;
      const y = plane.ys[n] as number;
      if (Number.isNaN(x) || Number.isNaN(y)) pen = false;
      else if (pen) ctx.lineTo(px(x), py(y));
      else {
        ctx.moveTo(px(x), py(y));
        pen = true;
      }
    }
    ctx.stroke();
  }
  ctx.globalAlpha = 1;
}
