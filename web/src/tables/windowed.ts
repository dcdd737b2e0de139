// Long tables: of many rows only those in sight are in the document, with room above and below for the others. The box that
// scrolls is measured, so a table works in a pane of any size. A short list is there as a whole: people search in it.
import { useLayoutEffect, useState } from "preact/hooks";
import type { RefObject } from "preact";

const whole_list = 200; // rows
const margin_rows = 10;

export interface Rows {
  from: number;
  to: number;
  above: number; // pixels
  below: number;
}

export function useWindowed(box: RefObject<HTMLElement | null>, count: number): Rows {
  const [seen, setSeen] = useState({ top: 0, height: 600, row: 30 });
  useLayoutEffect(() => {
    const element = box.current;
    if (!element) return undefined;
    const look = () => {
      const row = element.querySelector<HTMLElement>("tbody > tr")?.offsetHeight || 30;
      const next = { top: element.scrollTop, height: element.clientHeight, row };
      setSeen((now) => (now.top === next.top && now.height === next.height && now.row === next.row ? now : next));
    };
    look();
    element.addEventListener("scroll", look, { passive: true });
    const size = new ResizeObserver(look);
    size.observe(element);
    return () => {
      element.removeEventListener("scroll", look);
      size.disconnect();
    };
  }, [count > 0]);
  if (count <= whole_list) return { from: 0, to: count, above: 0, below: 0 };
  const first = Math.max(0, Math.min(count - 1, Math.floor(seen.top / seen.row)) - margin_rows);
  const last = Math.min(count, Math.ceil((seen.top + seen.height) / seen.row) + margin_rows);
  return { from: first, to: last, above: first * seen.row, below: (count - last) * seen.row };
}
