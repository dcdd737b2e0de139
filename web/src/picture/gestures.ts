// Mouse, fingers and keys on a picture. Mouse: drag zooms, with the right button or Alt it moves, a click puts the active
// cursor, with Shift the other one, a drag that begins at a cursor moves it; the wheel zooms, with Shift it moves. One
// finger moves, two zoom. Keys: arrows move the cursor, + and - zoom, page keys move, Home shows all.
import { moveBy, moveCursor, zoomBy, type Control, type CursorName } from "./control";

const still_px = 4; // less is a click
const near_px = 7; // of a cursor

export interface Ground {
  element: HTMLElement;
  timeAt(x: number): number; // of a place in the element, us
  placeOf(us: number): number;
  select(from: number, to: number): void; // shows what would be zoomed to; equal: nothing
  point(us: number | null): void; // the pointer is there
}

type Drag = { kind: "zoom" | "move" | "cursor"; begin: number; last: number; moved: boolean; cursor: CursorName };

export function listenToHands(ground: Ground, control: Control): () => void {
  const { element } = ground;
  const fingers = new Map<number, number>(); // where they are
  let drag: Drag | null = null;
  const x = (event: MouseEvent) => event.clientX - element.getBoundingClientRect().left;

  const cursorNear = (place: number): CursorName | null => {
    const cursors = control.cursors();
    for (const name of ["A", "B"] as const) {
      const us = cursors[name];
      if (us !== null && Math.abs(ground.placeOf(us) - place) < near_px) return name;
    }
    return null;
  };
  const pinch = (before: number[], after: number[]) => {
    const [a, b] = before as [number, number];
    const [c, d] = after as [number, number];
    if (Math.abs(d - c) < 8 || Math.abs(b - a) < 8) return;
    // What was under a finger stays under it.
    const { from_us, to_us } = control.window();
    const scale = (b - a) / (d - c);
    const from = ground.timeAt(a) - ((c - ground.placeOf(from_us)) * (ground.timeAt(b) - ground.timeAt(a))) / (d - c);
    control.zoomTo(from, from + (to_us - from_us) * Math.abs(scale));
  };

  const down = (event: PointerEvent) => {
    if (event.button > 2) return;
    element.focus({ preventScroll: true });
    const at = x(event);
    fingers.set(event.pointerId, at);
    try {
      element.setPointerCapture(event.pointerId);
    } catch {
      // a pointer of a test is none of the browser's
    }
    const cursor = event.pointerType === "mouse" && event.button === 0 && !event.shiftKey ? cursorNear(at) : null;
    const moves = event.pointerType !== "mouse" || event.button !== 0 || event.altKey;
    drag = { kind: cursor ? "cursor" : moves ? "move" : "zoom", begin: at, last: at, moved: false, cursor: cursor ?? "A" };
  };
  const move = (event: PointerEvent) => {
    const at = x(event);
    if (event.pointerType === "mouse") ground.point(ground.timeAt(at));
    if (!fingers.has(event.pointerId) || !drag) return;
    if (fingers.size === 2) {
      const before = [...fingers.values()];
      fingers.set(event.pointerId, at);
      drag.moved = true;
      return pinch(before, [...fingers.values()]);
    }
    fingers.set(event.pointerId, at);
    if (Math.abs(at - drag.begin) >= still_px) drag.moved = true;
    if (!drag.moved) return;
    if (drag.kind === "cursor") control.put(drag.cursor, ground.timeAt(at));
    if (drag.kind === "zoom") ground.select(drag.begin, at);
    if (drag.kind === "move") moveBy(control, ground.timeAt(drag.last) - ground.timeAt(at));
    drag.last = at;
  };
  const up = (event: PointerEvent) => {
    if (!fingers.delete(event.pointerId) || fingers.size > 0 || !drag) return;
    const done = drag;
    drag = null;
    ground.select(0, 0);
    const at = x(event);
    if (event.type === "pointercancel") return;
    if (!done.moved) {
      const other = control.active() === "A" ? "B" : "A";
      control.put(event.shiftKey ? other : control.active(), ground.timeAt(at));
    } else if (done.kind === "zoom") {
      const [from, to] = [ground.timeAt(Math.min(done.begin, at)), ground.timeAt(Math.max(done.begin, at))];
      control.zoomTo(from, to);
    }
  };
  const wheel = (event: WheelEvent) => {
    event.preventDefault();
    const { from_us, to_us } = control.window();
    const by = event.shiftKey ? event.deltaY || event.deltaX : event.deltaX;
    if (by !== 0) moveBy(control, (Math.sign(by) * (to_us - from_us)) / 10);
    else zoomBy(control, event.deltaY > 0 ? 1.25 : 0.8, ground.timeAt(x(event)));
  };
  const key = (event: KeyboardEvent) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const { from_us, to_us } = control.window();
    const at = control.cursors()[control.active()] ?? undefined;
    const inside = at !== undefined && at >= from_us && at <= to_us ? at : undefined;
    const ms = event.shiftKey ? 10 : 1;
    if (event.key === "ArrowLeft") moveCursor(control, -ms);
    else if (event.key === "ArrowRight") moveCursor(control, ms);
    else if (event.key === "+") zoomBy(control, 0.5, inside);
    else if (event.key === "-") zoomBy(control, 2, inside);
    else if (event.key === "PageUp") moveBy(control, (from_us - to_us) / 2);
    else if (event.key === "PageDown") moveBy(control, (to_us - from_us) / 2);
    else if (event.key === "Home") control.all();
    else return;
    event.preventDefault();
    event.stopPropagation();
  };
  const leave = () => ground.point(null);
  const all = () => control.all();
  const menu = (event: Event) => event.preventDefault(); // the right button moves

  element.addEventListener("pointerdown", down);
  element.addEventListener("pointermove", move);
  element.addEventListener("pointerup", up);
  element.addEventListener("pointercancel", up);
  element.addEventListener("pointerleave", leave);
  element.addEventListener("wheel", wheel, { passive: false });
  element.addEventListener("dblclick", all);
  element.addEventListener("contextmenu", menu);
  element.addEventListener("keydown", key);
  return () => {
    element.removeEventListener("pointerdown", down);
    element.removeEventListener("pointermove", move);
    element.removeEventListener("pointerup", up);
    element.removeEventListener("pointercancel", up);
    element.removeEventListener("pointerleave", leave);
    element.removeEventListener("wheel", wheel);
    element.removeEventListener("dblclick", all);
    element.removeEventListener("contextmenu", menu);
    element.removeEventListener("keydown", key);
  };
}
