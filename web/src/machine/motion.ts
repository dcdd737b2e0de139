// Smooth motion between two states of a station. The server tells where a machine is twenty times a second; in between it
// is drawn on a straight way, and where the plant stands or nothing should move, exactly where it is.
import { useEffect, useLayoutEffect, useRef } from "preact/hooks";

import { stationState } from "../plant/state";
import { time } from "../server/live";
import { wrapped } from "./units";

const shortest_ms = 15;
const longest_ms = 300; // a state that comes later is no part of one motion

const still = matchMedia("(prefers-reduced-motion: reduce)");

// `draw` gets how many increments of the shaft the picture is behind the last state; it is called for each frame of a
// motion, and after each drawing of the component.
export function useMotion(station: string, draw: (behind: number) => void): void {
  const latest = useRef(draw);
  const behind = useRef(0);
  latest.current = draw;
  useLayoutEffect(() => draw(behind.current));
  useEffect(() => {
    let frame = 0;
    let shaft: number | undefined;
    let came = 0;
    let generation = time.peek().generation;
    const show = (increments: number) => {
      behind.current = increments;
      latest.current(increments);
    };
    const stand = () => {
      cancelAnimationFrame(frame);
      frame = 0;
      show(0);
    };
    const move = (way: number, length: number) => {
      cancelAnimationFrame(frame);
      const begin = performance.now();
      const step = (now: number) => {
        const left = 1 - Math.min(1, Math.max(0, now - begin) / length);
        show(-way * left);
        frame = left > 0 ? requestAnimationFrame(step) : 0;
      };
      show(-way);
      frame = requestAnimationFrame(step);
    };
    const stopState = stationState(station).subscribe((state) => {
      const now = performance.now();
      const since = now - came;
      came = now;
      const before = shaft;
      shaft = state?.machine?.shaft;
      if (shaft === undefined) return;
      const { running, generation: present } = time.peek();
      const continues = before !== undefined && running && present === generation && since < longest_ms && !still.matches;
      generation = present;
      if (!continues) return stand();
      move(wrapped(shaft - before) - behind.current, Math.max(shortest_ms, since));
    });
    const stopTime = time.subscribe(({ running }) => {
      if (!running && behind.current !== 0) stand();
    });
    return () => {
      stopState();
      stopTime();
      cancelAnimationFrame(frame);
    };
  }, [station]);
}
