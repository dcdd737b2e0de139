// A station: display, speed and its machine, status and fault in words, why it is not enabled, its terminals, its switches.
import { useMemo } from "preact/hooks";

import { Machine } from "../machine/machine";
import { hello, isGateway } from "../server/live";
import type { Plant, Station, StationState } from "../server/protocol";
import { command } from "../shell/notice";
import { SevenSegment } from "./seven_segment";
import { machinePicture, stationState } from "./state";
import { Terminals } from "./terminals";

// A machine that is no more than a shaft stands beside the speed, others have their own place below.
function Face({ station, plant, state }: { station: Station; plant: Plant; state: StationState }) {
  const { name } = station;
  const plain = (machinePicture(name).value?.kind ?? "shaft") === "shaft";
  return (
    <div class="face">
      <SevenSegment text={state.powered ? (state.display ?? "") : ""} label={`${name} display`} />
      <div>
        <div class="speed mono">
          {(state.speed ?? 0).toFixed(0)} <small>rpm</small>
        </div>
        <div class="quiet mono">
          {state.position !== undefined && `${state.position} inc`}
          {state.torque !== undefined && ` · ${state.torque.toFixed(0)} % torque`}
        </div>
        {station.ideal_motor && (
          <div class="quiet" title='one of 1.5 kW that keeps every speed; [station.motor] and control = "real" of the plant describe yours'>
            ideal motor
          </div>
        )}
      </div>
      {plain && <Machine station={station} plant={plant} />}
    </div>
  );
}

function Words({ state }: { state: StationState }) {
  const fault = Boolean(state.fault);
  return (
    <div class={`words${fault ? " fault" : state.enabled ? " enabled" : ""}`}>
      <p>
        <strong>{state.powered ? (state.state ?? "") : "switched off"}</strong>
        {state.status !== undefined && (
          <span class="quiet mono"> · status {state.status.toString(16).toUpperCase().padStart(4, "0")}h</span>
        )}
        {state.dc_link !== undefined && state.powered && <span class="quiet mono"> · {state.dc_link.toFixed(0)} V</span>}
      </p>
      {fault && (
        <p>
          {state.error === false ? "Warning" : "Fault"} {state.fault}: {state.fault_text}
        </p>
      )}
      {state.why && <p class="quiet">Not enabled: {state.why}</p>}
    </div>
  );
}

function ProcessData({ state }: { state: StationState }) {
  if (!state.pd_out?.length && !state.pd_in?.length) return null;
  return (
    <div class="row quiet mono">
      <span title="process output data, from the master">PO {state.pd_out?.join(" ")}</span>
      <span title="process input data, to the master">PI {state.pd_in?.join(" ")}</span>
    </div>
  );
}

interface SupplyState {
  name: string;
  powered: boolean;
  mains: boolean | undefined;
  faults: boolean;
}

function Supply({ name, powered, mains, faults }: SupplyState) {
  return (
    <footer>
      {faults && (
        <button aria-label={`Fault reset ${name}`} onClick={() => void command({ do: "reset", station: name })}>
          Fault reset
        </button>
      )}
      {mains !== undefined && (
        <button
          class="spread power"
          aria-label={`Mains ${name}`}
          aria-pressed={mains}
          title="the mains alone; the 24 V supply stays"
          onClick={() => void command({ do: "mains", station: name, on: !mains })}
        >
          <span class={`lamp${mains ? " on" : ""}`} /> Mains
        </button>
      )}
      <button
        class={mains === undefined ? "spread power" : "power"}
        aria-label={`Power ${name}`}
        aria-pressed={powered}
        onClick={() => void command({ do: "power", station: name, on: !powered })}
      >
        <span class={`lamp${powered ? " on" : ""}`} /> Power
      </button>
    </footer>
  );
}

export function StationCard({ station, plant, close }: { station: Station; plant: Plant; close?: (() => void) | undefined }) {
  const state = stationState(station.name).value;
  // Most changes are those of a motion: terminals are drawn again only when one of them has changed.
  const terminals = useMemo(
    () => <Terminals station={station} state={state} around={plant} />,
    [station, plant, state?.in, state?.forced, state?.out, JSON.stringify([state?.analog, state?.analog_outputs])],
  );
  const kind = machinePicture(station.name).value?.kind ?? "shaft";
  const lamp = !state?.powered ? "" : state.fault ? (state.error === false ? "warning" : "fault") : state.enabled ? "on" : "";
  return (
    <section class="panel station" aria-label={station.name}>
      <header>
        <span class={`lamp ${lamp}`} />
        <h2>{station.name}</h2>
        <span class="quiet">{station.title || station.unit}</span>
        <span class="spread quiet">{station.program}</span>
        {close && (
          <button class="small" aria-label={`Close card of ${station.name}`} onClick={close}>
            ✕
          </button>
        )}
      </header>
      <div class={`front ${kind}`}>
        <div class="told">
          {state && station.drive && <Face station={station} plant={plant} state={state} />}
          {state && <Words state={state} />}
        </div>
        {kind !== "shaft" && <Machine station={station} plant={plant} />}
      </div>
      {terminals}
      {state && <ProcessData state={state} />}
      {hello.value?.mode === "plant" && <Supply name={station.name} powered={state?.powered ?? false} mains={state?.mains} faults={!isGateway(station)} />}
    </section>
  );
}
