// The machine that a station drives, as a figure `Machine STATION`: where it is in words, and drawn so that it moves.
import type { FunctionComponent } from "preact";

import { machinePicture, stationState } from "../plant/state";
import type { MachinePicture, Plant, Station, StationState } from "../server/protocol";
import { Linear } from "./linear";
import { isAway, pointMarks, switchMarks, type Mark } from "./marks";
import { Belt } from "./belt";
import { Round } from "./round";
import { inUnit, unitText } from "./units";

export interface Drawn {
  station: Station;
  machine: MachinePicture;
  state: StationState;
  marks: Mark[];
}

const pictures: Record<MachinePicture["kind"], FunctionComponent<Drawn>> = {
  axis: Linear,
  hoist: Linear,
  conveyor: Belt,
  turntable: Round,
  winder: Round,
  fan: Round,
  shaft: Round,
};

const plain_shaft: MachinePicture = {
  kind: "shaft",
  unit: "turns",
  per_turn: 1,
  given: false,
  from: null,
  to: null,
  limits: null,
  reference: null,
};

function Words({ machine, state, marks }: { machine: MachinePicture; state: StationState; marks: Mark[] }) {
  const { target, in_position, referenced } = state.machine ?? {};
  const travels = ["axis", "hoist", "turntable"].includes(machine.kind);
  const reached = marks.filter((mark) => mark.on);
  return (
    <figcaption>
      <strong class="mono">{unitText(machine, inUnit(machine, state.position ?? 0))}</strong>
      {travels && isAway(state, target) && !in_position && (
        <span class="quiet mono"> to {unitText(machine, inUnit(machine, target))}</span>
      )}
      {travels && in_position && <span class="quiet"> in position</span>}
      {travels && machine.reference !== null && referenced === false && <span class="quiet"> not referenced</span>}
      {reached.map((mark) => (
        <span key={mark.text} class="reached">
          {mark.text}
        </span>
      ))}
    </figcaption>
  );
}

// Null where nothing is known of its motion.
export function Machine({ station, plant }: { station: Station; plant: Plant }) {
  const state = stationState(station.name).value;
  const machine = machinePicture(station.name).value ?? plain_shaft;
  if (state?.position === undefined) return null;
  const at = (name: string) => stationState(name).value;
  const sensors = switchMarks(station, machine, plant, state, at);
  const Picture = pictures[machine.kind];
  return (
    <figure class={`machine ${machine.kind}`} aria-label={`Machine ${station.name}`}>
      <Words machine={machine} state={state} marks={sensors} />
      <Picture station={station} machine={machine} state={state} marks={[...sensors, ...pointMarks(machine, state)]} />
    </figure>
  );
}
