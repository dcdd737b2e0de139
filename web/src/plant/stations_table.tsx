// Many stations as a table of compact rows, of which only those in sight are made. A click on one opens its card below.
import { inUnit, unitText } from "../machine/units";
import { time } from "../server/live";
import type { Line, Station } from "../server/protocol";
import { Rows } from "../shell/rows";
import { isUnwell, lineState, lineTrouble, machinePicture, stationState } from "./state";

const height = 480; // of the box that scrolls

function lampOf(station: Station): string {
  const state = stationState(station.name).value;
  if (!state?.powered) return "";
  if (state.fault) return state.error === false ? "warning" : "fault";
  return state.enabled ? "on" : isUnwell(state) ? "warning" : "";
}

function StationRow({ station, position, isOpen, toggle }: { station: Station; position: number; isOpen: boolean; toggle: () => void }) {
  const state = stationState(station.name).value;
  const machine = machinePicture(station.name).value;
  const reason = state?.fault ? `fault ${state.fault}: ${state.fault_text}` : (state?.why ?? "");
  const words = !state ? "" : state.powered ? (state.state ?? "") : "off";
  return (
    <tr aria-rowindex={position + 2} class={isUnwell(state) ? "unwell" : ""} onClick={toggle}>
      <th scope="row">
        <span class={`lamp ${lampOf(station)}`} />
        <button
          class="plain"
          aria-expanded={isOpen}
          onClick={(event) => {
            event.stopPropagation();
            toggle();
          }}
        >
          {station.name}
        </button>
      </th>
      <td class="state" title={words}>
        {words}
      </td>
      <td class="why" title={reason}>
        {reason}
      </td>
      <td class="number wide">{state?.speed === undefined ? "" : `${state.speed.toFixed(0)} rpm`}</td>
      <td class="number wide">{machine && state?.position !== undefined ? unitText(machine, inUnit(machine, state.position)) : ""}</td>
      <td class="lines wide">{station.lines.join(" ")}</td>
    </tr>
  );
}

function LineRow({ line, position }: { line: Line; position: number }) {
  const state = lineState(line.name).value;
  const trouble = lineTrouble(state);
  return (
    <tr aria-rowindex={position + 2} class={trouble ? "unwell" : ""}>
      <th scope="row">
        <span class={`lamp ${trouble ? "warning" : time.value.us > 0 ? "on" : ""}`} /> {line.name}
      </th>
      <td class="state">{line.kind.toUpperCase()}</td>
      <td class="why">{trouble}</td>
      <td class="number wide">{state ? `${state.load.toFixed(1)} %` : ""}</td>
      <td class="number wide">{state ? `${state.frames} frames` : ""}</td>
      <td class="lines wide" />
    </tr>
  );
}

export function StationsTable({
  stations,
  lines,
  open,
  toggle,
}: {
  stations: Station[];
  lines: Line[];
  open: string[];
  toggle: (name: string) => void;
}) {
  const count = lines.length + stations.length;
  return (
    <div class="scroll stations-table" tabIndex={0} style={{ maxHeight: `${height}px` }}>
      <table aria-label="Stations" aria-rowcount={count + 1}>
        <thead>
          <tr>
            <th scope="col">Station</th>
            <th scope="col">State</th>
            <th scope="col">Why not</th>
            <th scope="col" class="number wide">
              Speed
            </th>
            <th scope="col" class="number wide">
              Position
            </th>
            <th scope="col" class="wide">
              Lines
            </th>
          </tr>
        </thead>
        <Rows
          items={[...lines, ...stations]}
          short={0}
          row={(item, position) =>
            position < lines.length ? (
              <LineRow key={`line ${item.name}`} line={item as Line} position={position} />
            ) : (
              <StationRow
                key={item.name}
                station={item as Station}
                position={position}
                isOpen={open.includes(item.name)}
                toggle={() => toggle(item.name)}
              />
            )
          }
        />
      </table>
      {count === 0 && <p class="empty">All is well, or nothing is called so.</p>}
    </div>
  );
}
