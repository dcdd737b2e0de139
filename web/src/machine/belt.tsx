// A conveyor: a belt between two rollers that turn with it, the parts that lie on it and the light barriers over it. A belt
// without places of its own is drawn as a piece of one that goes on for ever.
import { useRef } from "preact/hooks";

import type { Drawn } from "./machine";
import { useMotion } from "./motion";
import { inUnit, scaleOf, unitText } from "./units";
import { useWidth } from "./width";

const below = 54; // the belt and its scale
const roller = 15;
const edge = 30;
const cleat = 24; // pixels from one mark of the belt to the next
const spokes = "M-10 0H10M0 -10V10";

export function Belt({ station, machine, state, marks }: Drawn) {
  const { box, width } = useWidth<HTMLDivElement>(420);
  const svg = useRef<SVGSVGElement>(null);
  const right = width - edge;
  const length = machine.from === null || machine.to === null ? Math.abs(machine.per_turn) * 4 : machine.to - machine.from;
  const first = machine.from ?? 0;
  const pixels = (right - edge) / length; // of a unit
  const x = (value: number) => edge + Math.min(1, Math.max(0, (value - first) / length)) * (right - edge);
  // Points of the way other than the barriers say nothing of an endless belt.
  const barriers = marks.filter((mark) => mark.kind === "barrier");
  const belt_y = barriers.length > 0 ? 54 : 24; // parts lie on it, barriers stand over them
  const partWidth = (machine.part_length ?? 0) * pixels;
  const parts = state.machine?.parts ?? [];
  useMotion(station.name, (behind) => {
    const picture = svg.current;
    if (!picture) return;
    const moved = inUnit(machine, (state.machine?.shaft ?? 0) + behind) * pixels;
    picture.querySelector("[data-cleats]")?.setAttribute("stroke-dashoffset", String(-(moved % cleat)));
    const degrees = ((moved / roller) * 180) / Math.PI;
    for (const one of picture.querySelectorAll<SVGGElement>("[data-roller]"))
      one.setAttribute("transform", `translate(${one.dataset.roller} ${belt_y + roller}) rotate(${(degrees % 360).toFixed(1)})`);
    const late = inUnit(machine, behind);
    picture.querySelectorAll<SVGRectElement>("[data-front]").forEach((part) => {
      const front = Number(part.dataset.front) + late;
      part.setAttribute("x", (edge + (front - first) * pixels - partWidth).toFixed(1));
    });
  });
  return (
    <div ref={box} class="way">
      <svg ref={svg} width={width} height={belt_y + below + barriers.length * 14} aria-hidden="true">
        {machine.from !== null &&
          scaleOf({ from: first, to: first + length }, Math.max(2, Math.floor(width / 90))).map((step) => (
            <text key={step} x={x(step)} y={belt_y + 46} text-anchor="middle" class="small">
              {step}
            </text>
          ))}
        <rect class="belt" x={edge - roller} y={belt_y} width={right - edge + 2 * roller} height={2 * roller} rx={roller} />
        <path class="cleats" data-cleats d={`M${edge} ${belt_y + 3}H${right}`} stroke-dasharray={`3 ${cleat - 3}`} />
        {[edge, right].map((at) => (
          <g key={at} class="roller" data-roller={at}>
            <circle r={roller - 4} />
            <path d={spokes} />
          </g>
        ))}
        {parts.map((front, n) => (
          <rect key={n} class="part" data-front={front} y={belt_y - 20} width={Math.max(2, partWidth)} height="20" rx="2" />
        ))}
        {barriers.map((mark, n) => {
          const at = x(mark.from);
          const onRight = at > width / 2;
          const textY = belt_y + 60 + n * 14;
          return (
            <g key={n} class={`mark barrier${mark.on ? " on" : ""}`}>
              <title>{`${mark.text} at ${unitText(machine, mark.from)}`}</title>
              <rect class="zone" x={at - 5} y={belt_y - 50} width="10" height="14" rx="2" />
              <path class="line" d={`M${at} ${belt_y - 36}V${belt_y}`} />
              <path class="lead" d={`M${at} ${belt_y + 2 * roller}V${textY - 4}`} />
              <text x={at + (onRight ? -6 : 6)} y={textY} text-anchor={onRight ? "end" : "start"}>
                {mark.text}
              </text>
            </g>
          );
        })}
      </svg>
    </div>
  );
}

