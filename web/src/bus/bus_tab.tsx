// The lines: a row an identifier, load and errors, a telegram to send, the trace.
import { signal } from "@preact/signals";
import { useEffect } from "preact/hooks";

import { subscribe } from "../server/connection";
import { generation, hello, plant } from "../server/live";
import type { BusRow, BusState } from "../server/protocol";
import { command } from "../shell/notice";
import { setting } from "../shell/settings";
import { identityText } from "./identity";
import { Send, SendHint } from "./send";
import { long_data, Trace } from "./trace";

const rows = signal<Map<string, BusRow>>(new Map());
const states = signal<Record<string, BusState>>({});
const line = setting("bus.line", "");

function follow(): () => void {
  rows.value = new Map();
  return subscribe("bus", { rate: 10 }, (event) => {
    const changed = (event.rows ?? []) as BusRow[];
    if (changed.length > 0) {
      const next = new Map(rows.peek());
      for (const row of changed) next.set(`${row.bus} ${row.extended ? 1 : 0} ${String(row.id).padStart(10, "0")}`, row);
      rows.value = next;
    }
    states.value = { ...states.peek(), ...((event.buses ?? {}) as Record<string, BusState>) };
  });
}

function Bytes({ data, changed }: { data: string; changed: number[] }) {
  const bytes = data.match(/[0-9A-Fa-f]{2}/g) ?? [];
  return (
    <>
      {bytes.map((byte, position) => (
        <span key={position} class={`byte${changed.includes(position) ? " new" : ""}`}>
          {byte.toUpperCase()}
        </span>
      ))}
    </>
  );
}

function LineLoads() {
  return (
    <div class="row" style="margin-bottom:10px">
      {Object.entries(states.value).map(([name, state]) => (
        <span key={name} class="panel row" style="padding:6px 10px">
          <strong>{name}</strong>
          <meter min={0} max={100} high={60} value={state.load} aria-label={`Load of ${name}`} />
          <span class="mono">{state.load.toFixed(1)} %</span>
          <span class="quiet mono">{state.frames} telegrams</span>
          <span class={`mono ${state.errors > 0 ? "bad" : "quiet"}`}>{state.errors} {state.errors === 1 ? "error" : "errors"}</span>
          {state.state && <span class="quiet">{state.state}</span>}
        </span>
      ))}
    </div>
  );
}

export function Bus() {
  // When the server or time has gone back, the trace starts again.
  useEffect(follow, [generation.value, hello.value]);
  const kinds = new Map(plant.value?.buses.map((bus) => [bus.name, bus.kind]));
  const chosen = kinds.has(line.value) ? line.value : "";
  const target = chosen || [...kinds.keys()][0] || "";
  const shown = [...rows.value.entries()].filter(([, row]) => !chosen || row.bus === chosen).sort(([a], [b]) => (a < b ? -1 : 1));
  return (
    <>
      <LineLoads />
      <div class="bar">
        <select aria-label="Line" value={chosen} onChange={(event) => (line.value = event.currentTarget.value)}>
          <option value="">all lines</option>
          {[...kinds.keys()].map((name) => (
            <option key={name}>{name}</option>
          ))}
        </select>
        <Send line={target} kind={kinds.get(target) ?? ""} />
        <button
          class="spread"
          onClick={() => {
            rows.value = new Map();
            void command({ do: "bus.clear" });
          }}
        >
          Clear counts
        </button>
      </div>
      <SendHint kind={kinds.get(target) ?? ""} />
      <div class="scroll" tabIndex={0} style="flex-grow:1.3">
        <table class="values" aria-label="Bus">
          <thead>
            <tr>
              <th scope="col">Line</th>
              <th scope="col">Identifier</th>
              <th scope="col" class="number">
                Count
              </th>
              <th scope="col" class="number">
                Per second
              </th>
              <th scope="col">Data</th>
              <th scope="col">Meaning</th>
            </tr>
          </thead>
          <tbody>
            {shown.map(([key, row]) => (
              <tr key={key}>
                <td class="quiet shrink">{row.bus}</td>
                <th scope="row" class="mono identity">
                  {identityText(row, kinds.get(row.bus))}
                </th>
                <td class="number">{row.count}</td>
                <td class="number">{row.rate.toFixed(1)}</td>
                <td class={row.data.length > long_data ? "mono octets" : "mono shrink"}>
                  {row.remote ? "remote" : <Bytes data={row.data} changed={row.changed} />}
                </td>
                <td class="meaning">{row.text}</td>
              </tr>
            ))}
          </tbody>
        </table>
        {shown.length === 0 && <p class="empty">No telegram yet.</p>}
      </div>
      <Trace line={chosen} kinds={kinds} />
    </>
  );
}
