// The tabs, after the ARIA pattern: arrows move between them, all panels but the open one are hidden.
import { signal } from "@preact/signals";
import type { FunctionComponent } from "preact";

import { hello } from "../server/live";

export interface Tab {
  name: string;
  notOfDrives?: string; // why real drives do not have it
  body: FunctionComponent;
}

export const openTab = signal(decodeURIComponent(location.hash.slice(1)) || "Plant");

export function open(name: string): void {
  openTab.value = name;
  history.replaceState(null, "", `#${encodeURIComponent(name)}`);
}

function idOf(name: string): string {
  return name.toLowerCase();
}

export function TabList({ tabs }: { tabs: Tab[] }) {
  const move = (event: KeyboardEvent, position: number) => {
    const last = tabs.length - 1;
    const to = { ArrowRight: position === last ? 0 : position + 1, ArrowLeft: position === 0 ? last : position - 1, Home: 0, End: last }[
      event.key
    ];
    const tab = to === undefined ? undefined : tabs[to];
    if (!tab) return;
    event.preventDefault();
    open(tab.name);
    document.getElementById(`tab-${idOf(tab.name)}`)?.focus();
  };
  return (
    <div role="tablist" aria-label="Views">
      {tabs.map((tab, position) => {
        const selected = openTab.value === tab.name;
        return (
          <button
            key={tab.name}
            role="tab"
            id={`tab-${idOf(tab.name)}`}
            aria-selected={selected}
            aria-controls={`panel-${idOf(tab.name)}`}
            tabIndex={selected ? 0 : -1}
            onClick={() => open(tab.name)}
            onKeyDown={(event) => move(event, position)}
          >
            {tab.name}
          </button>
        );
      })}
    </div>
  );
}

export function TabPanels({ tabs }: { tabs: Tab[] }) {
  return (
    <>
      {tabs.map((tab) => {
        const Body = tab.body;
        const selected = openTab.value === tab.name;
        return (
          <div
            key={tab.name}
            role="tabpanel"
            id={`panel-${idOf(tab.name)}`}
            aria-labelledby={`tab-${idOf(tab.name)}`}
            hidden={!selected}
          >
            {selected && (hello.value?.mode === "device" && tab.notOfDrives ? <p class="empty">{tab.notOfDrives}</p> : <Body />)}
          </div>
        );
      })}
    </>
  );
}
