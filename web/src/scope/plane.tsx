// One channel against another, of what the window shows.
import { effect, signal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";

import { drawPlane } from "../picture/xy";
import { channelNames } from "./channels";
import { longest_ms, points, samples } from "./recording";
import { lastRecorded, scope, shownWindow } from "./window";

export interface PlaneAxes {
  x: string; // names of channels; empty: no such view
  y: string;
}
export const planeAxes = signal<PlaneAxes>({ x: "", y: "" });

const pause_ms = 250;
const height = 320;

export function PlaneForm() {
  const { x, y } = planeAxes.value;
  const axis = (label: string, value: string, set: (name: string) => void) => (
    <label class="field">
      {label}
      <select value={value} onChange={(event) => set(event.currentTarget.value)}>
        <option value="">–</option>
        {channelNames.value.map((name) => (
          <option key={name}>{name}</option>
        ))}
      </select>
    </label>
  );
  return (
    <fieldset>
      <legend>XY</legend>
      {axis("X", x, (name) => (planeAxes.value = { ...planeAxes.peek(), x: name }))}
      {axis("Y", y, (name) => (planeAxes.value = { ...planeAxes.peek(), y: name }))}
    </fieldset>
  );
}

export function Plane() {
  const canvas = useRef<HTMLCanvasElement>(null);
  const { x, y } = planeAxes.value;
  const names = channelNames.value;
  const shows = names.includes(x) && names.includes(y);
  useEffect(() => {
    if (!shows) return undefined;
    let timer: ReturnType<typeof setTimeout> | undefined;
    const draw = async () => {
      const { from_us, to_us } = shownWindow.peek();
      const end = Math.max(0, Math.min(to_us, lastRecorded.peek()));
      const all = await samples(Math.max(0, from_us, end - longest_ms * 1000), end);
      const channels = scope.peek()?.channels ?? [];
      const [nx, ny] = [x, y].map((name) => channels.findIndex((channel) => channel.name === name)) as [number, number];
      const [cx, cy, xs, ys] = [channels[nx], channels[ny], all.values[nx], all.values[ny]];
      if (canvas.current && cx && cy && xs && ys)
        drawPlane(canvas.current, Math.min(720, canvas.current.parentElement?.clientWidth ?? 400), height, { x: cx, y: cy, xs, ys });
    };
    const stop = effect(() => {
      void points.value; // there is something new
      timer ??= setTimeout(() => {
        timer = undefined;
        void draw().catch(() => undefined);
      }, pause_ms);
    });
    return () => {
      stop();
      clearTimeout(timer);
    };
  }, [x, y, shows]);
  if (!shows) return null;
  return <canvas class="plane" ref={canvas} role="img" aria-label={`${y} against ${x}`} />;
}
