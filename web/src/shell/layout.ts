// Where the views stand: a tree of splits with a view at each end. Everything here is a function of a tree and gives a new
// one; nothing knows the document.

export type Side = "left" | "right" | "above" | "below";
export type Direction = "row" | "column";

export interface Part {
  share: number; // of the split; all of them together are 1
  layout: Layout;
}

export interface Split {
  direction: Direction;
  parts: Part[];
}

export type Layout = { view: string } | Split;

// In parts of the whole.
export interface Rect {
  x: number;
  y: number;
  width: number;
  height: number;
}

// For the style of what lies there (style/shell.css).
export function placed({ x, y, width, height }: Rect): string {
  return `--x:${x};--y:${y};--width:${width};--height:${height}`;
}

export interface Border {
  path: number[]; // from the root to the split
  position: number; // between this part and the next one
  direction: Direction;
  both: Rect; // of the two parts together
  rect: Rect; // the line between them, without thickness
  before: string; // a view before it, and one behind it
  behind: string;
  share: number; // what the part before it has of the two, in percent
}

// Of the two parts at a border, in percent.
export const least_share = 10;
export const greatest_share = 100 - least_share;
const outer_share = 0.35; // of a view that comes to a side of the whole
const whole: Rect = { x: 0, y: 0, width: 1, height: 1 };

export function isSplit(layout: Layout): layout is Split {
  return "parts" in layout;
}

// In reading order.
export function viewsOf(layout: Layout): string[] {
  return isSplit(layout) ? layout.parts.flatMap((part) => viewsOf(part.layout)) : [layout.view];
}

// A split of one part is that part; a row in a row is one row.
function joined(direction: Direction, parts: Part[]): Layout {
  const [only] = parts;
  if (parts.length === 1 && only) return only.layout;
  const sum = parts.reduce((total, part) => total + part.share, 0);
  return {
    direction,
    parts: parts.flatMap(({ share, layout }) =>
      isSplit(layout) && layout.direction === direction
        ? layout.parts.map((inner) => ({ ...inner, share: (inner.share * share) / sum }))
        : [{ share: share / sum, layout }],
    ),
  };
}

// Nothing is left without the last view.
export function without(layout: Layout, view: string): Layout | undefined {
  if (!isSplit(layout)) return layout.view === view ? undefined : layout;
  const parts = layout.parts.flatMap((part) => {
    const rest = without(part.layout, view);
    return rest ? [{ share: part.share, layout: rest }] : [];
  });
  return parts.length > 0 ? joined(layout.direction, parts) : undefined;
}

function atSide(layout: Layout, view: string, side: Side, share: number): Layout {
  const fresh = { share, layout: { view } };
  const old = { share: 1 - share, layout };
  return joined(side === "left" || side === "right" ? "row" : "column", side === "left" || side === "above" ? [fresh, old] : [old, fresh]);
}

// The view comes to a side of another one, or of the whole; it leaves the place that it had.
export function place(layout: Layout, view: string, beside: string | null, side: Side): Layout {
  const rest = without(layout, view);
  if (!rest) return layout;
  if (beside === null) return atSide(rest, view, side, outer_share);
  const insert = (inner: Layout): Layout => {
    if (isSplit(inner)) return joined(inner.direction, inner.parts.map((part) => ({ ...part, layout: insert(part.layout) })));
    return inner.view === beside ? atSide(inner, view, side, 0.5) : inner;
  };
  return insert(rest);
}

// Each takes the other's place; of two of which one is not there, it comes in place of the other.
export function exchange(layout: Layout, one: string, other: string): Layout {
  if (isSplit(layout))
    return { ...layout, parts: layout.parts.map((part) => ({ ...part, layout: exchange(part.layout, one, other) })) };
  return layout.view === one ? { view: other } : layout.view === other ? { view: one } : layout;
}

function partRects(split: Split, rect: Rect): Rect[] {
  let from = 0;
  return split.parts.map(({ share }) => {
    const begin = from;
    from += share;
    return split.direction === "row"
      ? { ...rect, x: rect.x + begin * rect.width, width: share * rect.width }
      : { ...rect, y: rect.y + begin * rect.height, height: share * rect.height };
  });
}

export function rectsOf(layout: Layout, rect = whole): Map<string, Rect> {
  if (!isSplit(layout)) return new Map([[layout.view, rect]]);
  const rects = partRects(layout, rect);
  return new Map(layout.parts.flatMap((part, position) => [...rectsOf(part.layout, rects[position])]));
}

export function bordersOf(layout: Layout, rect = whole, path: number[] = []): Border[] {
  if (!isSplit(layout)) return [];
  const { direction, parts } = layout;
  const rects = partRects(layout, rect);
  return parts.flatMap((part, position) => {
    const own = rects[position] ?? rect;
    const next = parts[position + 1];
    const inner = bordersOf(part.layout, own, [...path, position]);
    if (!next) return inner;
    const share = part.share / (part.share + next.share);
    const border: Border = {
      path,
      position,
      direction,
      both: direction === "row" ? { ...own, width: own.width / share } : { ...own, height: own.height / share },
      rect: direction === "row" ? { ...own, x: own.x + own.width, width: 0 } : { ...own, y: own.y + own.height, height: 0 },
      before: viewsOf(part.layout).at(-1) ?? "",
      behind: viewsOf(next.layout)[0] ?? "",
      share: Math.round(100 * share),
    };
    return [...inner, border];
  });
}

// The part before the border gets this percentage of the two.
export function moveBorder(layout: Layout, path: number[], position: number, percent: number): Layout {
  if (!isSplit(layout)) return layout;
  const [into, ...rest] = path;
  const parts = [...layout.parts];
  if (into !== undefined) {
    const inner = parts[into];
    if (inner) parts[into] = { ...inner, layout: moveBorder(inner.layout, rest, position, percent) };
    return { ...layout, parts };
  }
  const before = parts[position];
  const behind = parts[position + 1];
  if (!before || !behind) return layout;
  const both = before.share + behind.share;
  const share = (Math.min(greatest_share, Math.max(least_share, percent)) / 100) * both;
  parts[position] = { ...before, share };
  parts[position + 1] = { ...behind, share: both - share };
  return { ...layout, parts };
}

// The view on that side with which it shares the longest border.
export function neighbour(layout: Layout, view: string, side: Side): string | undefined {
  const rects = rectsOf(layout);
  const own = rects.get(view);
  if (!own) return undefined;
  const shared = (a: number, a_size: number, b: number, b_size: number) => Math.min(a + a_size, b + b_size) - Math.max(a, b);
  const touches = (a: number, b: number) => Math.abs(a - b) < 1e-6;
  let found: string | undefined;
  let longest = 1e-6;
  for (const [name, rect] of rects) {
    const beside =
      side === "left"
        ? touches(rect.x + rect.width, own.x)
        : side === "right"
          ? touches(rect.x, own.x + own.width)
          : side === "above"
            ? touches(rect.y + rect.height, own.y)
            : touches(rect.y, own.y + own.height);
    const length =
      side === "left" || side === "right"
        ? shared(own.y, own.height, rect.y, rect.height)
        : shared(own.x, own.width, rect.x, rect.width);
    if (name === view || !beside || length <= longest) continue;
    found = name;
    longest = length;
  }
  return found;
}

// What was kept may be of another version of the page: views that are no longer there fall out.
export function readLayout(kept: unknown, names: readonly string[]): Layout | undefined {
  const seen = new Set<string>();
  const read = (value: unknown): Layout | undefined => {
    if (typeof value !== "object" || value === null) return undefined;
    const { view, direction, parts } = value as { view?: unknown; direction?: unknown; parts?: unknown };
    if (typeof view === "string") {
      if (!names.includes(view) || seen.has(view)) return undefined;
      seen.add(view);
      return { view };
    }
    if ((direction !== "row" && direction !== "column") || !Array.isArray(parts)) return undefined;
    const good = (parts as Partial<Part>[]).flatMap((part) => {
      const layout = read(part?.layout);
      return layout && typeof part.share === "number" && part.share > 0 ? [{ share: part.share, layout }] : [];
    });
    return good.length > 0 ? joined(direction, good) : undefined;
  };
  return read(kept);
}
