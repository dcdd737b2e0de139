// Where the boxes of stations and controls, the cables of the lines and the wires stand in the drawing.
import type { Line, Plant, Wire } from "../server/protocol";

export const box_width = 108;
export const box_height = 46;
const gap = 22;
const narrow_width = 560;
const wire_pitch = 15;

export interface Box {
  name: string;
  control: boolean;
  x: number;
  lines: string[];
}

export interface DrawnWire extends Wire {
  fromX: number;
  toX: number;
  height: number;
}

// As many boxes side by side as the width permits; the lines are drawn in each of these rows that they reach.
export interface Row {
  boxes: Box[];
  lines: Line[];
  wires: DrawnWire[];
  top: number;
  height: number;
  width: number;
  line_pitch: number;
  label_width: number; // 0: the labels stand under the cables
}

function stationOf(terminal: string): string {
  return terminal.slice(0, terminal.lastIndexOf("."));
}

function boxesOf(plant: Plant): Omit<Box, "x">[] {
  const controls = new Map<string, string[]>();
  for (const control of plant.controls) controls.set(control.name, [...(controls.get(control.name) ?? []), control.bus]);
  return [
    ...[...controls].map(([name, lines]) => ({ name, control: true, lines })),
    ...plant.stations.map((station) => ({ name: station.name, control: false, lines: station.lines })),
  ];
}

function wiresOf(plant: Plant, boxes: Box[]): DrawnWire[] {
  const place = new Map(boxes.map((box) => [box.name, box.x]));
  const drawn: DrawnWire[] = [];
  for (const wire of plant.wires) {
    const from = place.get(stationOf(wire.from));
    const to = place.get(stationOf(wire.to));
    if (from === undefined || to === undefined) continue;
    const shift = (drawn.length % 4) * 7;
    const fromX = from + box_width / 2 + 10 + shift;
    const toX = to + (from === to ? 14 : box_width / 2 - 10) - shift / 2;
    drawn.push({ ...wire, fromX, toX, height: (drawn.length + 1) * wire_pitch });
  }
  return drawn;
}

export function layOut(plant: Plant, width: number): Row[] {
  const all = boxesOf(plant);
  const narrow = width < narrow_width;
  const label_width = narrow ? 0 : 148;
  const line_pitch = narrow ? 52 : 42;
  const pitch = box_width + (narrow ? 5 : gap);
  const fit = Math.max(1, Math.floor((width - label_width) / pitch));
  const rows: Row[] = [];
  let top = 0;
  for (let first = 0; first < all.length; first += fit) {
    const boxes = all
      .slice(first, first + fit)
      .map((box, position) => ({ ...box, x: label_width + position * pitch + 2 }));
    const lines = plant.buses.filter((bus) => boxes.some((box) => box.lines.includes(bus.name)));
    const wires = wiresOf(plant, boxes);
    const above = wires.length * wire_pitch + (wires.length ? 14 : 6);
    const height = above + box_height + lines.length * line_pitch + 14;
    rows.push({
      boxes,
      lines,
      wires,
      top: top + above,
      height,
      width: Math.max(270, label_width + boxes.length * pitch),
      line_pitch,
      label_width,
    });
    top += height;
  }
  return rows;
}

// The taps of a box stand side by side.
export function tapX(box: Box, line: string): number {
  const position = box.lines.indexOf(line);
  return box.x + (box_width * (position + 1)) / (box.lines.length + 1);
}
