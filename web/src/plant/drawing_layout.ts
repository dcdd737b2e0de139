// Where the boxes of stations and controls, the cables of the lines and the wires stand in the drawing. A line that reaches
// several rows of boxes is one cable: a riser at the left joins its parts.
import type { Line, Plant, Wire } from "../server/protocol";

export const box_width = 108;
export const box_height = 46;
const gap = 22;
const narrow_width = 560;
const wire_pitch = 15;
const lane_pitch = 9;
const legend_pitch = 18;
const end_beside = 26; // a cable goes on so far beside its last station

export interface Point {
  x: number;
  y: number;
}

export interface Box {
  name: string;
  control: boolean;
  x: number;
  lines: string[];
}

// To a station in another row there is no way to draw: both ends say where it goes.
export interface DrawnWire extends Wire {
  fromX: number | null;
  toX: number | null;
  height: number;
}

// The part of a line in one row.
export interface Cable {
  line: Line;
  colour: number;
  y: number;
  fromX: number;
  toX: number;
  first: boolean; // the line begins here: it has its name and load here
  members: Box[];
}

export interface Row {
  boxes: Box[];
  cables: Cable[];
  wires: DrawnWire[];
  top: number; // of the boxes
}

export interface Riser {
  line: string;
  colour: number;
  x: number;
  fromY: number;
  toY: number;
}

export interface Layout {
  rows: Row[];
  risers: Riser[];
  legend_x: number;
  width: number;
  height: number;
  narrow: boolean; // names and loads stand below the cables, where no tap crosses them, else left of them
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
    if (from === undefined && to === undefined) continue;
    const shift = (drawn.length % 4) * 7;
    drawn.push({
      ...wire,
      fromX: from === undefined ? null : from + box_width / 2 + 10 + shift,
      toX: to === undefined ? null : to + (from === to ? 14 : box_width / 2 - 10) - shift / 2,
      height: (drawn.length + 1) * wire_pitch,
    });
  }
  return drawn;
}

// The taps of a box stand side by side.
export function tapX(box: Box, line: string): number {
  const position = box.lines.indexOf(line);
  return box.x + (box_width * (position + 1)) / (box.lines.length + 1);
}

// Risers take room, and with less room there may be more of them.
export function layOut(plant: Plant, width: number): Layout {
  let layout = layOutWith(0, plant, width);
  for (let lanes = 1; lanes <= plant.buses.length && layout.risers.length >= lanes; ++lanes) layout = layOutWith(lanes, plant, width);
  return layout;
}

function layOutWith(lanes: number, plant: Plant, width: number): Layout {
  const all = boxesOf(plant);
  const narrow = width < narrow_width;
  const label_width = narrow ? 0 : 140;
  const cable_pitch = narrow ? 16 : 42;
  const pitch = box_width + (narrow ? 5 : gap);
  const left = label_width + lanes * lane_pitch + 6;
  const fit = Math.max(1, Math.floor((width - left) / pitch));
  const rows: Row[] = [];
  const seen = new Set<string>();
  let top = 0;
  let drawn = 0;
  for (let first = 0; first < all.length; first += fit) {
    const boxes = all.slice(first, first + fit).map((box, position) => ({ ...box, x: left + position * pitch }));
    const wires = wiresOf(plant, boxes);
    const boxes_top = top + wires.length * wire_pitch + (wires.length ? 14 : 6);
    const cables: Cable[] = [];
    for (const [number, line] of plant.buses.entries()) {
      const members = boxes.filter((box) => box.lines.includes(line.name));
      if (members.length === 0) continue;
      const taps = members.map((box) => tapX(box, line.name));
      cables.push({
        line,
        colour: (number % 8) + 1,
        y: boxes_top + box_height + 24 + cables.length * cable_pitch,
        fromX: narrow ? Math.min(...taps) - end_beside : label_width,
        toX: Math.max(...taps) + end_beside,
        first: !seen.has(line.name),
        members,
      });
      seen.add(line.name);
    }
    const legends = narrow ? cables.filter((cable) => cable.first).length * legend_pitch : 0;
    rows.push({ boxes, cables, wires, top: boxes_top });
    top = boxes_top + box_height + (cables.length ? 24 + cables.length * cable_pitch + legends : 0) + 14;
    drawn = Math.max(drawn, left + boxes.length * pitch + 6);
  }
  const risers: Riser[] = [];
  for (const line of plant.buses) {
    const parts = rows.flatMap((row) => row.cables.filter((cable) => cable.line.name === line.name));
    if (parts.length < 2) continue;
    const x = label_width + 6 + risers.length * lane_pitch;
    for (const part of parts) part.fromX = x;
    const ys = parts.map((part) => part.y);
    risers.push({ line: line.name, colour: parts[0]?.colour ?? 1, x, fromY: Math.min(...ys), toY: Math.max(...ys) });
  }
  return { rows, risers, legend_x: left, width: Math.max(left + 284, drawn), height: top, narrow };
}

export function legendY(row: Row, cable: Cable): number {
  const begin = Math.max(...row.cables.map((one) => one.y)) + 18;
  return begin + row.cables.filter((one) => one.first).indexOf(cable) * legend_pitch;
}

// The ways of a telegram from the tap of its sender to every end of the line.
export function waysFrom(layout: Layout, line: string, sender: string): Point[][] {
  const parts = layout.rows.flatMap((row) =>
    row.cables.filter((cable) => cable.line.name === line).map((cable) => ({ row, cable })),
  );
  const home = parts.find(({ cable }) => cable.members.some((box) => box.name === sender));
  const box = home?.cable.members.find((one) => one.name === sender);
  if (!home || !box) return [];
  const x = tapX(box, line);
  const begin = [
    { x, y: home.row.top + box_height },
    { x, y: home.cable.y },
  ];
  const left = { x: home.cable.fromX, y: home.cable.y };
  const others = parts.filter((part) => part !== home);
  return [
    [...begin, { x: home.cable.toX, y: home.cable.y }],
    ...(others.length === 0 ? [[...begin, left]] : []),
    ...others.map(({ cable }) => [...begin, left, { x: left.x, y: cable.y }, { x: cable.toX, y: cable.y }]),
  ];
}

// Where one is that has gone that part (0 to 1) of a way.
export function pointOn(way: Point[], part: number): Point {
  const lengths = way.slice(1).map((to, n) => Math.hypot(to.x - (way[n]?.x ?? 0), to.y - (way[n]?.y ?? 0)));
  let left = lengths.reduce((sum, one) => sum + one, 0) * Math.max(0, Math.min(1, part));
  for (const [n, length] of lengths.entries()) {
    const from = way[n];
    const to = way[n + 1];
    if (from && to && (left <= length || n === lengths.length - 1)) {
      const of = length === 0 ? 0 : Math.min(1, left / length);
      return { x: from.x + (to.x - from.x) * of, y: from.y + (to.y - from.y) * of };
    }
    left -= length;
  }
  return way[0] ?? { x: 0, y: 0 };
}
