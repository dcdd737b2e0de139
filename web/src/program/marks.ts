// What belongs to the compiled text and is shown in the edited one: running lines, coverage, breakpoints, values. Lines are
// those of the compiled text; they follow what is typed.
import { ChangeSet, RangeSet, RangeSetBuilder, StateEffect, StateField, Text, type EditorState, type Extension } from "@codemirror/state";
import { Decoration, EditorView, gutter, GutterMarker, ViewPlugin, WidgetType, type DecorationSet, type ViewUpdate } from "@codemirror/view";

import type { Breakpoint, TaskState } from "../server/protocol";

export interface Marks {
  lines: readonly number[]; // with commands
  covered: ReadonlySet<number>;
  here: readonly TaskState[];
  points: readonly Breakpoint[];
}

const no_marks: Marks = { lines: [], covered: new Set(), here: [], points: [] };
export const setMarks = StateEffect.define<Marks>();
export const setCompiled = StateEffect.define<string>();
export const setValues = StateEffect.define<Values>();

export interface Values {
  texts: ReadonlyMap<string, string>;
  changed: ReadonlySet<string>; // lately
}

interface Compiled {
  text: Text;
  changes: ChangeSet; // from it to what stands in the editor
}

const textOf = (text: string): Text => Text.of(text.split(/\r?\n/));

// One change that has all that differs.
function difference(from: Text, to: Text): ChangeSet {
  const a = from.toString();
  const b = to.toString();
  const shorter = Math.min(a.length, b.length);
  let head = 0;
  while (head < shorter && a[head] === b[head]) ++head;
  let tail = 0;
  while (tail < shorter - head && a[a.length - 1 - tail] === b[b.length - 1 - tail]) ++tail;
  if (head === a.length && a.length === b.length) return ChangeSet.empty(a.length);
  return ChangeSet.of({ from: head, to: a.length - tail, insert: b.slice(head, b.length - tail) }, a.length);
}

const compiled = StateField.define<Compiled>({
  create: (state) => ({ text: state.doc, changes: ChangeSet.empty(state.doc.length) }),
  update(value, transaction) {
    let next = transaction.docChanged ? { text: value.text, changes: value.changes.compose(transaction.changes) } : value;
    for (const effect of transaction.effects)
      if (effect.is(setCompiled)) {
        const text = textOf(effect.value);
        if (!text.eq(next.text)) next = { text, changes: difference(text, transaction.newDoc) };
      }
    return next;
  },
});

const marks = StateField.define<Marks>({
  create: () => no_marks,
  update(value, transaction) {
    for (const effect of transaction.effects) if (effect.is(setMarks)) return effect.value;
    return value;
  },
});

const values = StateField.define<Values>({
  create: () => ({ texts: new Map(), changed: new Set() }),
  update(value, transaction) {
    for (const effect of transaction.effects) if (effect.is(setValues)) return effect.value;
    return value;
  },
});

export function runsThisText(state: EditorState): boolean {
  return state.field(compiled).text.eq(state.doc);
}

// The line in the editor where a line of the compiled text is by now; 0: it is gone.
export function shownLine(state: EditorState, line: number): number {
  const { text, changes } = state.field(compiled);
  if (line < 1 || line > text.lines) return 0;
  return state.doc.lineAt(changes.mapPos(text.line(line).to, -1)).number;
}

export function compiledLine(state: EditorState, line: number): number {
  const { text, changes } = state.field(compiled);
  return text.lineAt(Math.min(text.length, changes.invertedDesc.mapPos(state.doc.line(line).to, -1))).number;
}

export function valueOf(state: EditorState, name: string): string | undefined {
  return state.field(values).texts.get(name);
}

class Point extends GutterMarker {
  constructor(
    readonly line: number,
    readonly set: Breakpoint | undefined,
  ) {
    super();
  }
  override eq(other: GutterMarker): boolean {
    return other instanceof Point && other.line === this.line && other.set?.number === this.set?.number && other.set?.hits === this.set?.hits;
  }
  override toDOM(): HTMLElement {
    const button = document.createElement("button");
    button.className = "point";
    button.tabIndex = -1; // F9 does the same at the line of the cursor
    button.setAttribute("aria-label", `Breakpoint in line ${this.line}`);
    button.setAttribute("aria-pressed", String(this.set !== undefined));
    if (this.set) button.title = `${this.set.hits} hits`;
    return button;
  }
}

class Standing extends GutterMarker {
  constructor(
    readonly text: string,
    readonly face: string,
  ) {
    super();
    this.elementClass = face;
  }
  override eq(other: GutterMarker): boolean {
    return other instanceof Standing && other.text === this.text && other.face === this.face;
  }
  override toDOM(): HTMLElement {
    const span = document.createElement("span");
    span.textContent = this.text;
    return span;
  }
}

interface Rows {
  points: RangeSet<GutterMarker>;
  standing: RangeSet<GutterMarker>;
  here: DecorationSet;
}

function rowsOf(state: EditorState): Rows {
  const shown = state.field(marks);
  const executable = new Map<number, boolean>(); // by line in the editor: covered
  for (const line of shown.lines) {
    const at = shownLine(state, line);
    if (at) executable.set(at, (executable.get(at) ?? false) || shown.covered.has(line));
  }
  const points = new Map(shown.points.map((point) => [shownLine(state, point.line), point]));
  const here = new Map<number, string>();
  for (const task of shown.here) {
    const at = shownLine(state, task.line ?? 0);
    if (at) here.set(at, `${here.get(at) ?? ""}▶${task.task}`);
  }
  const point_rows = new RangeSetBuilder<GutterMarker>();
  const standing_rows = new RangeSetBuilder<GutterMarker>();
  const here_rows = new RangeSetBuilder<Decoration>();
  for (const line of [...new Set([...executable.keys(), ...points.keys(), ...here.keys()])].sort((a, b) => a - b)) {
    const { from } = state.doc.line(line);
    point_rows.add(from, from, new Point(line, points.get(line)));
    const face = executable.has(line) ? (executable.get(line) ? "covered" : "missed") : "";
    standing_rows.add(from, from, new Standing(here.get(line) ?? "", face));
    if (here.has(line)) here_rows.add(from, from, Decoration.line({ class: "here", attributes: { "aria-current": "step" } }));
  }
  return { points: point_rows.finish(), standing: standing_rows.finish(), here: here_rows.finish() };
}

const rows = StateField.define<Rows>({
  create: rowsOf,
  update: (value, transaction) =>
    transaction.docChanged || transaction.effects.some((effect) => effect.is(setMarks) || effect.is(setCompiled)) ? rowsOf(transaction.state) : value,
  provide: (field) => EditorView.decorations.from(field, (value) => value.here),
});

// --- values behind the lines that read them ---

const name_pattern = /[A-Za-z_]\w*(?:\.\w+|\[\d+\])*/g;

export function namesIn(text: string): string[] {
  return text.replace(/\/\/.*|"[^"]*"/g, "").match(name_pattern) ?? [];
}

class Behind extends WidgetType {
  constructor(
    readonly parts: readonly { name: string; text: string; changed: boolean }[],
  ) {
    super();
  }
  override eq(other: Behind): boolean {
    return JSON.stringify(other.parts) === JSON.stringify(this.parts);
  }
  override toDOM(): HTMLElement {
    const all = document.createElement("span");
    all.className = "values";
    for (const part of this.parts) {
      const one = document.createElement("span");
      one.textContent = `${part.name} ${part.text}`;
      if (part.changed) one.className = "changed";
      all.append(one);
    }
    return all;
  }
}

const behind = ViewPlugin.fromClass(
  class {
    decorations: DecorationSet;
    constructor(view: EditorView) {
      this.decorations = this.build(view);
    }
    update(update: ViewUpdate) {
      if (update.docChanged || update.viewportChanged || update.transactions.some((one) => one.effects.some((effect) => effect.is(setValues))))
        this.decorations = this.build(update.view);
    }
    build(view: EditorView): DecorationSet {
      const { texts, changed } = view.state.field(values);
      const all = new RangeSetBuilder<Decoration>();
      if (texts.size === 0) return all.finish();
      for (const { from, to } of view.visibleRanges)
        for (let at = from; at <= to; ) {
          const line = view.state.doc.lineAt(at);
          const parts = [...new Set(namesIn(line.text))]
            .filter((name) => texts.has(name))
            .map((name) => ({ name, text: texts.get(name) ?? "", changed: changed.has(name) }));
          if (parts.length) all.add(line.to, line.to, Decoration.widget({ widget: new Behind(parts), side: 1 }));
          at = line.to + 1;
        }
      return all.finish();
    }
  },
  { decorations: (plugin) => plugin.decorations },
);

// `toggle`: sets or clears the breakpoint of a line in the editor.
export function markExtensions(toggle: (view: EditorView, line: number) => void): Extension {
  const none = new Standing("", "");
  return [
    compiled,
    marks,
    values,
    rows,
    behind,
    gutter({
      class: "points",
      markers: (view) => view.state.field(rows).points,
      domEventHandlers: {
        click(view, block, event) {
          if (!(event.target instanceof HTMLButtonElement)) return false;
          toggle(view, view.state.doc.lineAt(block.from).number);
          return true;
        },
      },
    }),
    gutter({ class: "standing", markers: (view) => view.state.field(rows).standing, initialSpacer: () => none }),
  ];
}

export function pointAt(state: EditorState, line: number): Breakpoint | undefined {
  return state.field(marks).points.find((point) => shownLine(state, point.line) === line);
}
