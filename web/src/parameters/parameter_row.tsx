// One parameter: what it is, what it may be, and a field that sets it.
import { useRef } from "preact/hooks";

import type { Parameter, ParameterValue } from "../server/protocol";
import { command } from "../shell/notice";
import { compare, comparedWith, differences, station, valueOf } from "./parameter_list";

// Not the factory setting. What only shows the value of another one has changed nowhere.
export function isChanged(parameter: Parameter, value: ParameterValue): boolean {
  return value.changed && !parameter.shows;
}

function rangeOf(parameter: Parameter): string {
  if (parameter.choices.length > 0) return parameter.choices.length < 3 ? parameter.choices.join(", ") : `${parameter.choices.length} texts`;
  return parameter.least !== null && parameter.most !== null ? `${parameter.least} … ${parameter.most}` : "";
}

function Field({ parameter, text, name }: { parameter: Parameter; text: string; name: string }) {
  const field = useRef<HTMLInputElement>(null);
  const set = async (value: string) => {
    if (!value) return;
    const reply = await command({ do: "parameters.set", station: station.peek(), number: name, value });
    if (!reply) return;
    if (field.current) field.current.value = "";
    if (comparedWith.peek()) await compare();
  };
  const input = (
    <input
      ref={field}
      type="text"
      aria-label={`Set ${name}`}
      title={parameter.choices.length > 0 ? parameter.choices.join(" | ") : rangeOf(parameter)}
      onKeyDown={(event) => {
        if (event.key === "Enter") void set(event.currentTarget.value.trim());
      }}
    />
  );
  if (parameter.choices.length === 0) return input;
  return (
    <>
      {input}
      <select
        aria-label={`Texts of ${name}`}
        value={parameter.choices.includes(text) ? text : ""}
        onChange={(event) => {
          const list = event.currentTarget;
          // A refusal leaves the list at what the drive has.
          void set(list.value).then(() => (list.value = parameter.choices.includes(valueOf(parameter).peek().text) ? valueOf(parameter).peek().text : ""));
        }}
      >
        {!parameter.choices.includes(text) && <option value="">{text}</option>}
        {parameter.choices.map((choice) => (
          <option key={choice}>{choice}</option>
        ))}
      </select>
    </>
  );
}

function Other({ parameter, name }: { parameter: Parameter; name: string }) {
  const other = differences.value.get(parameter.index);
  const writable = parameter.access !== "R" && parameter.access !== "RO";
  const text = other?.with;
  return (
    <td role="cell" class="other warn">
      {text ?? "–"}
      {writable && typeof text === "string" && (
        <button
          class="small"
          aria-label={`Copy ${name}`}
          title={`${station.value} gets ${text}`}
          onClick={() => void command({ do: "parameters.set", station: station.peek(), number: name, value: text }).then((reply) => reply && compare())}
        >
          Copy
        </button>
      )}
    </td>
  );
}

export function Row({ parameter }: { parameter: Parameter }) {
  const value = valueOf(parameter).value;
  const name = parameter.number || String(parameter.index);
  const ending = ` ${parameter.unit}`;
  const bare = parameter.unit && value.text.endsWith(ending) ? value.text.slice(0, -ending.length) : value.text;
  const writable = parameter.access !== "R" && parameter.access !== "RO";
  const displays = parameter.shows && parameter.number.startsWith("P0");
  const changed = isChanged(parameter, value);
  return (
    <tr role="row" class={changed ? "changed" : ""}>
      <th role="rowheader" scope="row" class="mono number">
        {name}
      </th>
      <td role="cell" class="name" title={parameter.name}>
        {parameter.name}
        {changed && <span class="changed-mark">changed</span>}
      </td>
      <td role="cell" class="value mono">
        {bare}
      </td>
      <td role="cell" class="unit quiet">
        {parameter.unit}
      </td>
      <td role="cell" class="range quiet" title={parameter.choices.length > 0 ? parameter.choices.join(" | ") : rangeOf(parameter)}>
        {rangeOf(parameter)}
      </td>
      <td role="cell" class="factory quiet">
        {parameter.shows ? "" : parameter.default}
      </td>
      {comparedWith.value && <Other parameter={parameter} name={name} />}
      <td role="cell" class="set">
        {displays ? (
          <span class="quiet">shows {parameter.shows}</span>
        ) : writable ? (
          <Field parameter={parameter} text={value.text} name={name} />
        ) : (
          <span class="quiet">read only</span>
        )}
      </td>
    </tr>
  );
}
