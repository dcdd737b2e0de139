// Whose the window and the cursors of a picture are: it asks for them and says what a person wants of them.

export interface Window {
  from_us: number;
  to_us: number;
}
export type CursorName = "A" | "B";
export type Cursors = Record<CursorName, number | null>;

export interface Control {
  window(): Window;
  cursors(): Cursors;
  active(): CursorName;
  zoomTo(from_us: number, to_us: number): void;
  all(): void; // everything again, or the newest part
  put(name: CursorName, us: number | null): void;
}

export interface Mark {
  us: number;
  text: string;
  colour: string; // a variable of colours.css
}
// What happened on a line at these moments.
export interface Track {
  name: string;
  times_us: number[];
}

export function zoomBy(control: Control, factor: number, at_us?: number): void {
  const { from_us, to_us } = control.window();
  const at = at_us ?? (from_us + to_us) / 2;
  control.zoomTo(at - (at - from_us) * factor, at + (to_us - at) * factor);
}

export function moveBy(control: Control, by_us: number): void {
  const { from_us, to_us } = control.window();
  control.zoomTo(from_us + by_us, to_us + by_us);
}

// From the middle of the picture where it is not there yet.
export function moveCursor(control: Control, by_ms: number): void {
  const { from_us, to_us } = control.window();
  const at = control.cursors()[control.active()];
  const us = at === null ? Math.round((from_us + to_us) / 2000) * 1000 : at + by_ms * 1000;
  control.put(control.active(), Math.max(0, us));
  if (us < from_us || us > to_us) moveBy(control, us - (from_us + to_us) / 2);
}
