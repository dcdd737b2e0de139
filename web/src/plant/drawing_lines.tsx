// The lines in the drawing: a cable with its name and load, risers between its rows, and a tap to each station. Scissors cut
// a tap, and a click on them joins it again.
import type { Line } from "../server/protocol";
import { command } from "../shell/notice";
import { box_height, legendY, tapX, type Box, type Cable, type Layout, type Riser, type Row } from "./drawing_layout";
import { lineState } from "./state";

// What Enter and Space do on an element that is no button by itself.
export function pressed(act: () => void) {
  return (event: KeyboardEvent) => {
    if (event.key !== "Enter" && event.key !== " ") return;
    event.preventDefault();
    act();
  };
}

const stroke = (colour: number) => ({ stroke: `var(--s${colour})` });

function Scissors({ x, y }: { x: number; y: number }) {
  return (
    <g class="scissors" transform={`translate(${x} ${y})`}>
      <circle cx="-7" cy="-4" r="2.6" />
      <circle cx="-7" cy="4" r="2.6" />
      <path d="M-5 -2.5L8 4.5M-5 2.5L8 -4.5" />
    </g>
  );
}

function Tap({ box, line, colour, from, to }: { box: Box; line: Line; colour: number; from: number; to: number }) {
  const x = tapX(box, line.name);
  // On PROFIBUS a cut shortens frames; where it is of the wires it needs a station.
  const cuttable = line.fault_rules.cut?.station === "must";
  const cut =
    cuttable && (lineState(line.name).value?.faults.some((fault) => fault.kind === "cut" && fault.station === box.name) ?? false);
  const wire = <path class={`cable${cut ? " cut" : ""}`} style={cut ? undefined : stroke(colour)} d={`M${x} ${from}V${to}`} />;
  const joint = <circle cx={x} cy={to} r="4" class="joint" style={stroke(colour)} />;
  if (!cuttable || box.control)
    return (
      <g>
        {wire}
        {joint}
      </g>
    );
  const act = () => void command({ do: "fault", bus: line.name, kind: "cut", station: box.name, on: !cut });
  return (
    <g
      role="button"
      class={cut ? "tap is-cut" : "tap"}
      tabindex={0}
      aria-pressed={cut}
      aria-label={`Cut ${box.name} from ${line.name}`}
      onClick={act}
      onKeyDown={pressed(act)}
    >
      <title>{cut ? `Join ${box.name} to ${line.name} again` : `Cut ${box.name} from ${line.name}`}</title>
      <rect class="target" x={x - 12} y={from} width="24" height={to - from} />
      {wire}
      {joint}
      <Scissors x={x} y={from + 12} />
    </g>
  );
}

function rateText(line: Line): string {
  return ["can", "profibus"].includes(line.kind) && line.baud >= 1000 ? `${line.baud / 1000} kBaud` : `${line.baud} Baud`;
}

function Load({ line, x, y }: { line: Line; x: number; y: number }) {
  const percent = lineState(line.name).value?.load ?? 0;
  const load = Math.min(100, percent);
  return (
    <g role="img" aria-label={`Load of ${line.name}: ${percent.toFixed(1)} %`}>
      <rect class="load-ground" x={x} y={y} width="60" height="7" rx="2" />
      <rect class={`load${load > 90 ? " full" : load > 60 ? " much" : ""}`} x={x} y={y} width={load * 0.6} height="7" rx="2" />
      <text x={x + 65} y={y + 7} class="small">
        {percent.toFixed(1)} %
      </text>
    </g>
  );
}

// Once a line. In further rows its name is enough.
export function LineLabel({ cable, row, layout }: { cable: Cable; row: Row; layout: Layout }) {
  const { line } = cable;
  const kind = `${line.kind.toUpperCase()} ${rateText(line)}`;
  if (layout.narrow) {
    if (!cable.first) return null;
    const y = legendY(row, cable);
    return (
      <g>
        <path class="cable" style={stroke(cable.colour)} d={`M${layout.legend_x} ${y - 4}h12`} />
        <text x={layout.legend_x + 18} y={y}>
          {line.name} <tspan class="small">{kind}</tspan>
        </text>
        <Load line={line} x={layout.width - 108} y={y - 8} />
      </g>
    );
  }
  return (
    <g>
      <text x="8" y={cable.y - 2} class={cable.first ? "" : "small"}>
        {line.name}
      </text>
      {cable.first && (
        <text x="8" y={cable.y + 12} class="small">
          {kind}
        </text>
      )}
      {cable.first && <Load line={line} x={8} y={cable.y + 17} />}
    </g>
  );
}

export function RiserPath({ riser }: { riser: Riser }) {
  return <path class="cable" style={stroke(riser.colour)} d={`M${riser.x} ${riser.fromY}V${riser.toY}`} />;
}

export function CablePath({ cable }: { cable: Cable }) {
  return <path class="cable" style={stroke(cable.colour)} d={`M${cable.fromX} ${cable.y}H${cable.toX}`} />;
}

export function Taps({ cable, row }: { cable: Cable; row: Row }) {
  return (
    <>
      {cable.members.map((box) => (
        <Tap key={box.name} box={box} line={cable.line} colour={cable.colour} from={row.top + box_height} to={cable.y} />
      ))}
    </>
  );
}
