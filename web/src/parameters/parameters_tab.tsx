// The parameters of a station: tree by groups, search, values to set, comparison, files.
import { computed, signal } from "@preact/signals";
import { useEffect, useRef, useState } from "preact/hooks";

import { stationNames } from "../server/live";
import { download } from "../shell/download";
import { complain, forgive } from "../shell/notice";
import { GroupTree } from "./group_tree";
import { comparedWith, copyAll, differences, followParameters, load, parameters, save, station, valueOf } from "./parameter_list";
import { isChanged, Row } from "./parameter_row";

const searchText = signal("");
const group = signal("");
const onlyChanged = signal(false);
const from_file = "\u0000file"; // no station is called so

const shown = computed(() => {
  const words = searchText.value.toLowerCase().split(/\s+/).filter(Boolean);
  return parameters.value.filter((parameter) => {
    if (comparedWith.value && (parameter.shows || !differences.value.has(parameter.index))) return false;
    if (onlyChanged.value && !isChanged(parameter, valueOf(parameter).value)) return false;
    // A search looks at all groups.
    if (words.length === 0) return parameter.group.startsWith(group.value);
    const text = `${parameter.number} ${parameter.index} ${parameter.name}`.toLowerCase();
    return words.every((word) => text.includes(word));
  });
});

// A hidden chooser of files, and what to do with the text of one.
function useFile(name: string, take: (file: string, text: string) => void) {
  const chooser = useRef<HTMLInputElement>(null);
  const input = (
    <input
      ref={chooser}
      type="file"
      hidden
      aria-label={name}
      onChange={(event) => {
        const file = event.currentTarget.files?.[0];
        event.currentTarget.value = "";
        if (file) file.text().then((text) => take(file.name, text)).catch(complain);
      }}
    />
  );
  return { input, choose: () => chooser.current?.click() };
}

function Compare({ onOutcome }: { onOutcome: (text: string) => void }) {
  const { input, choose } = useFile("File to compare with", (name, text) => (comparedWith.value = { name, text }));
  const other = comparedWith.value;
  const others = stationNames().filter((name) => name !== station.value);
  const selected = other === null ? "" : other.text === undefined ? other.name : from_file;
  const change = (value: string) => {
    if (value === from_file) choose();
    else comparedWith.value = value ? { name: value } : null;
  };
  const count = differences.value.size;
  return (
    <>
      <label class="field">
        Compare with
        <select
          value={selected}
          onChange={(event) => {
            change(event.currentTarget.value);
            event.currentTarget.value = selected; // a chooser may be left without a file
          }}
        >
          <option value="">nobody</option>
          {others.map((name) => (
            <option key={name} value={name}>
              {name}
            </option>
          ))}
          <option value={from_file}>{other?.text === undefined ? "a file …" : other.name}</option>
        </select>
      </label>
      {input}
      {other && (
        <>
          <span role="status">
            {count} {count === 1 ? "difference" : "differences"}
          </span>
          {count > 0 && <button onClick={() => void copyAll().then(onOutcome).catch(complain)}>{`Copy all to ${station.value}`}</button>}
        </>
      )}
    </>
  );
}

function Files({ onOutcome }: { onOutcome: (text: string) => void }) {
  const { input, choose } = useFile("File of ipos param", (_name, text) => void load(text).then(onOutcome).then(forgive).catch(complain));
  const give = (form: "parameters.save" | "parameters.toml") =>
    void save(form)
      .then(({ file, text }) => download(file, text))
      .catch(complain);
  return (
    <>
      <button onClick={() => give("parameters.save")}>Save file</button>
      <button title="[station.parameters]: what is not the factory setting, for the plant file" onClick={() => give("parameters.toml")}>
        Save as TOML
      </button>
      <button onClick={choose}>Load file</button>
      {input}
    </>
  );
}

export function Parameters() {
  useEffect(followParameters, []);
  const [outcome, setOutcome] = useState("");
  const rows = shown.value;
  const other = comparedWith.value;
  return (
    <div class="parameters">
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
        <label class="field" title="Settings that are not the factory's">
          <input type="checkbox" checked={onlyChanged.value} onChange={(event) => (onlyChanged.value = event.currentTarget.checked)} />
          <span>only changed ones</span>
        </label>
        <Compare onOutcome={setOutcome} />
        <Files onOutcome={setOutcome} />
        {outcome && (
          <span class="quiet" role="status">
            {outcome}
          </span>
        )}
      </div>
      <div class="split">
        <GroupTree group={group} onChoose={() => (searchText.value = "")} />
        <div class="scroll" tabIndex={0} role="group" aria-label="List of parameters">
          <table class={other ? "values grid compared" : "values grid"} role="table" aria-label="Parameters">
            <thead role="rowgroup">
              <tr role="row">
                {["Number", "Name", "Value", "Unit", "Range", "Factory", ...(other ? [other.name] : []), "Set with Enter"].map((name) => (
                  <th key={name} role="columnheader" scope="col" class={name === "Set with Enter" ? "set" : name === other?.name ? "other" : name.toLowerCase()}>
                    {name}
                  </th>
                ))}
              </tr>
            </thead>
            <tbody role="rowgroup">
              {rows.map((parameter) => (
                <Row key={`${parameter.number} ${parameter.index} ${parameter.name}`} parameter={parameter} />
              ))}
            </tbody>
          </table>
          {rows.length === 0 && <p class="empty">{other ? "No difference." : "No such parameter."}</p>}
        </div>
      </div>
    </div>
  );
}
