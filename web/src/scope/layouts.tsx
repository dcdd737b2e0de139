// Layouts of the scope: channels, where they are drawn, cursors and zoom, kept with the plant under a name. What is shown now
// is kept without one, but for the zoom, which would hide what a new run records.
import { effect, signal, useSignal } from "@preact/signals";

import type { Place } from "../picture/channel";
import { setting } from "../shell/settings";
import { channelNames, places, setChannels } from "./channels";
import { planeAxes, type PlaneAxes } from "./plane";
import { cursors, zoomed, type Cursors, type Window } from "./window";

interface Layout {
  channels: string[];
  places: Record<string, Place>;
  cursors: Cursors;
  window: Window | null;
  plane: PlaneAxes;
}

const layouts = setting<Record<string, Layout>>("scope.layouts", {});
const keptCursors = setting<Cursors>("scope.cursors", { A: null, B: null });
const chosen = signal("");
const pause_ms = 400;

function save(name: string): void {
  layouts.value = {
    ...layouts.peek(),
    [name]: {
      channels: channelNames.peek(),
      places: places.peek(),
      cursors: cursors.peek(),
      window: zoomed.peek(),
      plane: planeAxes.peek(),
    },
  };
  chosen.value = name;
}

async function recall(name: string): Promise<void> {
  chosen.value = name;
  const layout = layouts.peek()[name];
  if (!layout) return;
  await setChannels(layout.channels);
  places.value = layout.places;
  cursors.value = layout.cursors;
  zoomed.value = layout.window;
  planeAxes.value = layout.plane;
}

function remove(name: string): void {
  const { [name]: _gone, ...rest } = layouts.peek();
  layouts.value = rest;
  chosen.value = "";
}

// While the scope is open; a cursor that is dragged is kept when it stands.
export function keepCursors(): () => void {
  let timer: ReturnType<typeof setTimeout> | undefined;
  let told = cursors.peek();
  const stops = [
    effect(() => {
      const kept = keptCursors.value;
      const { A, B } = cursors.peek();
      if (A === null && B === null) cursors.value = kept;
    }),
    cursors.subscribe((now) => {
      if (now === told) return;
      told = now;
      clearTimeout(timer);
      timer = setTimeout(() => (keptCursors.value = now), pause_ms);
    }),
  ];
  return () => {
    clearTimeout(timer);
    for (const stop of stops) stop();
  };
}

export function Layouts() {
  const names = Object.keys(layouts.value);
  const name = useSignal("");
  return (
    <fieldset>
      <legend>Layouts</legend>
      <label class="field">
        Layout
        <select value={chosen.value} onChange={(event) => void recall(event.currentTarget.value)}>
          <option value="">–</option>
          {names.map((one) => (
            <option key={one}>{one}</option>
          ))}
        </select>
      </label>
      <div class="row">
        <input type="text" aria-label="Layout name" placeholder="name" onInput={(event) => (name.value = event.currentTarget.value.trim())} />
        <button onClick={() => save(name.peek() || chosen.peek() || "Layout")}>Keep layout</button>
        <button disabled={!chosen.value} onClick={() => remove(chosen.peek())}>
          Remove layout
        </button>
      </div>
    </fieldset>
  );
}
