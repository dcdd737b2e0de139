// Faults of the lines: injected at a click, ended at another.
import { useState } from "preact/hooks";

import type { Line, PlantedFault } from "../server/protocol";
import { command } from "../shell/notice";
import { lineState } from "./state";

function faultText(fault: PlantedFault): string {
  const where = fault.station ? ` at ${fault.station}` : "";
  const which = fault.id === undefined || fault.id === null ? "" : `, only ${fault.id}`;
  const often = fault.rate === undefined || fault.rate === null || fault.rate >= 1 ? "" : `, ${fault.rate * 100} %`;
  return `${fault.kind}${where}${which}${often}`;
}

function Planted({ line }: { line: Line }) {
  const faults = lineState(line.name).value?.faults ?? [];
  return (
    <>
      {faults.map((fault) => (
        <button
          key={`${fault.kind} ${fault.station ?? ""} ${fault.id ?? ""}`}
          class="danger"
          title="Ends this fault"
          onClick={() =>
            void command({
              do: "fault",
              bus: line.name,
              kind: fault.kind,
              on: false,
              ...(fault.station ? { station: fault.station } : {}),
              ...(typeof fault.id === "number" ? { identifier: fault.id } : {}),
            })
          }
        >
          {line.name}: {faultText(fault)} ✕
        </button>
      ))}
    </>
  );
}

export function LineFaults({ buses }: { buses: Line[] }) {
  const lines = buses.filter((bus) => bus.faults.length > 0);
  const [name, setName] = useState("");
  const [kind, setKind] = useState("");
  const [station, setStation] = useState("");
  const [id, setId] = useState("");
  const [percent, setPercent] = useState("100");
  const line = lines.find((bus) => bus.name === name) ?? lines[0];
  if (!line) return null;
  // Another line may not have the kind or the station that was chosen.
  const chosen = line.faults.includes(kind) ? kind : (line.faults[0] ?? "");
  const rule = line.fault_rules[chosen];
  const at = rule?.station !== "none" && line.stations.includes(station) ? station : "";
  const plantIt = () =>
    void command({
      do: "fault",
      bus: line.name,
      kind: chosen,
      on: true,
      ...(at ? { station: at } : {}),
      ...(rule?.identifier && id ? { identifier: Number(id) } : {}),
      ...(rule?.rate && percent !== "100" ? { rate: Number(percent) / 100 } : {}),
    });
  return (
    <section class="panel faults" aria-label="Line faults">
      <h2 class="caption">Line faults</h2>
      <div class="row">
        <label class="field">
          Line
          <select value={line.name} onChange={(event) => setName(event.currentTarget.value)}>
            {lines.map((bus) => (
              <option key={bus.name}>{bus.name}</option>
            ))}
          </select>
        </label>
        <label class="field" title={rule && `The line ${rule.text}`}>
          Kind
          <select value={chosen} onChange={(event) => setKind(event.currentTarget.value)}>
            {line.faults.map((one) => (
              <option key={one}>{one}</option>
            ))}
          </select>
        </label>
        {rule?.station !== "none" && (
          <label class="field">
            {line.kind === "can" ? "At" : "Sent by"}
            <select value={at} onChange={(event) => setStation(event.currentTarget.value)}>
              <option value="">{rule?.station === "must" ? "choose a station" : "all"}</option>
              {line.stations.map((one) => (
                <option key={one}>{one}</option>
              ))}
            </select>
          </label>
        )}
        {rule?.identifier && (
          <label class="field">
            Identifier
            <input type="text" size={5} value={id} placeholder="any" onInput={(event) => setId(event.currentTarget.value)} />
          </label>
        )}
        {rule?.rate && (
          <label class="field">
            How often
            <select value={percent} onChange={(event) => setPercent(event.currentTarget.value)}>
              {["100", "50", "10", "1"].map((one) => (
                <option key={one} value={one}>
                  {one} %
                </option>
              ))}
            </select>
          </label>
        )}
        <button class="danger" onClick={plantIt}>
          Inject
        </button>
      </div>
      <div class="row">
        {buses.map((bus) => (
          <Planted key={bus.name} line={bus} />
        ))}
      </div>
    </section>
  );
}
