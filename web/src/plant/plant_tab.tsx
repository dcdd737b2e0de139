// The plant: its drawing, its ports, a card or a row a station, and the faults of its lines.
import { signal, useComputed } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";

import { hello, plant } from "../server/live";
import type { Plant, Station } from "../server/protocol";
import { setting } from "../shell/settings";
import { Drawing } from "./drawing";
import { Jog } from "./jog";
import { LineFaults } from "./line_faults";
import { Ports } from "./ports";
import { followPlant, isOnSilentLine, isUnwell, lineState, lineTrouble, stationState, wanted } from "./state";
import { StationCard } from "./station_card";
import { StationsTable } from "./stations_table";
import { Story } from "./story";

const many = 9; // stations, from which on they are rows

const view = setting<"" | "cards" | "table">("plant.view", "");
const opened = setting<string[]>("plant.open", []);
const only_unwell = setting("plant.unwell", false);
const search = signal("");

const isNotWell = (station: Station) => isUnwell(stationState(station.name).value) || isOnSilentLine(station);

function toggleCard(name: string): void {
  opened.value = opened.value.includes(name) ? opened.value.filter((one) => one !== name) : [...opened.value, name];
}

function Choice({ table }: { table: boolean }) {
  return (
    <div class="bar">
      <input
        type="search"
        aria-label="Search stations"
        placeholder="Station, unit, line…"
        value={search.value}
        onInput={(event) => (search.value = event.currentTarget.value)}
      />
      <label class="field">
        <input type="checkbox" checked={only_unwell.value} onChange={(event) => (only_unwell.value = event.currentTarget.checked)} />
        <span>Only what is not well</span>
      </label>
      <span class="spread group" role="group" aria-label="Show stations as">
        <button class="small" aria-pressed={!table} onClick={() => (view.value = "cards")}>
          Cards
        </button>
        <button class="small" aria-pressed={table} onClick={() => (view.value = "table")}>
          Table
        </button>
      </span>
    </div>
  );
}

function Stations({ description }: { description: Plant }) {
  const root = useRef<HTMLDivElement>(null);
  const shown = useComputed(() => {
    const words = search.value.toLowerCase().split(/\s+/).filter(Boolean);
    const fits = (texts: string[]) => words.every((word) => texts.some((text) => text.toLowerCase().includes(word)));
    return {
      stations: description.stations.filter(
        (one) => fits([one.name, one.unit, one.title, one.program, ...one.lines]) && (!only_unwell.value || isNotWell(one)),
      ),
      lines: description.buses.filter(
        (one) => fits([one.name, one.kind]) && (!only_unwell.value || lineTrouble(lineState(one.name).value) !== ""),
      ),
    };
  });
  const { stations, lines } = shown.value;
  const table = (view.value || (description.stations.length >= many ? "table" : "cards")) === "table";
  const cards = table ? description.stations.filter((one) => opened.value.includes(one.name)) : stations;
  // A click on a box of the drawing.
  useEffect(
    () =>
      wanted.subscribe((wish) => {
        if (!wish) return;
        if (table && !opened.peek().includes(wish.station)) toggleCard(wish.station);
        requestAnimationFrame(() => {
          const card = [...(root.current?.querySelectorAll<HTMLElement>(".station") ?? [])].find((one) => one.getAttribute("aria-label") === wish.station);
          card?.scrollIntoView({ behavior: "smooth", block: "center" });
        });
      }),
    [table],
  );
  return (
    <div ref={root}>
      {description.stations.length > 1 && <Choice table={table} />}
      {table && <StationsTable stations={stations} lines={lines} open={opened.value} toggle={toggleCard} />}
      {!table && stations.length === 0 && description.stations.length > 0 && <p class="empty">All is well, or nothing is called so.</p>}
      <div class="stations">
        {cards.map((station) => (
          <StationCard key={station.name} station={station} plant={description} close={table ? () => toggleCard(station.name) : undefined} />
        ))}
      </div>
    </div>
  );
}

function Lines({ description }: { description: Plant }) {
  if (description.buses.length + description.wires.length === 0) return null;
  if (description.stations.length < many) return <Drawing plant={description} />;
  return (
    <details class="panel">
      <summary>Drawing of the plant</summary>
      <Drawing plant={description} />
    </details>
  );
}

export function PlantTab() {
  const description = plant.value;
  useEffect(followPlant, []);
  if (!description) return <p class="empty">The server has not said yet what the plant has.</p>;
  return (
    <>
      {hello.value?.mode === "device" && <Jog />}
      <Story />
      <Lines description={description} />
      <Ports />
      <Stations description={description} />
      {description.buses.some((bus) => bus.faults.length > 0) && <LineFaults buses={description.buses} />}
    </>
  );
}
