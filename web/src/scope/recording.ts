// What the scope has to show: its settings as they come, and the points of the window as often as they change. The
// memory is the server's, so a reload and a zoom ask for what is needed and nothing is lost.
import { effect, signal } from "@preact/signals";

import { requestFrame, requestParts, subscribe } from "../server/connection";
import { generation, time } from "../server/live";
import type { ScopeState } from "../server/protocol";
import { complain } from "../shell/notice";
import { readPoints, type Points } from "./frame";
import { cursors, recording, scope, shownWindow, type CursorName } from "./window";

const refresh_ms = 80;

export const points = signal<Points | null>(null);
export const pictureWidth = signal(800);
// Values of all channels at the cursors, to the millisecond.
export const atCursor = signal<Record<CursorName, (number | null)[] | null>>({ A: null, B: null });

async function look(): Promise<void> {
  const { from_us, to_us } = shownWindow.peek();
  const frame = await requestFrame({
    do: "scope.view",
    from_us: Math.max(0, Math.floor(from_us)),
    to_us: Math.max(0, Math.ceil(to_us)),
    points: Math.max(50, Math.min(4096, pictureWidth.peek())),
  });
  points.value = readPoints(frame, from_us, to_us);
}

async function readCursor(name: CursorName): Promise<void> {
  const at = cursors.peek()[name];
  let values: (number | null)[] | null = null;
  if (at !== null) {
    const frame = readPoints(await requestFrame({ do: "scope.view", from_us: at, to_us: at, points: 1 }), at, at);
    if (frame.times.length > 0) values = frame.channels.map((channel) => channel[0] ?? null);
  }
  atCursor.value = { ...atCursor.peek(), [name]: values };
}

// As long as the tab is open.
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
    const key = [
      from_us,
      to_us,
      Math.min(to_us, time.peek().us),
      generation.peek(),
      state?.recording,
      state?.state,
      pictureWidth.peek(),
    ].join(" ");
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
      void readCursor(name).catch(() => undefined);
    }),
  );
  return () => {
    open = false;
    stopTopic();
    clearTimeout(timer);
    for (const stop of stopCursors) stop();
  };
}

export async function csv(part?: { from_us: number; to_us: number }): Promise<string> {
  const parts = await requestParts({ do: "scope.csv", ...(part ?? {}) });
  return parts.map((reply) => (reply.csv as string | undefined) ?? "").join("");
}

export async function csvOrComplain(part?: { from_us: number; to_us: number }): Promise<string | undefined> {
  try {
    return await csv(part);
  } catch (reason) {
    complain(reason);
    return undefined;
  }
}
