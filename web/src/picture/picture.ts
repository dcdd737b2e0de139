// The one picture of curves: panels by unit, lanes for bits and words, the axis of time, cursors and marks over all. The
// scope of the page, plots and reports draw with it. It keeps nothing: who owns it gives it channels, points and marks,
// and a Control that knows the window and the cursors.
import { lanesOf, panelsOf, type Channel, type Lane, type Place } from "./channel";
import type { Control, Mark, Track } from "./control";
import { ticks } from "./axis";
import { listenToHands } from "./gestures";
import { axis_height, drawLanes, font, laneHeight, lanesHeight, type Area, type Ink } from "./lanes";
import { DrawnPanel, right_margin, scaleOf } from "./panel";
import { emptyPoints, type Points } from "./points";

const least_left = 34;
const least_panel = 160; // its curves can be read; where all of it does not fit, the picture grows
const label_rows = 2;
const label_height = 13;

export class Picture {
  onPointer: (us: number | null) => void = () => undefined;
  onWidth: (pixels: number) => void = () => undefined;
  private channels: Channel[] = [];
  private places: Place[] = [];
  private points: Points = emptyPoints(0);
  private marks: Mark[] = [];
  private present: number | null = null;
  private tracks: Track[] = [];
  private panels: DrawnPanel[] = [];
  private lanes: Lane[] = [];
  private left = least_left;
  private width = 0;
  private wanted = 0; // height
  private pointer: number | null = null;
  private selected: [number, number] = [0, 0];
  private readonly plots = document.createElement("div");
  private readonly laneCanvas = document.createElement("canvas");
  private readonly over = document.createElement("canvas");
  private readonly stop: () => void;
  private readonly observer: ResizeObserver;
  private readonly theme = matchMedia("(prefers-color-scheme: light)");
  private readonly rebuild = () => this.build();

  constructor(
    private readonly root: HTMLElement,
    private readonly control: Control,
  ) {
    root.tabIndex = 0;
    root.setAttribute("role", "group");
    root.setAttribute("aria-label", "Curves: arrows move the cursor, + and - zoom, Home shows all");
    this.over.className = "over";
    root.append(this.plots, this.laneCanvas, this.over);
    this.stop = listenToHands(
      {
        element: root,
        timeAt: (x) => this.timeAt(x),
        placeOf: (us) => this.xOf(us),
        select: (from, to) => {
          this.selected = [from, to];
          this.drawOver();
        },
        point: (us) => {
          this.pointer = us;
          this.onPointer(us);
          this.drawOver();
        },
      },
      control,
    );
    this.observer = new ResizeObserver(() => {
      // A view that is left has no width.
      if (root.clientWidth === 0 || (root.clientWidth === this.width && this.room() === this.wanted)) return;
      this.onWidth(root.clientWidth);
      this.build();
    });
    this.observer.observe(root);
    this.theme.addEventListener("change", this.rebuild);
  }

  show(channels: Channel[], places: Place[], tracks: Track[] = []): void {
    this.channels = channels;
    this.places = places;
    this.tracks = tracks;
    if (this.points.least.length !== channels.length) this.points = emptyPoints(channels.length);
    this.build();
  }

  setPoints(points: Points): void {
    if (points.least.length !== this.channels.length) return;
    this.points = points;
    this.draw();
  }

  setMarks(marks: Mark[]): void {
    this.marks = marks;
    this.drawOver();
  }

  // What lies behind this moment is not so yet: it is pale. null: nothing does.
  setPresent(us: number | null): void {
    if (us === this.present) return;
    this.present = us;
    this.drawOver();
  }

  // The cursors have moved.
  redraw(): void {
    this.drawOver();
  }

  destroy(): void {
    this.stop();
    this.observer.disconnect();
    this.theme.removeEventListener("change", this.rebuild);
    for (const panel of this.panels) panel.destroy();
    this.root.replaceChildren();
  }

  // --- places ---

  private themed(name: string): string {
    return getComputedStyle(this.root).getPropertyValue(name).trim();
  }
  private ink(): Ink {
    return {
      text: this.themed("--text"),
      quiet: this.themed("--quiet"),
      line: this.themed("--line"),
      ground: this.themed("--panel"),
      colour: (channel) => this.themed(`--s${(channel % 8) + 1}`),
    };
  }
  private area(): Area {
    return { left: this.left, right: Math.max(this.left + 1, this.width - right_margin), width: this.width };
  }
  private xOf(us: number): number {
    const { from_us, to_us } = this.control.window();
    const { left, right } = this.area();
    return left + ((us - from_us) / (to_us - from_us)) * (right - left);
  }
  private timeAt(x: number): number {
    const { from_us, to_us } = this.control.window();
    const { left, right } = this.area();
    return from_us + ((x - left) / (right - left)) * (to_us - from_us);
  }

  // --- drawing ---

  // What its style gives it, which panels and lanes fill; with many of them it grows.
  private room(): number {
    return Number.parseFloat(getComputedStyle(this.root).minHeight) || 0;
  }
  private laneCount(): number {
    return this.lanes.length + this.tracks.length;
  }
  // Lanes become lower before panels take less than they need.
  private laneHeight(): number {
    return laneHeight(this.laneCount(), this.wanted - this.labelRoom() - this.panels.length * least_panel);
  }
  private panelHeight(): number {
    const left = this.wanted - lanesHeight(this.laneCount(), this.laneHeight()) - this.labelRoom();
    return Math.max(least_panel, Math.floor(left / Math.max(1, this.panels.length)));
  }
  private labelRoom(): number {
    return this.marks.some((mark) => mark.text.length > 1) ? label_rows * label_height : 0;
  }

  private build(): void {
    for (const panel of this.panels) panel.destroy();
    this.width = Math.floor(this.root.clientWidth);
    if (this.width === 0) {
      this.panels = [];
      return;
    }
    this.wanted = this.room();
    const ink = this.ink();
    const size = { width: this.width, height: least_panel };
    this.panels = panelsOf(this.channels, this.places).map((panel) => new DrawnPanel(panel, this.channels, size, ink, this.plots));
    this.draw();
  }

  private canvas(canvas: HTMLCanvasElement, height: number): CanvasRenderingContext2D | null {
    const dots = devicePixelRatio || 1;
    if (canvas.width !== Math.round(this.width * dots) || canvas.height !== Math.round(height * dots)) {
      canvas.width = Math.round(this.width * dots);
      canvas.height = Math.round(height * dots);
      canvas.style.width = `${this.width}px`;
      canvas.style.height = `${height}px`;
    }
    const ctx = canvas.getContext("2d");
    ctx?.setTransform(dots, 0, 0, dots, 0, 0);
    ctx?.clearRect(0, 0, this.width, height);
    return ctx;
  }

  private draw(): void {
    if (this.width === 0) return;
    const seen = (channel: number) => {
      let all = 0;
      for (const value of this.points.greatest[channel] ?? []) all |= value;
      return all;
    };
    this.lanes = lanesOf(this.channels, this.places, seen);
    const height = this.panelHeight();
    this.plots.style.paddingTop = `${this.labelRoom()}px`;
    for (const { plot } of this.panels) if (plot.height !== height) plot.setSize({ width: this.width, height });
    const scales = this.panels.map(({ panel }) => scaleOf(panel, this.points, height));
    const ctx = this.canvas(this.laneCanvas, lanesHeight(this.laneCount(), this.laneHeight()));
    if (!ctx) return;
    ctx.font = font;
    this.left = Math.max(least_left, ...scales.flatMap(({ texts }) => texts.map((text) => ctx.measureText(text).width + 14)));
    const window = this.control.window();
    this.root.dataset.fromUs = String(Math.round(window.from_us));
    this.root.dataset.toUs = String(Math.round(window.to_us));
    const area = this.area();
    const seconds = ticks(window.from_us / 1e6, window.to_us / 1e6, Math.max(2, Math.floor((area.right - area.left) / 90)));
    this.panels.forEach((panel, n) => panel.show(this.points, window, scales[n] as (typeof scales)[0], this.left, seconds));
    drawLanes(ctx, {
      lanes: this.lanes, tracks: this.tracks, lane_height: this.laneHeight(), channels: this.channels, points: this.points, window, area,
      xOf: (us) => this.xOf(us), ink: this.ink(),
    });
    this.drawOver();
  }

  private tall(): number {
    return this.root.clientHeight;
  }

  private drawLine(ctx: CanvasRenderingContext2D, us: number | null, colour: string, dash: number[]): number | null {
    if (us === null) return null;
    const { left, right } = this.area();
    const x = Math.round(this.xOf(us)) + 0.5;
    if (x < left - 1 || x > right + 1) return null;
    ctx.strokeStyle = ctx.fillStyle = colour;
    ctx.setLineDash(dash);
    ctx.beginPath();
    ctx.moveTo(x, 0);
    ctx.lineTo(x, this.tall() - 26);
    ctx.stroke();
    ctx.setLineDash([]);
    return x;
  }

  private drawLater(ctx: CanvasRenderingContext2D, present_us: number): void {
    const { left, right } = this.area();
    const x = Math.max(left, this.xOf(present_us));
    if (x >= right) return;
    ctx.fillStyle = this.themed("--panel");
    ctx.globalAlpha = 0.7;
    ctx.fillRect(x, 0, right - x, this.tall() - axis_height);
    ctx.globalAlpha = 1;
    this.drawLine(ctx, present_us, this.themed("--accent"), []);
  }

  private drawOver(): void {
    if (this.width === 0) return;
    const ctx = this.canvas(this.over, this.tall());
    if (!ctx) return;
    ctx.font = `600 ${font}`;
    const { left, right } = this.area();
    if (this.present !== null) this.drawLater(ctx, this.present);
    ctx.fillStyle = this.themed("--text");
    this.panels.forEach(({ panel, plot }) => ctx.fillText(panel.title, left + 4, plot.root.offsetTop + 12));
    if (this.selected[0] !== this.selected[1]) {
      ctx.fillStyle = this.themed("--accent");
      ctx.globalAlpha = 0.22;
      const [from, to] = [Math.min(...this.selected), Math.max(...this.selected)];
      ctx.fillRect(from, 0, to - from, this.tall());
      ctx.globalAlpha = 1;
    }
    const ends: number[] = [];
    for (const mark of this.marks) {
      const x = this.drawLine(ctx, mark.us, this.themed(mark.colour), [3, 3]);
      if (x === null) continue;
      const room = ctx.measureText(mark.text).width;
      const at = Math.min(x + 3, right - room);
      const row = Array.from({ length: label_rows }, (_, n) => n).find((n) => (ends[n] ?? 0) < at);
      if (row === undefined) continue;
      ends[row] = at + room + 6;
      ctx.fillText(mark.text, at, 10 + row * label_height);
    }
    const cursors = this.control.cursors();
    for (const name of ["A", "B"] as const) {
      const x = this.drawLine(ctx, cursors[name], this.themed("--text"), [5, 3]);
      if (x !== null) ctx.fillText(name, x > right - 14 ? x - 12 : x + 4, this.tall() - 30);
    }
    this.drawLine(ctx, this.pointer, this.themed("--edge"), []);
  }

  // As it stands, with the names of its channels, for a file.
  png(): Blob {
    const dots = devicePixelRatio || 1;
    const rows = Math.ceil((this.channels.length * 220) / Math.max(220, this.width));
    const heading = 6 + rows * 18;
    const canvas = document.createElement("canvas");
    canvas.width = this.width * dots;
    canvas.height = (heading + this.tall()) * dots;
    const ctx = canvas.getContext("2d") as CanvasRenderingContext2D;
    ctx.scale(dots, dots);
    ctx.fillStyle = this.themed("--panel");
    ctx.fillRect(0, 0, this.width, heading + this.tall());
    ctx.font = `600 ${font}`;
    const across = Math.max(1, Math.floor(this.width / 220));
    this.channels.forEach((channel, n) => {
      ctx.fillStyle = this.ink().colour(n);
      ctx.fillText(channel.unit ? `${channel.name} [${channel.unit}]` : channel.name, 10 + (n % across) * 220, 16 + Math.floor(n / across) * 18);
    });
    const box = this.root.getBoundingClientRect();
    for (const part of [...this.plots.querySelectorAll("canvas"), this.laneCanvas, this.over]) {
      const at = part.getBoundingClientRect();
      ctx.drawImage(part, at.left - box.left, heading + at.top - box.top, at.width, at.height);
    }
    // toBlob waits until the browser is idle, which it is not while the scope runs.
    const bytes = atob(canvas.toDataURL("image/png").replace(/^.*,/, ""));
    return new Blob([Uint8Array.from(bytes, (byte) => byte.charCodeAt(0))], { type: "image/png" });
  }
}
