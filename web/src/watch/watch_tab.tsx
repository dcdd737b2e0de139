// The watch window: names with their values, to search, to set and to force.
import { useEffect, useRef } from "preact/hooks";

import { hello, stationNames } from "../server/live";
import type { WatchName } from "../server/protocol";
import { command } from "../shell/notice";
import { Rows } from "../shell/rows";
import { setting } from "../shell/settings";
import {
  chosenGroup,
  chosenStation,
  followWatch,
  found,
  groups,
  inSight,
  pin,
  pinned,
  searchText,
  shown,
  total,
  valueOf,
} from "./watch_list";

const hexadecimal = setting("watch.hexadecimal", false);

function Row({ one, isPinned, position }: { one: WatchName; isPinned: boolean; position: number }) {
  const field = useRef<HTMLInputElement>(null);
  const value = valueOf(one.name).value;
  const send = async (order: "set" | "force") => {
    const text = field.current?.value.trim() || String(value?.value ?? 0);
    if ((await command({ do: order, name: one.name, value: text })) && field.current) field.current.value = "";
  };
  return (
    <tr class={isPinned ? "changed" : ""} aria-rowindex={position + 2}>
      <th scope="row" class="mono">
        {one.name}
      </th>
      <td class="number">{value ? (hexadecimal.value ? value.hex : value.text) : "–"}</td>
      <td class="quiet unit">{value?.text.endsWith(one.unit) && !hexadecimal.value ? "" : one.unit}</td>
      <td class="shrink set">
        {one.writable && (
          <span class="row" style="flex-wrap:nowrap">
            <input
              ref={field}
              type="text"
              aria-label={`Set ${one.name}`}
              onKeyDown={(event) => {
                if (event.key === "Enter") void send("set");
              }}
            />
            <button
              class="small"
              aria-label={`Force ${one.name}`}
              aria-pressed={value?.forced ?? false}
              title="Holds the value in the field, or the one it has, against the program"
              onClick={() => (value?.forced ? void command({ do: "release", name: one.name }) : void send("force"))}
            >
              Force
            </button>
          </span>
        )}
      </td>
      <td class="quiet text">{one.text}</td>
      <td class="shrink pin">
        <button class="small" aria-label={`Pin ${one.name}`} aria-pressed={isPinned} title="Stays at the top" onClick={() => pin(one)}>
          {isPinned ? "★" : "☆"}
        </button>
      </td>
    </tr>
  );
}

export function Watch() {
  useEffect(followWatch, []);
  const pins = new Set(pinned.value.map((one) => one.name));
  return (
    <>
      <div class="bar">
        <input
          type="search"
          aria-label="Search names"
          placeholder={hello.value?.mode === "device" ? "Names: P000, P004, H20" : "Variables, parameters, process words…"}
          value={searchText.value}
          onInput={(event) => (searchText.value = event.currentTarget.value)}
        />
        <select aria-label="Unit" value={chosenStation.value} onChange={(event) => (chosenStation.value = event.currentTarget.value)}>
          <option value="">all stations</option>
          {stationNames().map((name) => (
            <option key={name}>{name}</option>
          ))}
        </select>
        <select
          aria-label="Group"
          value={chosenGroup.value ?? ""}
          onChange={(event) => (chosenGroup.value = event.currentTarget.value || null)}
        >
          <option value="">{searchText.value ? "all groups" : "named variables"}</option>
          {groups.value.map((name) => (
            <option key={name}>{name}</option>
          ))}
        </select>
        <label class="field">
          <input type="checkbox" checked={hexadecimal.value} onChange={(event) => (hexadecimal.value = event.currentTarget.checked)} />
          <span>hexadecimal</span>
        </label>
        <span class="spread quiet">
          {found.value.length < total.value ? `${found.value.length} of ${total.value} found` : `${total.value} found`}
        </span>
      </div>
      <div class="scroll" tabIndex={0}>
        <table class="values watch" aria-label="Watch" aria-rowcount={shown.value.length + 1}>
          <thead>
            <tr>
              <th scope="col">Name</th>
              <th scope="col" class="number">
                Value
              </th>
              <th scope="col">Unit</th>
              <th scope="col">Set, force</th>
              <th scope="col">What it is</th>
              <th scope="col" class="shrink">
                Pin
              </th>
            </tr>
          </thead>
          <Rows
            items={shown.value}
            row={(one, position) => <Row key={one.name} one={one} isPinned={pins.has(one.name)} position={position} />}
            onRange={(range) => (inSight.value = range)}
          />
        </table>
        {shown.value.length === 0 && (
          <p class="empty">
            {groups.value.length === 0 && hello.value?.mode === "plant" ? "The server is asked." : "No name is found. Without a search the variables of the programs stand here."}
          </p>
        )}
      </div>
    </>
  );
}
