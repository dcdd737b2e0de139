// The journal of the plant: what drives ignored, warned of and stopped for. A time leads to the scope.
import { signal } from "@preact/signals";
import { useEffect, useLayoutEffect, useRef } from "preact/hooks";

import { showMoment } from "../scope/window";
import { subscribe } from "../server/connection";
import { generation, hello, secondsText, stationNames } from "../server/live";
import type { JournalEntry } from "../server/protocol";
import { open } from "../shell/desk";

const weights: JournalEntry["weight"][] = ["why", "warning", "fault"];
const weight_names = { why: "reasons", warning: "warnings", fault: "faults" };
const kept_entries = 5000;
const shown_entries = 500;

const entries = signal<JournalEntry[]>([]);
const station = signal("");
const searchText = signal("");
const hiddenWeights = signal<ReadonlySet<string>>(new Set());

function follow(): () => void {
  entries.value = [];
  return subscribe("journal", { rate: 10 }, (event) => {
    const last = entries.peek()[entries.peek().length - 1]?.n ?? -1;
    const fresh = (event.entries as JournalEntry[]).filter((entry) => entry.n > last);
    if (fresh.length > 0) entries.value = [...entries.peek(), ...fresh].slice(-kept_entries);
  });
}

function toggle(weight: string): void {
  const next = new Set(hiddenWeights.value);
  if (!next.delete(weight)) next.add(weight);
  hiddenWeights.value = next;
}

function Entry({ entry }: { entry: JournalEntry }) {
  return (
    <div class={`entry ${entry.weight}`}>
      <span class="mono quiet">{secondsText(entry.us)}</span>
      <strong>{entry.station}</strong>
      <span class="text">{entry.text}</span>
      <button
        class="small"
        aria-label={`Show ${secondsText(entry.us)} in the scope`}
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
  // When the server or time has gone back, the journal starts again.
  useEffect(follow, [generation.value, hello.value]);
  const log = useRef<HTMLDivElement>(null);
  const atEnd = useRef(true);
  // The newest entry stays in sight, unless somebody has scrolled up to read.
  useLayoutEffect(() => {
    if (log.current && atEnd.current) log.current.scrollTop = log.current.scrollHeight;
  }, [entries.value.length]);
  const text = searchText.value.toLowerCase();
  const chosen = entries.value.filter(
    (entry) =>
      !hiddenWeights.value.has(entry.weight) &&
      (!station.value || entry.station === station.value) &&
      (!text || entry.text.toLowerCase().includes(text)),
  );
  return (
    <>
      <div class="bar">
        <input
          type="search"
          aria-label="Search the journal"
          placeholder="Text"
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
        <span class="spread quiet">
          {Math.min(chosen.length, shown_entries)} of {entries.value.length}
        </span>
      </div>
      <div
        ref={log}
        class="panel"
        role="log"
        aria-label="Journal"
        tabIndex={0}
        onScroll={({ currentTarget }) =>
          (atEnd.current = currentTarget.scrollTop + currentTarget.clientHeight > currentTarget.scrollHeight - 30)
        }
      >
        {chosen.slice(-shown_entries).map((entry) => (
          <Entry key={entry.n} entry={entry} />
        ))}
        {chosen.length === 0 && <p class="empty">No entry.</p>}
      </div>
    </>
  );
}
