// The drawing of the plant: boxes on their lines, wires above them. A click on a tap cuts it.
import { useEffect, useRef, useState } from "preact/hooks";

import type { Line, Plant } from "../server/protocol";
import { command } from "../shell/notice";
import { box_height, box_width, layOut, tapX, type Box, type DrawnWire, type Row } from "./drawing_layout";
import { bitSet, lineState, stationState, wanted } from "./state";

// What Enter and Space do on an element that is no button by itself.
function pressed(act: () => void) {
  return (event: KeyboardEvent) => {
    if (event.key !== "Enter" && event.key !== " ") return;
    event.preventDefault();
    act();
  };
}

function cableY(row: Row, position: number): number {
  return row.top + box_height + 25 + position * row.line_pitch;
}

function StationBox({ box, y }: { box: Box; y: number }) {
  const state = stationState(box.name).value;
  const face = !state?.powered ? "dark" : state.error || state.fault ? "fault" : state.enabled ? "enabled" : "";
  const show = () => (wanted.value = { station: box.name });
  const words = !state ? "" : !state.powered ? "off" : state.fault ? `fault ${state.fault}` : (state.state ?? "");
  const text = (
    <>
      <text x={box.x + box_width / 2} y={y + 20} text-anchor="middle">
        {box.name}
      </text>
      <text x={box.x + box_width / 2} y={y + 36} text-anchor="middle" class="small">
        {box.control ? "control" : words.length > 19 ? `${words.slice(0, 18)}…` : words}
      </text>
    </>
  );
  if (box.control)
    return (
      <g>
        <rect class="box" x={box.x} y={y} width={box_width} height={box_height} rx="3" />
        {text}
      </g>
    );
  return (
    <g role="button" tabindex={0} onClick={show} onKeyDown={pressed(show)}>
      <rect class={`box ${face}`} x={box.x} y={y} width={box_width} height={box_height} rx="6" />
      {text}
    </g>
  );
}

function Tap({ box, line, from, to }: { box: Box; line: Line; from: number; to: number }) {
  const x = tapX(box, line.name);
  // On PROFIBUS a cut shortens frames; where it is of the wires it needs a station.
  const cuttable = line.fault_rules.cut?.station === "must";
  const cut =
    cuttable && (lineState(line.name).value?.faults.some((fault) => fault.kind === "cut" && fault.station === box.name) ?? false);
  const wire = <path class={`cable${cut ? " cut" : ""}`} d={`M${x} ${from}V${to}`} />;
  if (!cuttable || box.control)
    return (
      <g>
        {wire}
        <circle cx={x} cy={to} r="3.5" class="box" />
      </g>
    );
  const act = () => void command({ do: "fault", bus: line.name, kind: "cut", station: box.name, on: !cut });
  return (
    <g
      role="button"
      tabindex={0}
      aria-pressed={cut}
      aria-label={`Cut ${box.name} from ${line.name}`}
      onClick={act}
      onKeyDown={pressed(act)}
    >
      <title>{cut ? `Join ${box.name} to ${line.name} again` : `Cut ${box.name} from ${line.name}`}</title>
      <rect class="target" x={x - 8} y={from} width="16" height={to - from} />
      {wire}
      <circle cx={x} cy={to} r="3.5" class="box" />
      {cut && <path class="cable cut" d={`M${x - 6} ${from + 16}l12 -8M${x - 6} ${from + 8}l12 8`} style="stroke-dasharray:none" />}
    </g>
  );
}

function Cable({ line, row, y }: { line: Line; row: Row; y: number }) {
  const state = lineState(line.name).value;
  const members = row.boxes.filter((box) => box.lines.includes(line.name));
  const ends = members.map((box) => tapX(box, line.name));
  const load = Math.min(100, state?.load ?? 0);
  const rate = ["can", "profibus"].includes(line.kind) && line.baud >= 1000 ? `${line.baud / 1000} kBaud` : `${line.baud} Baud`;
  // Beside the cable, or under it where there is no room beside.
  const under = row.label_width === 0;
  const textY = under ? y + 17 : y - 2;
  const meterX = under ? 130 : 8;
  const meterY = under ? y + 22 : y + 17;
  return (
    <g>
      <path class="cable" d={`M${under ? Math.min(...ends) : row.label_width - 12} ${y}H${Math.max(...ends)}`} />
      <text x="8" y={textY}>
        {line.name}
      </text>
      <text x="8" y={textY + 14} class="small">
        {line.kind.toUpperCase()} {rate}
      </text>
      <g role="img" aria-label={`Load of ${line.name}: ${(state?.load ?? 0).toFixed(1)} %`}>
        <rect class="load-ground" x={meterX} y={meterY} width="84" height="7" rx="2" />
        <rect class={`load${load > 90 ? " full" : load > 60 ? " much" : ""}`} x={meterX} y={meterY} width={load * 0.84} height="7" rx="2" />
        <text x={meterX + 89} y={meterY + 7} class="small">
          {(state?.load ?? 0).toFixed(1)} %
        </text>
      </g>
    </g>
  );
}

function WirePath({ wire, plant, y }: { wire: DrawnWire; plant: Plant; y: number }) {
  const station = wire.from.slice(0, wire.from.lastIndexOf("."));
  const terminal = plant.stations
    .find((one) => one.name === station)
    ?.outputs.find((output) => output.name === wire.from.slice(station.length + 1));
  const level = bitSet(stationState(station).value?.out, terminal?.bit ?? 0) !== wire.invert;
  const { fromX, toX, height } = wire;
  const top = y - height;
  const label = `${wire.from.slice(station.length + 1)} ${wire.invert ? "⊸" : "→"} ${wire.to.slice(wire.to.lastIndexOf(".") + 1)}`;
  return (
    <g>
      <title>{`${wire.from} on ${wire.to}${wire.invert ? ", inverted" : ""}`}</title>
      <path class={`wire${level ? " on" : ""}`} d={`M${fromX} ${y}V${top + 4}Q${fromX} ${top} ${fromX + Math.sign(toX - fromX) * 4} ${top}H${toX - Math.sign(toX - fromX) * 4}Q${toX} ${top} ${toX} ${top + 4}V${y}`} />
      <path class={`wire${level ? " on" : ""}`} d={`M${toX - 4} ${y - 6}L${toX} ${y}L${toX + 4} ${y - 6}`} />
      <text x={(fromX + toX) / 2} y={top - 3} text-anchor="middle" class="small">
        {label}
      </text>
    </g>
  );
}

export function Drawing({ plant }: { plant: Plant }) {
  const frame = useRef<HTMLElement>(null);
  const [width, setWidth] = useState(900);
  useEffect(() => {
    const observer = new ResizeObserver(([entry]) => entry && setWidth(Math.floor(entry.contentRect.width) - 8));
    if (frame.current) observer.observe(frame.current);
    return () => observer.disconnect();
  }, []);
  const rows = layOut(plant, width);
  const last = rows[rows.length - 1];
  const drawn = Math.max(...rows.map((row) => row.width), 0);
  return (
    <section class="panel drawing" aria-label="Drawing of the plant" ref={frame}>
      <svg width={drawn} height={last ? rows.reduce((sum, row) => sum + row.height, 0) : 0}>
        {rows.map((row) => (
          <g key={row.top}>
            {row.lines.map((line, position) => (
              <Cable key={line.name} line={line} row={row} y={cableY(row, position)} />
            ))}
            {row.lines.flatMap((line, position) =>
              row.boxes
                .filter((box) => box.lines.includes(line.name))
                .map((box) => (
                  <Tap
                    key={`${box.name} ${line.name}`}
                    box={box}
                    line={line}
                    from={row.top + box_height}
                    to={cableY(row, position)}
                  />
                )),
            )}
            {row.boxes.map((box) => (
              <StationBox key={box.name} box={box} y={row.top} />
            ))}
            {row.wires.map((wire) => (
              <WirePath key={`${wire.from} ${wire.to}`} wire={wire} plant={plant} y={row.top} />
            ))}
          </g>
        ))}
      </svg>
    </section>
  );
}
