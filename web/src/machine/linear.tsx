// A slide on its axis, or the cage of a hoist in its shaft, with all that stands along the way. The hoist is drawn upright,
// upwards being the direction of rising positions.
import { useRef } from "preact/hooks";

import type { Drawn } from "./machine";
import type { Mark } from "./marks";
import { useMotion } from "./motion";
import { inUnit, scaleOf, shaft_turn, windowOf, type Window } from "./units";
import { useWidth } from "./width";

const hoist_height = 250;
const axis_height = 64; // without the labels
const edge = 26;
const label_pitch = 15;

// What is known of the travel. Where that is nothing, also where the machine has been: the window does not get smaller.
function useWindow({ machine, state, marks }: Drawn): Window {
  const seen = useRef<{ unit: string; places: [number, number] } | undefined>(undefined);
  const at = inUnit(machine, state.position ?? 0);
  if (!seen.current || seen.current.unit !== machine.unit) seen.current = { unit: machine.unit, places: [at, at] };
  const { places } = seen.current;
  seen.current.places = [Math.min(places[0], at), Math.max(places[1], at)];
  const fixed = [machine.from, machine.to].filter((end): end is number => end !== null);
  const ends = marks
    .filter((mark) => mark.kind === "switch" || mark.kind === "limit" || mark.kind === "target")
    .flatMap((mark) => [mark.from, mark.to])
    .filter(Number.isFinite);
  const known = [...fixed, ...ends];
  if (known.length === 0) known.push(inUnit(machine, -shaft_turn), inUnit(machine, shaft_turn));
  const all = [...known, ...(fixed.length > 0 ? [at] : seen.current.places)];
  const [from, to] = fixed;
  // Switches stand at the ends, and some increments outside.
  const slack = from === undefined || to === undefined ? 0 : (to - from) / 25;
  const tight = from !== undefined && to !== undefined && Math.min(...all) >= from - slack && Math.max(...all) <= to + slack;
  return tight ? { from: from - slack, to: to + slack } : windowOf(all);
}

// Labels beside an upright way, moved apart where they would lie on each other.
function spread(places: number[], pitch: number, most: number): number[] {
  const order = places.map((_, n) => n).sort((a, b) => (places[a] ?? 0) - (places[b] ?? 0));
  const out = [...places];
  let last = -Infinity;
  for (const n of order) last = out[n] = Math.max(out[n] ?? 0, last + pitch);
  // What went beyond the end is pushed back, and what then lies under it, too.
  let limit = most;
  for (const n of order.reverse()) {
    out[n] = Math.min(out[n] ?? 0, limit);
    limit = (out[n] ?? 0) - pitch;
  }
  return out;
}

const clamp = (value: number, window: Window) => Math.min(window.to, Math.max(window.from, value));
const middle = (mark: Mark, window: Window) => (clamp(mark.from, window) + clamp(mark.to, window)) / 2;
const classOf = (mark: Mark) => `mark ${mark.kind}${mark.on ? " on" : ""}`;

function Upright({ window, marks, width, car }: Part) {
  const top = 34;
  const bottom = hoist_height - 8;
  const y = (value: number) => bottom - ((clamp(value, window) - window.from) / (window.to - window.from)) * (bottom - top);
  const left = 62;
  const shaft = 74;
  const labels = spread(
    marks.map((mark) => y(middle(mark, window)) + 4),
    label_pitch,
    hoist_height - 4,
  );
  return (
    <svg width={width} height={hoist_height} aria-hidden="true">
      <rect class="ground" x={left} y={top - 14} width={shaft} height={bottom - top + 20} rx="3" />
      {scaleOf(window, 6).map((step) => (
        <g key={step}>
          <path class="tick" d={`M${left - 6} ${y(step)}H${left}`} />
          <text x={left - 9} y={y(step) + 4} text-anchor="end" class="small">
            {step}
          </text>
        </g>
      ))}
      <circle class="pulley" cx={left + shaft / 2} cy="10" r="8" />
      <path class="rope" data-rope={`${left + shaft / 2} 10`} />
      {marks.map((mark, n) => {
        const from = y(mark.from);
        const to = y(mark.to);
        const wide = mark.kind === "target" || mark.kind === "setpoint";
        return (
          <g key={`${mark.kind} ${n}`} class={classOf(mark)}>
            {from === to ? (
              <path class="line" d={`M${wide ? left : left + shaft - 14} ${from}H${left + shaft + 6}`} />
            ) : (
              <rect class="zone" x={left + shaft - 8} y={Math.min(from, to)} width="8" height={Math.abs(from - to)} />
            )}
            <path class="lead" d={`M${left + shaft + 6} ${y(middle(mark, window))}L${left + shaft + 16} ${(labels[n] ?? 0) - 4}`} />
            <text x={left + shaft + 20} y={labels[n]}>
              {mark.text}
            </text>
          </g>
        );
      })}
      <g ref={car} class="car" data-x={left + 8} data-span={`${bottom} ${top}`}>
        <rect x="0" y="-22" width={shaft - 26} height="22" rx="3" />
        <path d={`M6 -16H${shaft - 32}M6 -9H${shaft - 32}`} />
      </g>
    </svg>
  );
}

function Level({ window, marks, width, car }: Part) {
  const right = width - edge;
  const x = (value: number) => edge + ((clamp(value, window) - window.from) / (window.to - window.from)) * (right - edge);
  const rail = 40;
  // One row a label; each begins at its mark, or ends there in the right half.
  const order = [...marks.keys()].sort((a, b) => x(middle(marks[a] as Mark, window)) - x(middle(marks[b] as Mark, window)));
  const row = new Map(order.map((n, position) => [n, position]));
  const height = axis_height + marks.length * label_pitch + 4;
  return (
    <svg width={width} height={height} aria-hidden="true">
      {scaleOf(window, Math.max(2, Math.floor(width / 90))).map((step) => (
        <g key={step}>
          <path class="tick" d={`M${x(step)} ${rail + 5}v5`} />
          <text x={x(step)} y={rail + 21} text-anchor="middle" class="small">
            {step}
          </text>
        </g>
      ))}
      <rect class="ground" x={edge - 12} y={rail - 4} width={right - edge + 24} height="8" rx="2" />
      {marks.map((mark, n) => {
        const from = x(mark.from);
        const to = x(mark.to);
        const at = x(middle(mark, window));
        const textY = axis_height + (row.get(n) ?? 0) * label_pitch + 12;
        const onRight = at > width / 2;
        return (
          <g key={`${mark.kind} ${n}`} class={classOf(mark)}>
            {from === to ? (
              <path class="line" d={`M${from} ${rail - 12}V${rail + 8}`} />
            ) : (
              <rect class="zone" x={Math.min(from, to)} y={rail - 4} width={Math.abs(to - from)} height="8" />
            )}
            <path class="lead" d={`M${at} ${rail + 8}V${textY - 4}H${at + (onRight ? -6 : 6)}`} />
            <text x={at + (onRight ? -9 : 9)} y={textY} text-anchor={onRight ? "end" : "start"}>
              {mark.text}
            </text>
          </g>
        );
      })}
      <g ref={car} class="car" data-y={rail - 4} data-span={`${edge} ${right}`}>
        <rect x="-17" y="-20" width="34" height="20" rx="3" />
        <path d="M0 -20V0" />
      </g>
    </svg>
  );
}

interface Part {
  window: Window;
  marks: Mark[];
  width: number;
  car: { current: SVGGElement | null };
}

export function Linear(drawn: Drawn) {
  const { machine, state, marks, station } = drawn;
  const { box, width } = useWidth<HTMLDivElement>(420);
  const car = useRef<SVGGElement>(null);
  const window = useWindow(drawn);
  const upright = machine.kind === "hoist";
  useMotion(station.name, (behind) => {
    const element = car.current;
    if (!element) return;
    const share = (clamp(inUnit(machine, (state.position ?? 0) + behind), window) - window.from) / (window.to - window.from);
    const [begin, end] = (element.dataset.span ?? "0 0").split(" ").map(Number) as [number, number];
    const place = begin + share * (end - begin);
    element.setAttribute("transform", upright ? `translate(${element.dataset.x} ${place})` : `translate(${place} ${element.dataset.y})`);
    const rope = element.parentElement?.querySelector<SVGPathElement>("[data-rope]");
    if (rope) rope.setAttribute("d", `M${rope.dataset.rope}V${place - 22}`);
  });
  const Way = upright ? Upright : Level;
  return (
    <div ref={box} class="way">
      <Way window={window} marks={marks} width={width} car={car} />
    </div>
  );
}
