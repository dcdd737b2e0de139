// Where the views were scrolled to. An element that moves in the document forgets it, and so does a view that is left.

interface Spot {
  path: number[]; // from the pane to the element, by position among its siblings
  top: number;
  left: number;
}

const again_ms = 100;
const patience_ms = 3000;

const left = new Map<string, Spot[]>();

function isScrolled(element: Element): boolean {
  return element.scrollTop !== 0 || element.scrollLeft !== 0;
}

function pathTo(element: Element, pane: Element): number[] {
  const path: number[] = [];
  for (let at = element; at !== pane && at.parentElement; at = at.parentElement)
    path.unshift([...at.parentElement.children].indexOf(at));
  return path;
}

// Notes every element that is scrolled; what comes back puts them there again after they have moved.
export function noteScrolls(panes: Iterable<HTMLElement>): () => void {
  const spots: { element: Element; top: number; left: number }[] = [];
  for (const pane of panes)
    for (const element of [pane, ...pane.querySelectorAll("*")])
      if (isScrolled(element)) spots.push({ element, top: element.scrollTop, left: element.scrollLeft });
  return () => {
    for (const spot of spots) {
      if (spot.element.scrollTop !== spot.top) spot.element.scrollTop = spot.top;
      if (spot.element.scrollLeft !== spot.left) spot.element.scrollLeft = spot.left;
    }
  };
}

export function leave(view: string, pane: Element): void {
  left.set(
    view,
    [pane, ...pane.querySelectorAll("*")]
      .filter(isScrolled)
      .map((element) => ({ path: pathTo(element, pane), top: element.scrollTop, left: element.scrollLeft })),
  );
}

// The rows of a view may come later; who scrolls meanwhile is left alone.
export function comeBack(view: string, pane: HTMLElement): () => void {
  let missing = left.get(view) ?? [];
  const until = performance.now() + patience_ms;
  let timer: ReturnType<typeof setTimeout> | undefined;
  const touched = ["wheel", "pointerdown", "keydown"] as const;
  const stop = () => {
    clearTimeout(timer);
    missing = [];
    for (const kind of touched) pane.removeEventListener(kind, stop);
  };
  const look = () => {
    missing = missing.filter((spot) => {
      const element = spot.path.reduce<Element | undefined>((at, position) => at?.children[position], pane);
      if (!element) return true;
      element.scrollTop = spot.top;
      element.scrollLeft = spot.left;
      return Math.abs(element.scrollTop - spot.top) > 1;
    });
    if (missing.length > 0 && performance.now() < until) timer = setTimeout(look, again_ms);
    else stop();
  };
  if (missing.length > 0) {
    for (const kind of touched) pane.addEventListener(kind, stop);
    look();
  }
  return stop;
}
