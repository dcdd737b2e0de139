// The drawing of the plant: boxes on their lines, wires above them, and in slow motion the telegrams on the lines.
import { useEffect, useMemo, useRef, useState } from "preact/hooks";

import type { Plant } from "../server/protocol";
import { box_height, box_width, layOut, type Box, type DrawnWire } from "./drawing_layout";
import { CablePath, LineLabel, pressed, RiserPath, Taps } from "./drawing_lines";
import { bitSet, stationState, wanted } from "./state";
import { TelegramDots, TelegramWords } from "./telegram_dots";

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

// Its way to a station in another row is told, not drawn.
function HalfWire({ wire, level, y }: { wire: DrawnWire; level: boolean; y: number }) {
  const top = y - wire.height;
  const leaves = wire.fromX !== null;
  const x = wire.fromX ?? wire.toX ?? 0;
  return (
    <>
      <path class={`wire${level ? " on" : ""}`} d={`M${x} ${y}V${top}H${x + 14}`} />
      {!leaves && <path class={`wire${level ? " on" : ""}`} d={`M${x - 4} ${y - 6}L${x} ${y}L${x + 4} ${y - 6}`} />}
      <text x={x + 17} y={top + 4} class="small">
        {leaves ? `${wire.invert ? "⊸" : "→"} ${wire.to}` : `from ${wire.from}`}
      </text>
    </>
  );
}

function WholeWire({ wire, level, y, fromX, toX }: { wire: DrawnWire; level: boolean; y: number; fromX: number; toX: number }) {
  const top = y - wire.height;
  const on = level ? " on" : "";
  const side = Math.sign(toX - fromX) * 4;
  const [from, to] = [wire.from, wire.to].map((terminal) => terminal.slice(terminal.lastIndexOf(".") + 1));
  return (
    <>
      <path class={`wire${on}`} d={`M${fromX} ${y}V${top + 4}Q${fromX} ${top} ${fromX + side} ${top}H${toX - side}Q${toX} ${top} ${toX} ${top + 4}V${y}`} />
      <path class={`wire${on}`} d={`M${toX - 4} ${y - 6}L${toX} ${y}L${toX + 4} ${y - 6}`} />
      <text x={(fromX + toX) / 2} y={top - 3} text-anchor="middle" class="small">
        {`${from} ${wire.invert ? "⊸" : "→"} ${to}`}
      </text>
    </>
  );
}

function WirePath({ wire, plant, y }: { wire: DrawnWire; plant: Plant; y: number }) {
  const station = wire.from.slice(0, wire.from.lastIndexOf("."));
  const terminal = plant.stations
    .find((one) => one.name === station)
    ?.outputs.find((output) => output.name === wire.from.slice(station.length + 1));
  const level = bitSet(stationState(station).value?.out, terminal?.bit ?? 0) !== wire.invert;
  return (
    <g>
      <title>{`${wire.from} on ${wire.to}${wire.invert ? ", inverted" : ""}`}</title>
      {wire.fromX === null || wire.toX === null ? (
        <HalfWire wire={wire} level={level} y={y} />
      ) : (
        <WholeWire wire={wire} level={level} y={y} fromX={wire.fromX} toX={wire.toX} />
      )}
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
  const layout = useMemo(() => layOut(plant, width), [plant, width]);
  const { rows, risers } = layout;
  return (
    <section class="panel drawing" aria-label="Drawing of the plant" ref={frame}>
      <svg width={layout.width} height={layout.height}>
        {risers.map((riser) => (
          <RiserPath key={riser.line} riser={riser} />
        ))}
        {rows.flatMap((row) => row.cables.map((cable) => <CablePath key={`${row.top} ${cable.line.name}`} cable={cable} />))}
        {rows.flatMap((row) => row.cables.map((cable) => <Taps key={`${row.top} ${cable.line.name}`} cable={cable} row={row} />))}
        {rows.flatMap((row) => row.boxes.map((box) => <StationBox key={box.name} box={box} y={row.top} />))}
        {rows.flatMap((row) =>
          row.wires.map((wire) => <WirePath key={`${row.top} ${wire.from} ${wire.to}`} wire={wire} plant={plant} y={row.top} />),
        )}
        {rows.flatMap((row) =>
          row.cables.map((cable) => <LineLabel key={`${row.top} ${cable.line.name}`} cable={cable} row={row} layout={layout} />),
        )}
        <TelegramDots layout={layout} />
      </svg>
      <TelegramWords />
    </section>
  );
}
