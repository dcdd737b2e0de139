// The picture of the scope: uPlot with a scale for each unit, cursors and the trigger drawn over it.
import { effect, signal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import uPlot from "uplot";

import type { Channel } from "../server/protocol";
import { points, pictureWidth } from "./recording";
import { activeCursor, cursors, follow, putCursor, scope, shownWindow, triggerTime, zoomBy, zoomTo } from "./window";

// Where the pointer is, in us, and the values there.
export const pointer = signal<{ us: number; values: (number | null)[] } | null>(null);
let shown: uPlot | undefined;

export function colour(channel: number): string {
  return getComputedStyle(document.documentElement).getPropertyValue(`--s${channel + 1}`).trim();
}

function themed(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

function scaleOf(channel: Channel): string {
  return `y ${channel.unit}`;
}

function drawnWindow(): [number, number] {
  const { from_us, to_us } = points.peek() ?? shownWindow.peek();
  return [from_us / 1e6, to_us / 1e6];
}

function drawMark(plot: uPlot, us: number | null, text: string, stroke: string): void {
  if (us === null) return;
  const x = Math.round(plot.valToPos(us / 1e6, "x", true));
  const { left, top, width, height } = plot.bbox;
  if (x < left || x > left + width) return;
  const { ctx } = plot;
  ctx.save();
  ctx.strokeStyle = ctx.fillStyle = stroke;
  ctx.lineWidth = devicePixelRatio;
  ctx.setLineDash([4 * devicePixelRatio, 3 * devicePixelRatio]);
  ctx.beginPath();
  ctx.moveTo(x, top);
  ctx.lineTo(x, top + height);
  ctx.stroke();
  ctx.font = `600 ${11 * devicePixelRatio}px system-ui, sans-serif`;
  ctx.textAlign = x > left + width - 30 ? "right" : "left";
  ctx.fillText(text, x + (ctx.textAlign === "right" ? -4 : 4), top + 12 * devicePixelRatio);
  ctx.restore();
}

function drawMarks(plot: uPlot): void {
  drawMark(plot, triggerTime.peek(), "T", themed("--bad"));
  drawMark(plot, cursors.peek().A, "A", themed("--text"));
  drawMark(plot, cursors.peek().B, "B", themed("--text"));
}

function axesOf(channels: Channel[]): uPlot.Axis[] {
  const units = [...new Set(channels.map((channel) => channel.unit))];
  const font = "11px system-ui, sans-serif";
  const stroke = themed("--quiet");
  const grid = { stroke: themed("--line"), width: 1 };
  const narrow = pictureWidth.peek() < 520;
  return [
    { stroke, grid, font, ticks: grid, values: (_plot, splits) => splits.map((split) => `${+split.toFixed(6)} s`) },
    ...units.slice(0, narrow ? 2 : 4).map((unit, position) => ({
      scale: `y ${unit}`,
      side: position === 0 ? 3 : 1,
      stroke,
      font,
      ticks: grid,
      size: narrow ? 48 : 58,
      grid: position === 0 ? grid : { show: false },
      label: unit || "value",
      labelFont: font,
      labelSize: 18,
    })),
  ];
}

function optionsOf(channels: Channel[], width: number, height: number): uPlot.Options {
  return {
    width,
    height,
    legend: { show: false },
    cursor: { drag: { x: true, y: false, setScale: false }, points: { size: 6 } },
    scales: {
      x: { time: false, range: drawnWindow },
      ...Object.fromEntries(
        channels.map((channel) => [
          scaleOf(channel),
          {
            range: (_plot: uPlot, least: number | null, most: number | null): [number, number] => {
              const low = least ?? 0;
              const high = most ?? 1;
              const margin = high > low ? (high - low) * 0.08 : Math.max(1, Math.abs(high) * 0.1);
              return [low - margin, high + margin];
            },
          },
        ]),
      ),
    },
    axes: axesOf(channels),
    series: [
      {},
      ...channels.map((channel, position) => ({
        label: channel.name,
        scale: scaleOf(channel),
        stroke: colour(position),
        width: 1.5,
        points: { show: false },
      })),
    ],
    hooks: {
      draw: [drawMarks],
      setCursor: [readPointer],
      setSelect: [
        (plot) => {
          if (plot.select.width < 4) return;
          zoomTo(plot.posToVal(plot.select.left, "x") * 1e6, plot.posToVal(plot.select.left + plot.select.width, "x") * 1e6);
          plot.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
        },
      ],
    },
  };
}

function readPointer(plot: uPlot): void {
  const left = plot.cursor.left ?? -1;
  if (left < 0 || plot.data[0].length === 0) {
    pointer.value = null;
    return;
  }
  const index = plot.posToIdx(left);
  pointer.value = {
    us: plot.posToVal(left, "x") * 1e6,
    values: plot.data.slice(1).map((channel) => channel[index] ?? null),
  };
}

// A click puts the active cursor, a wheel zooms, a double click shows everything again.
function attach(plot: uPlot): void {
  let down = 0;
  plot.over.addEventListener("pointerdown", (event) => (down = event.clientX));
  plot.over.addEventListener("click", (event) => {
    if (Math.abs(event.clientX - down) > 4) return;
    putCursor(event.shiftKey ? "B" : activeCursor.peek(), plot.posToVal(event.offsetX, "x") * 1e6);
  });
  plot.over.addEventListener("dblclick", follow);
  plot.over.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      zoomBy(event.deltaY > 0 ? 1.25 : 0.8, plot.posToVal(event.offsetX, "x") * 1e6);
    },
    { passive: false },
  );
}

// The picture as it stands, with the names of its channels, for a file.
export function pictureFile(): Blob | null {
  const state = scope.peek();
  if (!shown || !state) return null;
  const source = shown.ctx.canvas;
  const heading = 26 * devicePixelRatio;
  const canvas = document.createElement("canvas");
  canvas.width = source.width;
  canvas.height = source.height + heading;
  const ctx = canvas.getContext("2d");
  if (!ctx) return null;
  ctx.fillStyle = themed("--panel");
  ctx.fillRect(0, 0, canvas.width, canvas.height);
  ctx.font = `${12 * devicePixelRatio}px system-ui, sans-serif`;
  let x = 12 * devicePixelRatio;
  state.channels.forEach((channel, position) => {
    ctx.fillStyle = colour(position);
    const text = channel.unit ? `${channel.name} [${channel.unit}]` : channel.name;
    ctx.fillText(text, x, heading * 0.7);
    x += ctx.measureText(text).width + 18 * devicePixelRatio;
  });
  ctx.drawImage(source, 0, heading);
  // toBlob waits until the browser is idle, which it is not while the scope runs.
  const bytes = atob(canvas.toDataURL("image/png").replace(/^.*,/, ""));
  return new Blob([Uint8Array.from(bytes, (byte) => byte.charCodeAt(0))], { type: "image/png" });
}

export function Picture() {
  const frame = useRef<HTMLDivElement>(null);
  const theme = useRef(matchMedia("(prefers-color-scheme: light)"));
  const recording = scope.value?.recording;
  const layout = scope.value?.channels.map((channel) => `${channel.name}|${channel.unit}`).join("\n");
  useEffect(() => {
    const element = frame.current;
    const channels = scope.peek()?.channels ?? [];
    if (!element || channels.length === 0) return undefined;
    let stopData = () => {};
    const build = () => {
      shown?.destroy();
      stopData();
      const plot = new uPlot(optionsOf(channels, element.clientWidth, element.clientHeight), [[], ...channels.map(() => [])], element);
      shown = plot;
      attach(plot);
      stopData = effect(() => {
        const data = points.value;
        void cursors.value;
        void triggerTime.value;
        if (!data || data.channels.length !== channels.length || data.recording !== recording) return;
        plot.setData([data.times, ...data.channels]);
        readPointer(plot);
      });
    };
    const observer = new ResizeObserver(() => {
      // A tab that is left has no width.
      if (element.clientWidth === 0) return;
      pictureWidth.value = Math.floor(element.clientWidth);
      build();
    });
    observer.observe(element);
    theme.current.addEventListener("change", build);
    return () => {
      observer.disconnect();
      theme.current.removeEventListener("change", build);
      stopData();
      shown?.destroy();
      shown = undefined;
      pointer.value = null;
    };
  }, [recording, layout]);
  return <div class="picture" ref={frame} />;
}
