// What the scope waits for, how much of the recording lies before it, and how long it is.
import type { ComponentChildren } from "preact";

import { hello, plant, stationNames } from "../server/live";
import type { Trigger } from "../server/protocol";
import { command } from "../shell/notice";
import { scope } from "./window";

const kinds: { kind: Trigger["kind"]; text: string; ofDrives?: boolean }[] = [
  { kind: "none", text: "none", ofDrives: true },
  { kind: "level", text: "level", ofDrives: true },
  { kind: "edge", text: "edge", ofDrives: true },
  { kind: "fault", text: "fault of a drive" },
  { kind: "telegram", text: "telegram" },
  { kind: "line", text: "program line" },
];

function Field({ text, children }: { text: string; children: ComponentChildren }) {
  return (
    <label class="field">
      {text}
      {children}
    </label>
  );
}

// A trigger of that kind that the server can take at once.
function begin(kind: Trigger["kind"]): Trigger {
  const signal = scope.peek()?.channels[0]?.name ?? "";
  const first = plant.peek()?.stations.find((one) => one.program);
  switch (kind) {
    case "level":
      return { kind, signal, value: 0, below: false };
    case "edge":
      return { kind, signal, value: 0, slope: "rising" };
    case "line":
      return { kind, station: first?.name ?? "", file: first?.program ?? "", line: 1 };
    default:
      return { kind };
  }
}

function set(trigger: Trigger): void {
  void command({ do: "scope", trigger: { ...trigger } });
}

function SignalFields({ trigger }: { trigger: Trigger }) {
  return (
    <>
      <Field text="Signal">
        <input type="text" list="signals" value={trigger.signal ?? ""} onChange={(event) => set({ ...trigger, signal: event.currentTarget.value.trim() })} />
      </Field>
      {trigger.kind === "level" ? (
        <Field text="Is">
          <select value={trigger.below ? "below" : "above"} onChange={(event) => set({ ...trigger, below: event.currentTarget.value === "below" })}>
            <option>above</option>
            <option>below</option>
          </select>
        </Field>
      ) : (
        <Field text="Slope">
          <select
            value={trigger.slope ?? "rising"}
            onChange={(event) => set({ ...trigger, slope: event.currentTarget.value as "rising" | "falling" | "either" })}
          >
            <option>rising</option>
            <option>falling</option>
            <option>either</option>
          </select>
        </Field>
      )}
      <Field text="Value">
        <input type="text" value={String(trigger.value ?? 0)} onChange={(event) => set({ ...trigger, value: Number(event.currentTarget.value) })} />
      </Field>
    </>
  );
}

function StationField({ trigger, any }: { trigger: Trigger; any: boolean }) {
  return (
    <Field text="Drive">
      <select
        value={trigger.station ?? ""}
        onChange={(event) => {
          const { station: _old, ...rest } = trigger;
          set(event.currentTarget.value ? { ...rest, station: event.currentTarget.value } : rest);
        }}
      >
        {any && <option value="">any</option>}
        {stationNames().map((name) => (
          <option key={name}>{name}</option>
        ))}
      </select>
    </Field>
  );
}

function TelegramFields({ trigger }: { trigger: Trigger }) {
  const change = (key: "bus" | "id", value: string | number | undefined) => {
    const next: Trigger = { ...trigger };
    delete next[key];
    set(value === undefined ? next : { ...next, [key]: value });
  };
  return (
    <>
      <Field text="Line">
        <select value={trigger.bus ?? ""} onChange={(event) => change("bus", event.currentTarget.value || undefined)}>
          <option value="">any</option>
          {plant.value?.buses.map((bus) => (
            <option key={bus.name}>{bus.name}</option>
          ))}
        </select>
      </Field>
      <Field text="Identifier">
        <input
          type="text"
          placeholder="any"
          value={trigger.id === undefined ? "" : String(trigger.id)}
          onChange={(event) => change("id", event.currentTarget.value ? Number(event.currentTarget.value) : undefined)}
        />
      </Field>
    </>
  );
}

function LineFields({ trigger }: { trigger: Trigger }) {
  return (
    <>
      <StationField trigger={trigger} any={false} />
      <Field text="File">
        <input type="text" value={trigger.file ?? ""} onChange={(event) => set({ ...trigger, file: event.currentTarget.value })} />
      </Field>
      <Field text="Line">
        <input type="text" value={String(trigger.line ?? 1)} onChange={(event) => set({ ...trigger, line: Number(event.currentTarget.value) })} />
      </Field>
    </>
  );
}

export function TriggerForm() {
  const state = scope.value;
  if (!state) return null;
  const { trigger } = state;
  const drive = hello.value?.mode === "device"; // its time does not stand still
  return (
    <fieldset>
      <legend>Trigger</legend>
      <Field text="On">
        <select value={trigger.kind} onChange={(event) => set(begin(event.currentTarget.value as Trigger["kind"]))}>
          {kinds.filter((one) => !drive || one.ofDrives).map((one) => (
            <option key={one.kind} value={one.kind}>
              {one.text}
            </option>
          ))}
        </select>
      </Field>
      {(trigger.kind === "level" || trigger.kind === "edge") && <SignalFields trigger={trigger} />}
      {trigger.kind === "fault" && <StationField trigger={trigger} any />}
      {trigger.kind === "telegram" && <TelegramFields trigger={trigger} />}
      {trigger.kind === "line" && <LineFields trigger={trigger} />}
      {trigger.kind !== "none" && !drive && (
        <Field text="Then">
          <select value={trigger.stop ? "stop" : "on"} onChange={(event) => set({ ...trigger, stop: event.currentTarget.value === "stop" })}>
            <option value="on">time goes on</option>
            <option value="stop">time stands still</option>
          </select>
        </Field>
      )}
      <Field text="Before, %">
        <input type="number" min={0} max={100} value={state.pre} onChange={(event) => void command({ do: "scope", pre: event.currentTarget.valueAsNumber })} />
      </Field>
      <Field text="Length, ms">
        <input
          type="number"
          min={10}
          step={10}
          value={state.length_ms}
          onChange={(event) => void command({ do: "scope", length_ms: event.currentTarget.valueAsNumber })}
        />
      </Field>
    </fieldset>
  );
}
