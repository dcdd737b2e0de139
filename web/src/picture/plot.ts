// A recording as a whole: the picture of the scope with its buttons, one channel against another, and the table of values at the
// cursors. The page of a plot is nothing else, and the workbench shows a trace that is opened so.
import type { Channel } from "./channel";
import type { Control, CursorName, Cursors, Mark, Track } from "./control";
import { Legend } from "./legend";
import { measure } from "./measure";
import { Picture } from "./picture";
import { ms_us, thin, type Samples } from "./points";
import { drawPlane } from "./xy";

export interface RecordedChannel extends Channel {
  binary: boolean;
}
export interface Recorded {
  title: string;
  begin: number; // ms of the first sample
  end: number;
  samples: Samples; // as the signals
  signals: RecordedChannel[];
  events: { time: number; text: string; fault: boolean }[]; // ms
  tracks: { name: string; times: number[] }[];
}

const shown_around_ms = 500;

export function element<Name extends keyof HTMLElementTagNameMap>(name: Name, text = "", parent?: HTMLElement): HTMLElementTagNameMap[Name] {
  const made = document.createElement(name);
  made.textContent = text;
  parent?.append(made);
  return made;
}

export class Plot implements Control {
  private readonly whole: { from_us: number; to_us: number };
  private shown: { from_us: number; to_us: number };
  private at: Cursors = { A: null, B: null };
  private chosen: CursorName = "A";
  private pointer: number | null = null;
  private readonly samples: Samples;
  private readonly channels: Channel[];
  private readonly picture: Picture;
  private readonly legend: Legend;
  private readonly plane = document.createElement("canvas");
  private readonly root: HTMLElement;
  private readonly axes: [HTMLSelectElement, HTMLSelectElement];

  // In an element of its own, which takes the keys.
  constructor(
    data: Recorded,
    private readonly place: HTMLElement,
  ) {
    this.samples = data.samples;
    this.channels = data.signals.map((signal) => (signal.binary && signal.kind !== "word" ? { ...signal, kind: "level" } : signal));
    const from_us = data.begin > 1 ? data.begin * 1000 : 0;
    this.whole = this.shown = { from_us, to_us: Math.max(from_us + ms_us, data.end * 1000) };
    const head = element("header", "", place);
    element("h1", data.title, head);
    const all = element("button", "All", head);
    all.title = "The whole recording (Home)";
    all.addEventListener("click", () => this.all());
    const xy = element("label", "XY ", head);
    this.axes = [element("select", "", xy), element("select", "", xy)];
    this.axes[0].setAttribute("aria-label", "X channel");
    this.axes[1].setAttribute("aria-label", "Y channel");
    for (const [n, axis] of this.axes.entries()) {
      axis.append(new Option(n === 0 ? "against time" : "–", ""), ...this.channels.map((one, at) => new Option(one.name, String(at))));
      axis.addEventListener("change", () => this.draw());
    }
    element("span", "drag or wheel: zoom, right button or finger: move, click: cursor, Shift+click: the other, keys: arrows + - Home", head).className = "quiet";
    const main = element("main", "", place);
    const root = element("div", "", main);
    root.className = "picture";
    main.append(this.plane);
    const table = element("div", "", main);
    this.legend = new Legend(table, (name) => this.choose(name));
    this.picture = new Picture(root, this);
    this.picture.onPointer = (us) => {
      this.pointer = us;
      this.read();
    };
    const marks: Mark[] = data.events.map((event) => ({ us: event.time * 1000, text: event.text, colour: event.fault ? "--bad" : "--quiet" }));
    const tracks: Track[] = data.tracks.map((track) => ({ name: track.name, times_us: track.times.map((time) => time * 1000) }));
    this.picture.setMarks(marks);
    this.picture.show(this.channels, [], tracks);
    this.picture.onWidth = () => requestAnimationFrame(() => this.draw());
    this.draw();
    this.root = root;
  }

  // Keys that nobody else takes.
  key(event: KeyboardEvent): void {
    this.root.dispatchEvent(new KeyboardEvent("keydown", event));
  }
  goTo(ms: number): void {
    this.zoomTo((ms - shown_around_ms) * ms_us, (ms + shown_around_ms) * ms_us);
    this.put("A", ms * ms_us);
  }

  // --- Control ---
  window() {
    return this.shown;
  }
  cursors() {
    return this.at;
  }
  active() {
    return this.chosen;
  }
  zoomTo(from_us: number, to_us: number): void {
    const length = this.whole.to_us - this.whole.from_us;
    const span = Math.min(length, Math.max(Math.min(length, 5 * ms_us), to_us - from_us));
    const from = Math.max(this.whole.from_us, Math.min(this.whole.to_us - span, from_us));
    this.shown = { from_us: from, to_us: from + span };
    this.draw();
  }
  all(): void {
    this.shown = this.whole;
    this.draw();
  }
  put(name: CursorName, us: number | null): void {
    const last = this.samples.first_us + ((this.samples.values[0]?.length ?? 0) - 1) * ms_us;
    this.at = { ...this.at, [name]: us === null ? null : Math.max(this.samples.first_us, Math.min(last, Math.round(us / ms_us) * ms_us)) };
    this.chosen = name;
    this.picture.redraw();
    this.read();
  }
  private choose(name: CursorName): void {
    const { from_us, to_us } = this.shown;
    if (this.chosen === name || this.at[name] === null) this.put(name, this.at[name] === null ? from_us + (to_us - from_us) * (name === "A" ? 0.4 : 0.6) : null);
    this.chosen = name;
    this.read();
  }

  // --- showing ---
  private draw(): void {
    const words = this.channels.map((channel) => channel.kind === "word");
    const most = Math.max(200, Math.min(4096, this.place.clientWidth));
    this.picture.setPoints(thin(this.samples, words, this.shown.from_us, this.shown.to_us, most));
    const [x, y] = this.axes.map((axis) => (axis.value === "" ? -1 : Number(axis.value))) as [number, number];
    this.plane.hidden = x < 0 || y < 0;
    if (!this.plane.hidden)
      drawPlane(this.plane, Math.min(760, this.place.clientWidth - 24), 420, {
        x: this.channels[x] as Channel, y: this.channels[y] as Channel,
        xs: this.part(x, this.shown.from_us, this.shown.to_us), ys: this.part(y, this.shown.from_us, this.shown.to_us),
      });
    this.read();
  }
  private index(us: number): number {
    return Math.round((us - this.samples.first_us) / ms_us);
  }
  private part(channel: number, from_us: number, to_us: number): Float64Array {
    return (this.samples.values[channel] as Float64Array).subarray(Math.max(0, this.index(from_us)), this.index(to_us) + 1);
  }
  private valuesAt(us: number | null): (number | null)[] | null {
    return us === null ? null : this.samples.values.map((values) => values[this.index(us)] ?? null);
  }
  private read(): void {
    const { A, B } = this.at;
    const between = A !== null && B !== null ? ([Math.min(A, B), Math.max(A, B)] as const) : null;
    this.legend.show(this.channels, {
      pointer_us: this.pointer,
      cursors: this.at,
      active: this.chosen,
      at: { pointer: this.valuesAt(this.pointer), A: this.valuesAt(A), B: this.valuesAt(B) },
      measures: between && this.channels.map((_, n) => measure(this.part(n, between[0], between[1]))),
    });
  }
}
