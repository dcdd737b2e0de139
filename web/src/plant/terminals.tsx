// The terminals of a station: inputs to switch, to pulse and to force, outputs as lamps, analog signals as sliders.
import { useState } from "preact/hooks";

import type { Analog, Barrier, Cam, Station, StationState, Terminal, Wire } from "../server/protocol";
import { command } from "../shell/notice";
import { bitSet } from "./state";

interface Around {
  wires: Wire[];
  switches: Cam[];
  barriers?: Barrier[];
}

// What drives an input beside a person.
function driver(name: string, { wires, switches, barriers }: Around): string {
  const wire = wires.find((one) => one.to === name);
  if (wire) return `${wire.invert ? "not " : ""}${wire.from}`;
  const barrier = barriers?.find((one) => one.input === name);
  if (barrier) return `part at ${barrier.at} on ${barrier.belt}`;
  const cam = switches.find((one) => one.input === name);
  return cam ? `cam ${cam.from ?? "−∞"} … ${cam.to ?? "∞"}` : "";
}

function PulseSign() {
  return (
    <svg viewBox="0 0 14 12" width="14" height="12" aria-hidden="true">
      <path d="M1 10H4V2H9V10H13" fill="none" stroke="currentColor" stroke-width="1.6" />
    </svg>
  );
}

function Input({ station, input, state, around }: { station: string; input: Terminal; state: StationState | null; around: Around }) {
  const on = bitSet(state?.in, input.bit);
  const forced = bitSet(state?.forced, input.bit);
  const full = `${station} ${input.name}`;
  const order = (action: string, level?: boolean) =>
    void command({ do: "input", station, name: input.name, action, ...(level === undefined ? {} : { on: level }) });
  const source = driver(`${station}.${input.name}`, around);
  return (
    <div class="input-row">
      <button
        role="switch"
        aria-label={full}
        aria-checked={on}
        class={forced ? "forced" : ""}
        title={forced ? "forced" : input.function}
        onClick={() => order(forced ? "force" : "set", !on)}
      />
      <span class="mono">{input.name}</span>
      <span class="function" title={input.function}>
        {input.function}
        {source && ` ← ${source}`}
      </span>
      <span class="group">
        <button class="small" aria-label={`Pulse ${full}`} title={`${on ? "off" : "on"} for 100 ms`} onClick={() => order("pulse", !on)}>
          <PulseSign />
        </button>
        <button
          class="small"
          aria-label={`Force ${full}`}
          aria-pressed={forced}
          title={forced ? "give it back to wire, cam or switch" : "hold it against wire and cam"}
          onClick={() => (forced ? order("release") : order("force", on))}
        >
          F
        </button>
      </span>
    </div>
  );
}

function Output({ station, output, state }: { station: string; output: Terminal; state: StationState | null }) {
  const on = bitSet(state?.out, output.bit);
  return (
    <div class="output-row">
      <span class={`lamp${on ? " on" : ""}`} />
      <span class="mono">{output.name}</span>
      <span class="function" title={output.function}>
        {output.function}
      </span>
      <span role="status" aria-label={`${station} ${output.name}`} class={`mono ${on ? "good" : "quiet"}`}>
        {on ? "on" : "off"}
      </span>
    </div>
  );
}

function AnalogInput({ station, analog, text }: { station: string; analog: Analog; text: string }) {
  const unit = analog.units.find((one) => text.endsWith(one)) ?? analog.units[0] ?? "";
  const [held, hold] = useState<number | null>(null);
  const value = held ?? (Number.parseFloat(text) || 0);
  const send = (to: number) => void command({ do: "analog", station, name: analog.name, value: `${to} ${unit}` });
  return (
    <label class="analog-row">
      <span class="mono">{analog.name}</span>
      <input
        type="range"
        aria-label={`${station} ${analog.name}`}
        min={analog.least}
        max={analog.most}
        step={(analog.most - analog.least) / 200}
        value={value}
        onInput={(event) => {
          hold(event.currentTarget.valueAsNumber);
          send(event.currentTarget.valueAsNumber);
        }}
        onChange={() => hold(null)}
      />
      <output class="mono">{text || `0 ${unit}`}</output>
    </label>
  );
}

function AnalogOutputs({ station, state }: { station: Station; state: StationState | null }) {
  if (!station.analog_outputs?.length) return null;
  return (
    <div class="outputs">
      {station.analog_outputs.map((output) => (
        <div class="output-row" key={output.name}>
          <span class="lamp" />
          <span class="mono">{output.name}</span>
          <span class="function" title={output.function}>
            {output.function}
          </span>
          <span role="status" aria-label={`${station.name} ${output.name}`} class="mono">
            {state?.analog_outputs?.[output.name] ?? ""}
          </span>
        </div>
      ))}
    </div>
  );
}

// Terminals without function that nobody has touched are folded away.
function isFolded(terminal: Terminal, ...masks: (number | undefined)[]): boolean {
  return terminal.used === false && !masks.some((mask) => bitSet(mask, terminal.bit));
}

export function Terminals({ station, state, around }: { station: Station; state: StationState | null; around: Around }) {
  const input = (one: Terminal) => <Input key={one.name} station={station.name} input={one} state={state} around={around} />;
  const output = (one: Terminal) => <Output key={one.name} station={station.name} output={one} state={state} />;
  const idle_inputs = station.inputs.filter((one) => isFolded(one, state?.in, state?.forced));
  const idle_outputs = station.outputs.filter((one) => isFolded(one, state?.out));
  const inputs = station.inputs.filter((one) => !idle_inputs.includes(one));
  const outputs = station.outputs.filter((one) => !idle_outputs.includes(one));
  const idle = idle_inputs.length + idle_outputs.length;
  return (
    <>
      {inputs.length > 0 && <div class="inputs">{inputs.map(input)}</div>}
      {outputs.length > 0 && <div class="outputs">{outputs.map(output)}</div>}
      {station.analog.length > 0 && (
        <div class="inputs">
          {station.analog.map((analog) => (
            <AnalogInput key={analog.name} station={station.name} analog={analog} text={state?.analog?.[analog.name] ?? ""} />
          ))}
        </div>
      )}
      <AnalogOutputs station={station} state={state} />
      {idle > 0 && (
        <details class="unused">
          <summary>
            {idle} unused terminal{idle === 1 ? "" : "s"}
          </summary>
          <div class="inputs">{idle_inputs.map(input)}</div>
          <div class="outputs">{idle_outputs.map(output)}</div>
        </details>
      )}
    </>
  );
}
