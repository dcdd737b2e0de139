// The lines: load and errors, a row an identifier, a telegram to send, the trace.
import { useEffect } from "preact/hooks";

import { plant } from "../server/live";
import { command } from "../shell/notice";
import { identityText } from "./identity";
import { followRows, keyOf, rows, states } from "./rows";
import { Send } from "./send";
import { Trace } from "./trace";
import { chosenLine, line, lineKinds, pause, paused } from "./trace_state";

// Digits of data that still stand in one line.
const long_data = 40;

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
    <div class="row loads">
      {Object.entries(states.value).map(([name, state]) => (
        <span key={name} class="panel row">
          <strong>{name}</strong>
          <meter min={0} max={100} high={60} value={state.load} aria-label={`Load of ${name}`} />
          <span class="mono">{state.load.toFixed(1)} %</span>
          <span class="quiet mono">{state.frames} telegrams</span>
          <span class={`mono ${state.errors > 0 ? "bad" : "quiet"}`}>
            {state.errors} {state.errors === 1 ? "error" : "errors"}
          </span>
          {state.state && <span class="quiet">{state.state}</span>}
        </span>
      ))}
    </div>
  );
}

function Identifiers() {
  const chosen = chosenLine.value;
  const shown = [...rows.value.entries()].filter(([, row]) => !chosen || row.bus === chosen).sort(([a], [b]) => (a < b ? -1 : 1));
  return (
    <div class="scroll part" tabIndex={0} role="group" aria-label="What runs on the lines">
      <table class="values counts" aria-label="Bus">
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
            <th scope="col">Trace</th>
          </tr>
        </thead>
        <tbody>
          {shown.map(([key, row]) => {
            const name = identityText(row, lineKinds.value.get(row.bus));
            return (
              <tr key={key}>
                <td class="quiet shrink">{row.bus}</td>
                <th scope="row" class="mono identity">
                  {name}
                </th>
                <td class="number">{row.count}</td>
                <td class="number">{row.rate.toFixed(1)}</td>
                <td class={row.data.length > long_data ? "mono octets" : "mono shrink"}>
                  {row.remote ? "remote" : <Bytes data={row.data} changed={row.changed} />}
                </td>
                <td class="meaning">{row.text}</td>
                <td class="shrink">
                  <button class="small" aria-pressed={paused.value.has(keyOf(row))} aria-label={`Mute ${row.bus} ${name}`} onClick={() => pause(row)}>
                    {paused.value.has(keyOf(row)) ? "muted" : "Mute"}
                  </button>
                </td>
              </tr>
            );
          })}
        </tbody>
      </table>
      {shown.length === 0 && <p class="empty">No telegram yet.</p>}
    </div>
  );
}

export function Bus() {
  useEffect(followRows, []);
  const names = plant.value?.buses.map((bus) => bus.name) ?? [];
  return (
    <div class="bus">
      <LineLoads />
      <div class="bar">
        <label class="field">
          Line
          <select aria-label="Line" value={chosenLine.value} onChange={(event) => (line.value = event.currentTarget.value)}>
            <option value="">all lines</option>
            {names.map((name) => (
              <option key={name}>{name}</option>
            ))}
          </select>
        </label>
        <button class="spread" onClick={() => void command({ do: "bus.clear" }).then(() => (rows.value = new Map()))}>
          Clear counts
        </button>
      </div>
      <Send />
      <Identifiers />
      <Trace />
    </div>
  );
}
