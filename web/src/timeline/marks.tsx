// What has happened when: as a list to go to, and as dots on the slider. Many of them are drawn and listed as groups.
import { computed } from "@preact/signals";
import { useEffect, useLayoutEffect, useRef, useState } from "preact/hooks";

import { PlaceLink, placeIn } from "../program/open_line";
import { plant, secondsText } from "../server/live";
import type { Mark } from "../server/protocol";
import { setting } from "../shell/settings";
import { furthestMs, goTo, marks, nowMs } from "./moments";

const kinds: [kind: Mark["kind"], text: string][] = [
  ["fault", "faults"],
  ["check", "checks of the test"],
  ["click", "clicks"],
  ["trigger", "triggers"],
  ["breakpoint", "breakpoints"],
  ["journal", "the journal"],
];
const no_journal = "no journal";
const listed_singly = 100;
const dot_pitch = 9; // pixels: what is nearer is one dot

const choice = setting<string>("timeline.marks", "");
const shown = computed(() =>
  marks.value.filter(({ kind }) => (choice.value === no_journal ? kind !== "journal" : choice.value === "" || kind === choice.value)),
);

interface Group {
  first: Mark;
  count: number;
}

// Where there are many, those that follow each other and say the same are one.
function listGroups(all: Mark[]): Group[] {
  const groups: Group[] = [];
  for (const mark of all) {
    const last = groups[groups.length - 1];
    const same = last && last.first.kind === mark.kind && last.first.what === mark.what && last.first.station === mark.station;
    if (same && all.length > listed_singly) ++last.count;
    else groups.push({ first: mark, count: 1 });
  }
  return groups;
}

function sentence(mark: Mark): string {
  return [secondsText(mark.us), mark.station, mark.text || mark.what].filter(Boolean).join(" ");
}

// A check that is not met stands in a test, and leads to its line there.
function CheckPlace({ mark }: { mark: Mark }) {
  const place = mark.kind === "check" ? placeIn(mark.text) : undefined;
  return place ? <PlaceLink place={place} text={`${place.file.slice(place.file.lastIndexOf("/") + 1)}:${place.line}`} /> : null;
}

export function MarkList() {
  const list = useRef<HTMLUListElement>(null);
  const groups = listGroups(shown.value);
  const several = (plant.value?.stations.length ?? 0) > 1;
  // The newest stays in sight while time goes on.
  useLayoutEffect(() => {
    if (list.current) list.current.scrollLeft = list.current.scrollWidth;
  }, [groups.length]);
  if (marks.value.length === 0) return <ul aria-label="Marks" class="marks" />;
  return (
    <div class="mark-list">
      <ul ref={list} aria-label="Marks" class="marks">
        {groups.map(({ first, count }) => (
          <li key={`${first.us} ${first.kind} ${first.what} ${first.station}`}>
            <button
              class={`small mark ${first.kind}`}
              title={sentence(first)}
              data-station={several ? first.station : undefined}
              aria-current={Math.floor(first.us / 1000) === nowMs.value ? "time" : undefined}
              onClick={() => goTo(first.us / 1000)}
            >
              {`${secondsText(first.us)} ${first.what}${count > 1 ? ` × ${count}` : ""}`}
            </button>
            <CheckPlace mark={first} />
          </li>
        ))}
      </ul>
      <select aria-label="Show marks" value={choice.value} onChange={(event) => (choice.value = event.currentTarget.value)}>
        <option value="">all marks</option>
        <option value={no_journal}>all but the journal</option>
        {kinds.map(([kind, text]) => (
          <option key={kind} value={kind}>
            only {text}
          </option>
        ))}
      </select>
    </div>
  );
}

// Over the slider, for the eye and the pointer; the list says the same to everybody else.
export function MarkDots() {
  const strip = useRef<HTMLDivElement>(null);
  const [width, setWidth] = useState(600);
  useEffect(() => {
    const observer = new ResizeObserver(([entry]) => entry && setWidth(entry.contentRect.width));
    if (strip.current) observer.observe(strip.current);
    return () => observer.disconnect();
  }, []);
  const end_us = Math.max(1, furthestMs.value * 1000);
  const dots = new Map<number, Mark[]>();
  for (const mark of shown.value) {
    const place = Math.round(((Math.min(mark.us, end_us) / end_us) * width) / dot_pitch);
    dots.set(place, [...(dots.get(place) ?? []), mark]);
  }
  return (
    <div ref={strip} class="mark-dots" aria-hidden="true">
      {[...dots.entries()].map(([place, here]) => {
        const worst = kinds.find(([kind]) => here.some((mark) => mark.kind === kind))?.[0] ?? "journal";
        const first = here.find((mark) => mark.kind === worst) as Mark;
        const more = here.length > 5 ? `\n… ${here.length - 5} more` : "";
        return (
          <span
            key={place}
            class={`dot ${worst}${here.length > 1 ? " several" : ""}`}
            style={{ left: `${Math.min(100, (first.us / end_us) * 100)}%` }}
            title={here.slice(0, 5).map(sentence).join("\n") + more}
            onClick={() => goTo(first.us / 1000)}
          />
        );
      })}
    </div>
  );
}
