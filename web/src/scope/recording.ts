// What the scope has to show: its settings as they come, the points of the window as often as they change, and every
// sample between the cursors. The memory is the server's, so a reload and a zoom ask for what is needed and nothing is lost.
import { computed, effect, signal } from "@preact/signals";

import { measure, type Measures } from "../picture/measure";
import type { Samples } from "../picture/points";
import { requestFrame, requestParts, subscribe } from "../server/connection";
import { generation, time } from "../server/live";
import type { ScopeState } from "../server/protocol";
import { complain } from "../shell/notice";
import { readFrame, type Frame } from "./frame";
import { cursors, lastRecorded, recording, scope, shownWindow, type CursorName, type Window } from "./window";

const refresh_ms = 80;
const most_points = 4096; // of a frame
// So much is fetched to be measured or drawn one channel against another.
export const longest_ms = 200_000;

export const points = signal<Frame | null>(null);
export const pictureWidth = signal(800);
// Values of all channels at the cursors, to the millisecond.
export const atCursor = signal<Record<CursorName, (number | null)[] | null>>({ A: null, B: null });
// Between them; null: they are not both set, or lie too far apart.
export const measures = signal<(Measures | null)[] | null>(null);

function view(from_us: number, to_us: number, most: number): Promise<Frame> {
  const from = Math.max(0, Math.floor(from_us));
  const to = Math.max(0, Math.ceil(to_us));
  return requestFrame({ do: "scope.view", from_us: from, to_us: to, points: most, exact: true, later: true }).then((frame) => readFrame(frame, from_us, to_us));
}

async function look(): Promise<void> {
  const { from_us, to_us } = shownWindow.peek();
  points.value = await view(from_us, to_us, Math.max(50, Math.min(most_points, pictureWidth.peek())));
}

// Every millisecond of a stretch.
export async function samples(from_us: number, to_us: number): Promise<Samples> {
  const pieces: Frame[] = [];
  for (let at = from_us; at <= to_us; at += most_points * 1000)
    pieces.push(await view(at, Math.min(to_us, at + (most_points - 1) * 1000), most_points));
  const total = pieces.reduce((sum, piece) => sum + piece.count, 0);
  const values = (pieces[0]?.least ?? []).map((_, channel) => {
    const all = new Float64Array(total);
    let at = 0;
    for (const piece of pieces) {
      all.set(piece.least[channel] ?? [], at);
      at += piece.count;
    }
    return all;
  });
  return { first_us: pieces.find((piece) => piece.count > 0)?.first_us ?? from_us, values };
}

async function readCursor(name: CursorName): Promise<void> {
  const at = cursors.peek()[name];
  let values: (number | null)[] | null = null;
  if (at !== null) {
    const frame = await view(at, at, 1);
    if (frame.count > 0) values = frame.least.map((channel) => (Number.isNaN(channel[0]) ? null : (channel[0] as number)));
  }
  atCursor.value = { ...atCursor.peek(), [name]: values };
}

export const between = computed<Window | null>(() => {
  const { A, B } = cursors.value;
  return A === null || B === null || A === B ? null : { from_us: Math.min(A, B), to_us: Math.max(A, B) };
});

let measured = 0;
async function measureBetween(): Promise<void> {
  const mine = ++measured;
  const part = between.peek();
  if (!part || part.to_us - part.from_us > longest_ms * 1000) {
    measures.value = null;
    return;
  }
  const found = await samples(part.from_us, part.to_us);
  const whole = (part.to_us - part.from_us) / 1000 + 1;
  // A stretch that has not all been recorded is not measured.
  if (mine === measured) measures.value = found.values.map((values) => (values.length === whole ? measure(values) : null));
}

// As long as the view is open.
export function followScope(): () => void {
  // New samples are asked for by window; those of the topic would be the same ones again.
  const stopTopic = subscribe("scope", { rate: 10, step_ms: 1000 }, (event) => {
    scope.value = event as unknown as ScopeState;
  });
  let open = true;
  let seen = "";
  let timer: ReturnType<typeof setTimeout> | undefined;
  const refresh = async () => {
    const began = performance.now();
    const { from_us, to_us } = shownWindow.peek();
    const state = scope.peek();
    const key = [from_us, to_us, Math.min(to_us, time.peek().us), state?.later_us, generation.peek(), state?.recording, state?.state, pictureWidth.peek()].join(" ");
    if (key !== seen && state) {
      try {
        await look();
        seen = key;
      } catch {
        // The connection says so itself; the next round asks again.
      }
      await new Promise(requestAnimationFrame);
    }
    // A browser that takes long to draw is asked to draw less often.
    if (open) timer = setTimeout(() => void refresh(), Math.max(refresh_ms, 2 * (performance.now() - began)));
  };
  void refresh();
  const stopCursors = (["A", "B"] as const).map((name) =>
    effect(() => {
      void cursors.value[name];
      void recording.value;
      void generation.value;
      void readCursor(name).catch(() => undefined);
    }),
  );
  // What lies before the newest sample does not change; the end of it may come later.
  const recorded = computed(() => Math.min(between.value?.to_us ?? 0, lastRecorded.value));
  const stopMeasures = effect(() => {
    void recorded.value;
    void between.value;
    void recording.value;
    void generation.value;
    void measureBetween().catch(() => undefined);
  });
  return () => {
    open = false;
    stopTopic();
    clearTimeout(timer);
    stopMeasures();
    for (const stop of stopCursors) stop();
  };
}

async function textOf(command: { do: string; [key: string]: unknown }, member: string): Promise<string | undefined> {
  try {
    const parts = await requestParts(command);
    return parts.map((reply) => (reply[member] as string | undefined) ?? "").join("");
  } catch (reason) {
    complain(reason);
    return undefined;
  }
}

export function csv(part?: Window): Promise<string | undefined> {
  return textOf({ do: "scope.csv", ...(part ?? {}) }, "csv");
}

export function pictureText(form: "svg" | "html", title: string, part: Window): Promise<string | undefined> {
  return textOf({ do: "scope.picture", form, title, ...part }, "text");
}
