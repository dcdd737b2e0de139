// Telegrams that are on the lines right now, for slow motion. What has happened in a millisecond is known at its end, so what
// is shown is a millisecond late: from then on each telegram takes as long as it took on the line.
import { signal } from "@preact/signals";

import { request } from "../server/connection";
import { generation, hello, time } from "../server/live";
import type { TraceFrame } from "../server/protocol";

export interface OnLine {
  frame: TraceFrame;
  began_us: number;
  took_us: number;
}

const slow = 0.1; // faster ones are gone before one has seen them
const late_us = 1000;
const ask_ms = 80;

export const onLines = signal<OnLine[]>([]);
export const read = signal<TraceFrame | null>(null); // what a person has clicked

// The last news of time, and what was shown then.
let news = { us: 0, running: false, speed: 1 };
let base_us = 0;
let base_at = 0;

// The moment that is shown.
export function shownUs(): number {
  const gone = news.running ? (performance.now() - base_at) * 1000 * news.speed : 0;
  return Math.min(base_us + gone, news.us);
}

function isSlow(): boolean {
  const { speed, running } = time.peek();
  return hello.peek()?.mode === "plant" && !hello.peek()?.live && speed > 0 && speed <= slow && running;
}

// As long as the drawing is there.
export function followTelegrams(): () => void {
  let open = true;
  let newest = -1;
  let timer: ReturnType<typeof setTimeout> | undefined;
  const stopTime = time.subscribe(({ us, running, speed }) => {
    if (us === news.us && running === news.running && speed === news.speed) return;
    const shown = shownUs();
    base_us = Math.min(us, running ? Math.max(shown, us - late_us) : shown);
    base_at = performance.now();
    news = { us, running, speed };
  });
  const stopGeneration = generation.subscribe(() => {
    onLines.value = [];
    base_us = time.peek().us;
    newest = -1;
  });
  const look = async () => {
    if (isSlow()) {
      try {
        const reply = await request({ do: "bus.trace", limit: 60, ...(newest > 0 ? { after: newest } : {}) });
        const frames = reply.frames as TraceFrame[];
        const shown = shownUs();
        const fresh = frames
          .filter((frame) => frame.n > newest && frame.took_us !== undefined && frame.us > shown)
          .map((frame) => ({ frame, began_us: frame.us - (frame.took_us ?? 0), took_us: frame.took_us ?? 0 }));
        newest = Math.max(newest, ...frames.map((frame) => frame.n));
        // One that was long under way when it became known runs now, as long as it took.
        for (const one of fresh) one.began_us = Math.max(one.began_us, Math.min(shown, one.frame.us));
        onLines.value = [...onLines.peek().filter((one) => one.began_us + one.took_us > shown), ...fresh];
      } catch {
        // The connection says so itself.
      }
    } else if (time.peek().running && onLines.peek().length > 0) {
      onLines.value = []; // faster now; those of a plant that stands stay where they are
    }
    if (open) timer = setTimeout(() => void look(), ask_ms);
  };
  void look();
  return () => {
    open = false;
    clearTimeout(timer);
    stopTime();
    stopGeneration();
    onLines.value = [];
  };
}
