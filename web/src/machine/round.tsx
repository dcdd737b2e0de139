// What turns: a turntable with its marks on the rim, the reel of a winder, the blades of a fan, or the shaft itself.
import type { FunctionComponent } from "preact";
import { useRef } from "preact/hooks";

import type { Drawn } from "./machine";
import { useMotion } from "./motion";
import { inUnit, shaft_turn } from "./units";

// Degrees of the picture for increments. A table in degrees turns as they say; one with a travel makes a turn with it.
function degreesOf({ machine }: Drawn, increments: number): number {
  if (machine.kind !== "turntable") return (increments / shaft_turn) * 360;
  const whole = /^(deg|°)$/.test(machine.unit) ? 360 : machine.from !== null && machine.to !== null ? machine.to - machine.from : machine.per_turn;
  return (inUnit(machine, increments) / whole) * 360;
}

function Shaft() {
  return (
    <>
      <circle r="14" class="hub" />
      <path d="M-2.6 -5.5V-14.4H2.6V-5.5Z" class="key" />
      <circle r="3" class="bore" />
    </>
  );
}

function Table() {
  return (
    <>
      <circle r="17" class="hub" />
      {[45, 135, 225, 315].map((at) => (
        <rect key={at} class="seat" x="-3" y="-15" width="6" height="6" transform={`rotate(${at})`} />
      ))}
      <path d="M-2.4 -10V-18.5H2.4V-10Z" class="key" />
      <circle r="2.5" class="bore" />
    </>
  );
}

// A turn adds a layer, so the radius grows with the travel: a bare core at its beginning, a full roll at its end. Without a
// travel the roll is full.
const core = 6;
const full = 18;
const layer = 4; // what is drawn as one

function rollRadius({ machine, state }: Drawn): number {
  const { from, to } = machine;
  if (from === null || to === null) return full;
  const part = (inUnit(machine, state.position ?? 0) - from) / (to - from);
  return core + Math.max(0, Math.min(1, part)) * (full - core);
}

function Reel(drawn: Drawn) {
  const radius = rollRadius(drawn);
  return (
    <>
      {Array.from({ length: Math.ceil((radius - core) / layer) }, (_, n) => (
        <circle key={n} r={(radius - n * layer).toFixed(2)} class="web" />
      ))}
      <circle r={core} class="hub" />
      <path d="M-1.5 -2V-9H1.5V-2Z" class="key" />
    </>
  );
}

function Blades() {
  return (
    <>
      {[0, 90, 180, 270].map((at) => (
        <path key={at} class={at === 0 ? "blade first" : "blade"} d="M0 0C-8 -5 -8 -15 -2 -19C4 -18 5 -8 0 0Z" transform={`rotate(${at})`} />
      ))}
      <circle r="3.2" class="hub" />
    </>
  );
}

const bodies: Partial<Record<Drawn["machine"]["kind"], FunctionComponent<Drawn>>> = { shaft: Shaft, turntable: Table, winder: Reel, fan: Blades };

export function Round(drawn: Drawn) {
  const { station, machine, state, marks } = drawn;
  const turning = useRef<SVGGElement>(null);
  const Body = bodies[machine.kind] ?? Shaft;
  const count = machine.kind === "turntable" ? (state.position ?? 0) : (state.machine?.shaft ?? state.position ?? 0);
  useMotion(station.name, (behind) => {
    const degrees = degreesOf(drawn, count + behind);
    turning.current?.setAttribute("transform", `rotate(${(degrees % 360).toFixed(1)})`);
  });
  const small = machine.kind === "shaft";
  const points = machine.kind === "turntable" ? marks.filter((mark) => mark.kind !== "barrier" && Number.isFinite(mark.from)) : [];
  return (
    <svg
      class="round"
      role="img"
      aria-label={`${station.name} shaft at ${((state.shaft ?? 0) * 360).toFixed(0)} degrees`}
      viewBox="-24 -24 48 48"
      width={small ? 58 : 150}
      height={small ? 58 : 150}
    >
      <circle r="22" class="rim" />
      {Array.from({ length: 12 }, (_, hour) => (
        <line key={hour} y1="-22" y2={hour % 3 ? "-20" : "-18.5"} class="tick" transform={`rotate(${hour * 30})`} />
      ))}
      {machine.kind === "winder" && <path class="strip" d={`M-24 ${rollRadius(drawn).toFixed(2)}H0`} />}
      <g ref={turning}>
        <Body {...drawn} />
      </g>
      {points.map((mark, n) => (
        <g key={n} class={`mark ${mark.kind}${mark.on ? " on" : ""}`} transform={`rotate(${degreesOf(drawn, (mark.from * shaft_turn) / machine.per_turn)})`}>
          <title>{mark.text}</title>
          <path class="line" d="M0 -23.5V-18" />
        </g>
      ))}
    </svg>
  );
}
