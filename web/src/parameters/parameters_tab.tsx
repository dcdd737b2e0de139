// The parameters of a station: tree by groups, search, values to set, comparison, files.
import { computed, signal } from "@preact/signals";
import { useEffect, useRef, useState } from "preact/hooks";

import { stationNames } from "../server/live";
import type { Parameter } from "../server/protocol";
import { download } from "../shell/download";
import { command, complain } from "../shell/notice";
import { GroupTree } from "./group_tree";
import { compare, comparedWith, differences, followParameters, load, parameters, save, station, valueOf } from "./parameter_list";

const searchText = signal("");
const group = signal("");
const onlyChanged = signal(false);
// Of the parameter whose field has the focus: what can be set. It stands above the table, so that no row moves.
const hint = signal("");

const shown = computed(() => {
  const words = searchText.value.toLowerCase().split(/\s+/).filter(Boolean);
  const compared = comparedWith.value !== "";
  return parameters.value.filter((parameter) => {
    if (compared && !differences.value.has(parameter.index)) return false;
    if (onlyChanged.value && !valueOf(parameter).value.changed) return false;
    // A search looks at all groups.
    if (words.length === 0) return parameter.group.startsWith(group.value);
    const text = `${parameter.number} ${parameter.index} ${parameter.name}`.toLowerCase();
    return words.every((word) => text.includes(word));
  });
});

function hintOf(parameter: Parameter): string {
  const parts: string[] = [];
  if (parameter.choices.length > 0) parts.push(parameter.choices.join(" | "));
  else if (parameter.least !== null && parameter.most !== null) parts.push(`${parameter.least} … ${parameter.most}`);
  if (parameter.default !== null) parts.push(`factory setting ${parameter.default}`);
  return `${parameter.number || parameter.index} ${parameter.name}: ${parts.join(" · ")}`;
}

function Row({ parameter }: { parameter: Parameter }) {
  const field = useRef<HTMLInputElement>(null);
  const value = valueOf(parameter).value;
  const other = differences.value.get(parameter.index);
  const writable = parameter.access !== "R" && parameter.access !== "RO";
  const ending = ` ${parameter.unit}`;
  const bare = parameter.unit && value.text.endsWith(ending) ? value.text.slice(0, -ending.length) : value.text;
  const set = async () => {
    const text = field.current?.value.trim();
    if (!text) return;
    const reply = await command({ do: "parameters.set", station: station.peek(), number: parameter.number || String(parameter.index), value: text });
    if (!reply) return;
    if (field.current) field.current.value = "";
    if (comparedWith.peek()) await compare();
  };
  return (
    <tr class={value.changed ? "changed" : ""}>
      <th scope="row" class="mono shrink">
        {parameter.number || parameter.index}
      </th>
      <td>
        {parameter.name}
      </td>
      <td class="number">{bare}</td>
      <td class="quiet shrink">{parameter.unit}</td>
      {other && <td class="number warn">{other.with}</td>}
      <td class="shrink">
        {writable ? (
          <input
            ref={field}
            type="text"
            aria-label={`Set ${parameter.number || parameter.index}`}
            title={hintOf(parameter)}
            onFocus={() => (hint.value = hintOf(parameter))}
            onBlur={() => (hint.value = "")}
            onKeyDown={(event) => {
              if (event.key === "Enter") void set();
            }}
          />
        ) : (
          <span class="quiet">read only</span>
        )}
        {value.changed && <span class="changed-mark">changed</span>}
      </td>
    </tr>
  );
}

function Files() {
  const chooser = useRef<HTMLInputElement>(null);
  const [outcome, setOutcome] = useState("");
  const take = async (file: File) => {
    try {
      setOutcome(await load(await file.text()));
    } catch (reason) {
      complain(reason);
    }
  };
  return (
    <>
      <button
        onClick={() =>
          save()
            .then(({ file, text }) => download(file, text))
            .catch(complain)
        }
      >
        Save file
      </button>
      <button onClick={() => chooser.current?.click()}>Load file</button>
      <input
        ref={chooser}
        type="file"
        hidden
        aria-label="File of ipos param"
        onChange={(event) => {
          const file = event.currentTarget.files?.[0];
          event.currentTarget.value = "";
          if (file) void take(file);
        }}
      />
      {outcome && <span class="quiet">{outcome}</span>}
    </>
  );
}

export function Parameters() {
  useEffect(followParameters, []);
  const rows = shown.value;
  return (
    <>
      <div class="bar">
        <label class="field">
          Station
          <select aria-label="Station" value={station.value} onChange={(event) => (station.value = event.currentTarget.value)}>
            {stationNames().map((name) => (
              <option key={name}>{name}</option>
            ))}
          </select>
        </label>
        <input
          type="search"
          aria-label="Search parameters"
          placeholder="Number or name"
          value={searchText.value}
          onInput={(event) => (searchText.value = event.currentTarget.value)}
        />
        <label class="field">
          <input type="checkbox" checked={onlyChanged.value} onChange={(event) => (onlyChanged.value = event.currentTarget.checked)} />
          <span>changed ones</span>
        </label>
        {stationNames().length > 1 && (
          <label class="field">
            Compare with
            <select value={comparedWith.value} onChange={(event) => (comparedWith.value = event.currentTarget.value)}>
              <option value="">nobody</option>
              {stationNames()
                .filter((name) => name !== station.value)
                .map((name) => (
                  <option key={name}>{name}</option>
                ))}
            </select>
          </label>
        )}
        <Files />
      </div>
      <p class="quiet hint">{hint.value || "Changed from the factory setting: number in colour. A field takes a number with unit, or the name of a setting."}</p>
      <div class="split">
        <GroupTree group={group} onChoose={() => (searchText.value = "")} />
        <div class="scroll" tabIndex={0}>
          <table class="values" aria-label="Parameters">
            <thead>
              <tr>
                <th scope="col">Number</th>
                <th scope="col">Name</th>
                <th scope="col" class="number">
                  Value
                </th>
                <th scope="col">Unit</th>
                {comparedWith.value && (
                  <th scope="col" class="number">
                    {comparedWith.value}
                  </th>
                )}
                <th scope="col">Set with Enter</th>
              </tr>
            </thead>
            <tbody>
              {rows.map((parameter) => (
                <Row key={parameter.index} parameter={parameter} />
              ))}
            </tbody>
          </table>
          {rows.length === 0 && <p class="empty">{comparedWith.value ? "No difference." : "No such parameter."}</p>}
        </div>
      </div>
    </>
  );
}
