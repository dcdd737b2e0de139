// The table below a picture: the colour of each channel, its value at the pointer and at both cursors, and what is measured
// between them.
import { valueText, type Channel } from "./channel";
import type { CursorName } from "./control";
import { settling_band, type Measures } from "./measure";

export interface Readings {
  pointer_us: number | null;
  cursors: Record<CursorName, number | null>;
  active: CursorName;
  at: Record<"pointer" | CursorName, (number | null)[] | null>;
  measures: (Measures | null)[] | null; // null: none are wanted, or a cursor is missing
}

const measured = [
  ["min", "the least value between the cursors"],
  ["max", "the greatest value between the cursors"],
  ["mean", "the mean of every millisecond between the cursors"],
  ["overshoot", "how far it went beyond its last value, in % of the way from the first value to the last"],
  ["settling", `the time until it stays within ${settling_band * 100} % of that way around its last value`],
  ["frequency", "of its rises through the middle of min and max"],
] as const;

function timeText(us: number | null): string {
  return us === null ? "–" : `${(us / 1e6).toFixed(3)} s`;
}

function fixed(value: number | null | undefined, digits: number, unit: string): string {
  return value === null || value === undefined ? "–" : `${value.toFixed(digits)} ${unit}`;
}

function measureTexts(channel: Channel, of: Measures | null): string[] {
  if (!of) return measured.map(() => "–");
  if (channel.kind === "words" || channel.kind === "word") return measured.map(() => "");
  const hertz = of.period_ms === null ? null : 1000 / of.period_ms;
  return [
    valueText(channel, of.least),
    valueText(channel, of.greatest),
    of.mean.toFixed(Math.min(6, channel.decimals + 2)),
    fixed(of.overshoot_percent, 2, "%"),
    fixed(of.settling_ms, 0, "ms"),
    hertz === null ? "–" : `${hertz.toPrecision(4)} Hz`,
  ];
}

export class Legend {
  private rows: HTMLTableCellElement[][] = [];
  private readonly time: HTMLTableCellElement[];
  private readonly buttons: Record<CursorName, HTMLButtonElement>;
  private readonly table = document.createElement("table");
  private readonly body: HTMLTableSectionElement;

  constructor(root: HTMLElement, onCursor: (name: CursorName) => void) {
    root.tabIndex = 0;
    root.setAttribute("role", "region");
    root.setAttribute("aria-label", "Values and measurements");
    root.classList.add("legend");
    this.table.className = "readings";
    this.table.setAttribute("aria-label", "Readings");
    const head = this.table.createTHead().insertRow();
    const add = (text: string, title = "") => {
      const cell = document.createElement("th");
      cell.scope = "col";
      cell.textContent = text;
      cell.title = title;
      head.append(cell);
      return cell;
    };
    const button = (name: CursorName) => {
      const one = document.createElement("button");
      one.className = "small";
      one.textContent = name;
      one.setAttribute("aria-label", `Cursor ${name}`);
      one.title = `A click in the picture puts ${name}; again to take it away`;
      one.addEventListener("click", () => onCursor(name));
      add("").append(one);
      return one;
    };
    add("Channel");
    add("pointer");
    this.buttons = { A: button("A"), B: button("B") };
    add("B − A");
    for (const [text, title] of measured) add(text, title).className = "measured";
    this.body = this.table.createTBody();
    this.time = this.row("time");
    root.replaceChildren(this.table);
  }

  private row(name: string, colour = "", unit = ""): HTMLTableCellElement[] {
    const row = this.body.insertRow();
    const head = document.createElement("th");
    head.scope = "row";
    if (colour) {
      const swatch = document.createElement("span");
      swatch.className = "swatch";
      swatch.style.background = colour;
      head.append(swatch, " ");
    }
    head.append(name);
    if (unit) {
      const quiet = document.createElement("span");
      quiet.className = "quiet";
      quiet.textContent = ` ${unit}`;
      head.append(quiet);
    }
    row.append(head);
    return Array.from({ length: 4 + measured.length }, (_, n) => {
      const cell = row.insertCell();
      if (n >= 4) cell.className = "measured";
      return cell;
    });
  }

  setChannels(channels: Channel[]): void {
    while (this.body.rows.length > 1) this.body.deleteRow(1);
    this.rows = channels.map((channel, n) => this.row(channel.name, `var(--s${(n % 8) + 1})`, channel.unit));
  }

  show(channels: Channel[], readings: Readings): void {
    if (this.rows.length !== channels.length) this.setChannels(channels);
    const { A, B } = readings.cursors;
    for (const name of ["A", "B"] as const) this.buttons[name].setAttribute("aria-pressed", String(readings.active === name));
    this.table.classList.toggle("measures", readings.measures !== null);
    const between = A !== null && B !== null ? (B - A) / 1e6 : null;
    const put = (cells: HTMLTableCellElement[], texts: string[]) =>
      texts.forEach((text, n) => {
        const cell = cells[n];
        if (cell && cell.textContent !== text) cell.textContent = text;
      });
    put(this.time, [
      timeText(readings.pointer_us),
      timeText(A),
      timeText(B),
      between === null ? "–" : `${between.toFixed(3)} s${between ? ` ${(1 / Math.abs(between)).toPrecision(4)} Hz` : ""}`,
    ]);
    channels.forEach((channel, n) => {
      const a = readings.at.A?.[n] ?? null;
      const b = readings.at.B?.[n] ?? null;
      const isNumber = channel.kind === undefined || channel.kind === "curve" || channel.kind === "level";
      const texts = [
        valueText(channel, readings.at.pointer?.[n]),
        valueText(channel, a),
        valueText(channel, b),
        isNumber && a !== null && b !== null ? valueText(channel, b - a) : "–",
      ];
      if (readings.measures) texts.push(...measureTexts(channel, readings.measures[n] ?? null));
      put(this.rows[n] ?? [], texts);
    });
  }
}
