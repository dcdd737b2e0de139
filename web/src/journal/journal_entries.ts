// The entries of the journal as they come, those that are wanted, and both as a file.
import { computed, effect, signal } from "@preact/signals";

import { subscribe } from "../server/connection";
import { generation, hello } from "../server/live";
import type { JournalEntry } from "../server/protocol";
import { shared } from "../server/shared";
import { setting } from "../shell/settings";

const kept_entries = 5000;

export const entries = signal<JournalEntry[]>([]);
export const station = signal("");
export const searchText = signal("");
export const hiddenWeights = signal<ReadonlySet<JournalEntry["weight"]>>(new Set());
export const newestFirst = setting("journal.newest_first", true);

// When the server or time has gone back, the journal starts again.
export const followJournal = shared(() => {
  let stop: (() => void) | undefined;
  const end = effect(() => {
    void generation.value;
    void hello.value;
    stop?.();
    entries.value = [];
    stop = subscribe("journal", { rate: 10 }, (event) => {
      const last = entries.peek().at(-1)?.n ?? -1;
      const fresh = (event.entries as JournalEntry[]).filter((entry) => entry.n > last);
      if (fresh.length > 0) entries.value = [...entries.peek(), ...fresh].slice(-kept_entries);
    });
  });
  return () => {
    end();
    stop?.();
  };
});

// All words of the search must stand in the entry, one with a minus in front must not.
function fits(entry: JournalEntry): boolean {
  const text = `${entry.station} ${entry.text}`.toLowerCase();
  return searchText.value
    .toLowerCase()
    .split(/\s+/)
    .filter((word) => word !== "" && word !== "-")
    .every((word) => (word.startsWith("-") ? !text.includes(word.slice(1)) : text.includes(word)));
}

// Oldest first.
export const chosen = computed(() =>
  entries.value.filter((entry) => !hiddenWeights.value.has(entry.weight) && (!station.value || entry.station === station.value) && fits(entry)),
);

function quoted(text: string): string {
  return /[",\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
}

// RFC 4180, times in seconds.
export function asCsv(rows: JournalEntry[]): string {
  const lines = rows.map((entry) => [(entry.us / 1e6).toFixed(6), entry.station, entry.weight, entry.text].map(quoted).join(","));
  return ["time_s,station,weight,text", ...lines, ""].join("\r\n");
}

export function asText(rows: JournalEntry[]): string {
  return rows.map((entry) => `${(entry.us / 1e6).toFixed(6)} s ${entry.station}: ${entry.text}\n`).join("");
}
