// The body of a long table: the rows in sight and some before and behind them; empty space stands for the others. A short
// table has all its rows: people search in it. All rows are as high as each other.
import type { ComponentChildren } from "preact";
import { useEffect, useLayoutEffect, useRef, useState } from "preact/hooks";

const usually_short = 200;
const margin = 20;
const guessed_height = 33;

export interface Range {
  first: number;
  end: number; // one behind the last
}

interface Shown<Item> {
  items: readonly Item[];
  row: (item: Item, position: number) => ComponentChildren;
  onRange?: (range: Range) => void;
  short?: number; // so many rows are all drawn
}

export function Rows<Item>({ items, row, onRange, short = usually_short }: Shown<Item>) {
  const body = useRef<HTMLTableSectionElement>(null);
  const height = useRef(guessed_height);
  const [range, setRange] = useState<Range>({ first: 0, end: Math.max(short, 2 * margin) });
  const long = items.length > short;
  const first = long ? Math.min(range.first, Math.max(0, items.length - margin)) : 0;
  const end = long ? Math.min(items.length, Math.max(range.end, first + margin)) : items.length;
  const look = () => {
    const element = body.current;
    const scroller = element?.closest(".scroll");
    if (!element || !scroller || !long) return;
    const drawn = [...element.children].filter((one) => !one.hasAttribute("aria-hidden"));
    if (drawn.length > 0) height.current = drawn.reduce((sum, one) => sum + one.getBoundingClientRect().height, 0) / drawn.length;
    const box = scroller.getBoundingClientRect();
    const top = element.getBoundingClientRect().top;
    // In steps of the margin, so that not every line that is scrolled draws anew.
    const from = Math.floor((Math.max(0, box.top) - top) / height.current / margin) - 1;
    const to = Math.ceil((Math.min(innerHeight, box.bottom) - top) / height.current / margin) + 1;
    const next = { first: Math.max(0, from * margin), end: Math.max(margin, to * margin) };
    setRange((now) => (now.first === next.first && now.end === next.end ? now : next));
  };
  useLayoutEffect(look, [items.length]);
  useEffect(() => onRange?.({ first, end }), [first, end]);
  useEffect(() => {
    if (!long) return undefined;
    const observer = new ResizeObserver(look);
    const scroller = body.current?.closest(".scroll");
    if (scroller) observer.observe(scroller);
    document.addEventListener("scroll", look, true);
    return () => {
      observer.disconnect();
      document.removeEventListener("scroll", look, true);
    };
  }, [long, items.length]);
  const space = (rows: number) => rows > 0 && <tr aria-hidden="true" class="space" style={`height:${rows * height.current}px`} />;
  return (
    <tbody ref={body} role="rowgroup">
      {space(first)}
      {items.slice(first, end).map((item, position) => row(item, first + position))}
      {space(items.length - end)}
    </tbody>
  );
}
