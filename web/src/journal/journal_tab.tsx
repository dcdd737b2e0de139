// The journal of the plant: what drives ignored, warned of and stopped for. A time leads to its moment, a place to its line.
import { useEffect, useLayoutEffect, useRef } from "preact/hooks";

import { TextWithPlaces } from "../program/open_line";
import { showMoment } from "../scope/window";
import { secondsText, stationNames } from "../server/live";
import type { JournalEntry } from "../server/protocol";
import { download } from "../shell/download";
import { open } from "../shell/desk";
import { goTo, noPast } from "../timeline/moments";
import { asCsv, asText, chosen, entries, followJournal, hiddenWeights, newestFirst, searchText, station } from "./journal_entries";

const weights: JournalEntry["weight"][] = ["why", "warning", "fault"];
const weight_names = { why: "reasons", warning: "warnings", fault: "faults" };
const shown_entries = 500;

function toggle(weight: JournalEntry["weight"]): void {
  const next = new Set(hiddenWeights.value);
  if (!next.delete(weight)) next.add(weight);
  hiddenWeights.value = next;
}

function Entry({ entry }: { entry: JournalEntry }) {
  const at = secondsText(entry.us);
  return (
    <div class={`entry ${entry.weight}`}>
      {noPast.value ? (
        <span class="mono quiet">{at}</span>
      ) : (
        <button class="link mono" aria-label={`Go to ${at}`} title="Go to this moment" onClick={() => goTo(entry.us / 1000)}>
          {at}
        </button>
      )}
      <strong>{entry.station}</strong>
      <span class="text">
        <TextWithPlaces of={entry.station} text={entry.text} />
      </span>
      <button
        class="small"
        aria-label={`Show ${at} in the scope`}
        onClick={() => {
          showMoment(entry.us);
          open("Scope");
        }}
      >
        Scope
      </button>
    </div>
  );
}

export function Journal() {
  useEffect(followJournal, []);
  const log = useRef<HTMLDivElement>(null);
  const follows = useRef(true);
  const down = !newestFirst.value;
  // The newest entry stays in sight, unless somebody has scrolled away to read.
  useLayoutEffect(() => {
    if (log.current && follows.current) log.current.scrollTop = down ? log.current.scrollHeight : 0;
  }, [entries.value.length, down]);
  const rows = chosen.value.slice(-shown_entries);
  return (
    <>
      <div class="bar">
        <input
          type="search"
          aria-label="Search the journal"
          placeholder="F26 -warning"
          title="All words must stand in an entry, one with a minus must not"
          value={searchText.value}
          onInput={(event) => (searchText.value = event.currentTarget.value)}
        />
        <select aria-label="From" value={station.value} onChange={(event) => (station.value = event.currentTarget.value)}>
          <option value="">all stations</option>
          {stationNames().map((name) => (
            <option key={name}>{name}</option>
          ))}
        </select>
        {weights.map((weight) => (
          <label key={weight} class="field">
            <input type="checkbox" checked={!hiddenWeights.value.has(weight)} onChange={() => toggle(weight)} />
            <span>{weight_names[weight]}</span>
          </label>
        ))}
        <label class="field">
          <input type="checkbox" checked={newestFirst.value} onChange={(event) => (newestFirst.value = event.currentTarget.checked)} />
          <span>newest first</span>
        </label>
        <button onClick={() => download("journal.txt", asText(chosen.value))}>Save as text</button>
        <button onClick={() => download("journal.csv", asCsv(chosen.value))}>Save as CSV</button>
        <span class="spread quiet">
          {rows.length} of {entries.value.length}
        </span>
      </div>
      <div
        ref={log}
        class="panel"
        role="log"
        aria-label="Journal"
        tabIndex={0}
        onScroll={({ currentTarget }) =>
          (follows.current = down
            ? currentTarget.scrollTop + currentTarget.clientHeight > currentTarget.scrollHeight - 30
            : currentTarget.scrollTop < 30)
        }
      >
        {(down ? rows : [...rows].reverse()).map((entry) => (
          <Entry key={entry.n} entry={entry} />
        ))}
        {rows.length === 0 && <p class="empty">No entry.</p>}
      </div>
    </>
  );
}
