// The page of ipos serve: seven views of a plant over one WebSocket.
import { render } from "preact";
import { useEffect } from "preact/hooks";

import { Bus } from "./bus/bus_tab";
import { Journal } from "./journal/journal_tab";
import { Parameters } from "./parameters/parameters_tab";
import { PlantTab } from "./plant/plant_tab";
import { Program } from "./program/program_tab";
import { Scope } from "./scope/scope_tab";
import { connect } from "./server/connection";
import { listenToServer } from "./server/live";
import { Help, helpOpen } from "./shell/help";
import { listenToKeys, offerKeys } from "./shell/keys";
import { Notice } from "./shell/notice";
import { followSettings } from "./shell/settings";
import { open, openTab, TabList, TabPanels, type Tab } from "./shell/tabs";
import { offerTimeKeys, TimeBar } from "./shell/time_bar";
import { Watch } from "./watch/watch_tab";

const tabs: Tab[] = [
  { name: "Plant", body: PlantTab },
  { name: "Watch", body: Watch },
  { name: "Scope", body: Scope },
  { name: "Parameters", body: Parameters },
  { name: "Bus", body: Bus },
  {
    name: "Program",
    body: Program,
    notOfDrives: "A real drive does not give its source away, so to follow a program line by line, run it in a simulated drive: ipos serve FILE.",
  },
  {
    name: "Journal",
    body: Journal,
    notOfDrives: "Only simulated drives keep a journal; what a real one remembers of its faults stands among its parameters.",
  },
];

function focusSearch(): void {
  document.querySelector<HTMLInputElement>('[role="tabpanel"]:not([hidden]) input[type="search"]')?.focus();
}

function offerPageKeys(): void {
  offerKeys("Page", [
    ...tabs.map((tab, position) => ({ key: String(position + 1), text: tab.name, act: () => open(tab.name) })),
    { key: "/", text: "Search field", act: focusSearch },
    { key: "?", text: "This sheet", act: () => (helpOpen.value = true) },
  ]);
}

function Page() {
  useEffect(listenToKeys, []);
  return (
    <>
      <header class="top">
        <TimeBar />
        <TabList tabs={tabs} />
        <Notice />
      </header>
      <main>
        <TabPanels tabs={tabs} />
      </main>
      <Help />
    </>
  );
}

if (!tabs.some((tab) => tab.name === openTab.peek())) openTab.value = "Plant";
listenToServer();
followSettings();
offerTimeKeys();
offerPageKeys();
connect();
render(<Page />, document.getElementById("page") as HTMLElement);
