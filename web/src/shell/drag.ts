// A view that is dragged by its title or its tab: where it would come to, and that it comes there when it is let go.
import { signal } from "@preact/signals";

import { activeView, layout, move, paneOf, severalOpen, takePlace } from "./desk";
import { rectsOf, type Rect, type Side } from "./layout";

interface Zone {
  beside: string | null; // null: a side of the whole
  side: Side | "middle";
  rect: Rect;
}

const least_way = 6; // pixels, before it is a drag and no click
const rim = 0.02; // of the whole, at its edges
const edge = 0.28; // of a view

export const dropZone = signal<Rect | null>(null);

function half(rect: Rect, side: Side, share: number): Rect {
  const { x, y, width, height } = rect;
  switch (side) {
    case "left":
      return { x, y, width: width * share, height };
    case "right":
      return { x: x + width * (1 - share), y, width: width * share, height };
    case "above":
      return { x, y, width, height: height * share };
    case "below":
      return { x, y: y + height * (1 - share), width, height: height * share };
  }
}

// The side that is nearest, if it is near enough.
function nearestSide(x: number, y: number, within: number): Side | undefined {
  const ways: [Side, number][] = [
    ["left", x],
    ["right", 1 - x],
    ["above", y],
    ["below", 1 - y],
  ];
  const [side, way] = ways.reduce((best, one) => (one[1] < best[1] ? one : best));
  return way <= within ? side : undefined;
}

function zoneAt(x: number, y: number, view: string): Zone | undefined {
  if (x < 0 || y < 0 || x > 1 || y > 1) return undefined;
  const outer = severalOpen.peek() ? nearestSide(x, y, rim) : undefined;
  if (outer) return { beside: null, side: outer, rect: half({ x: 0, y: 0, width: 1, height: 1 }, outer, 0.35) };
  for (const [beside, rect] of rectsOf(layout.peek())) {
    const inner_x = (x - rect.x) / rect.width;
    const inner_y = (y - rect.y) / rect.height;
    if (inner_x < 0 || inner_y < 0 || inner_x > 1 || inner_y > 1) continue;
    if (beside === view) return undefined;
    const side = nearestSide(inner_x, inner_y, edge);
    return side ? { beside, side, rect: half(rect, side, 0.5) } : { beside, side: "middle", rect };
  }
  return undefined;
}

// From pointerdown on. A touch on a tab scrolls the tabs, so it drags nothing there.
export function startDrag(event: PointerEvent, view: string): void {
  const handle = event.currentTarget;
  const desk = paneOf(activeView.peek())?.parentElement;
  if (!(handle instanceof HTMLElement) || !desk || event.button !== 0) return;
  let zone: Zone | undefined;
  let dragging = false;
  const follow = (at: PointerEvent) => {
    if (!dragging && Math.hypot(at.clientX - event.clientX, at.clientY - event.clientY) < least_way) return;
    if (!dragging) handle.setPointerCapture(event.pointerId);
    dragging = true;
    const box = desk.getBoundingClientRect();
    zone = zoneAt((at.clientX - box.left) / box.width, (at.clientY - box.top) / box.height, view);
    dropZone.value = zone?.rect ?? null;
  };
  const end = () => {
    document.removeEventListener("pointermove", follow);
    document.removeEventListener("pointerup", drop);
    document.removeEventListener("pointercancel", end);
    document.removeEventListener("keydown", giveUp, true);
    dropZone.value = null;
  };
  const drop = () => {
    end();
    if (!dragging) return;
    // The click that follows is no click on the tab.
    handle.addEventListener("click", swallow, { capture: true, once: true });
    setTimeout(() => handle.removeEventListener("click", swallow, true));
    if (!zone) return;
    if (zone.side !== "middle") move(view, zone.beside, zone.side);
    else if (zone.beside !== null) takePlace(view, zone.beside);
  };
  const giveUp = (key: KeyboardEvent) => {
    if (key.key !== "Escape") return;
    key.preventDefault();
    end();
  };
  document.addEventListener("pointermove", follow);
  document.addEventListener("pointerup", drop);
  document.addEventListener("pointercancel", end);
  document.addEventListener("keydown", giveUp, true);
}

function swallow(event: Event): void {
  event.stopImmediatePropagation();
  event.preventDefault();
}
