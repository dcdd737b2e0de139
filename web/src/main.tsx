// The page: seven views of a plant that `ipos serve` has, or a worker of the page itself.
import { render } from "preact";
import { useEffect } from "preact/hooks";

import { standsAlone } from "./alone/packed";
import { inBrowser, offerToPrograms } from "./alone/start";
import { Bus } from "./bus/bus_tab";
import { Gallery } from "./gallery/gallery";
import { Journal } from "./journal/journal_tab";
import { KeepButtons, offerKeepKeys } from "./keep/keep_buttons";
import { Parameters } from "./parameters/parameters_tab";
import { PlantTab } from "./plant/plant_tab";
import { Program } from "./program/program_tab";
import { takeDrops } from "./picture/drop";
import { Scope } from "./scope/scope_tab";
import { openTrace, TraceDialog } from "./scope/trace_dialog";
import { connect } from "./server/connection";
import { overSocket } from "./server/socket";
import { hello, listenToServer } from "./server/live";
import { activeView, close, nextPane, offerViews, open, openDesk, paneOf, scrollPage, type View } from "./shell/desk";
import { Help, helpOpen } from "./shell/help";
import { listenToKeys, offerKeys } from "./shell/keys";
import { Notice } from "./shell/notice";
import { Panes } from "./shell/panes";
import { followSettings } from "./shell/settings";
import { TabList } from "./shell/tabs";
import { offerTimeKeys, TimeBar } from "./shell/time_bar";
import { splitMenuOpen, ViewButtons } from "./shell/view_buttons";
import { Timeline } from "./timeline/timeline";
import { Watch } from "./watch/watch_tab";

const views: View[] = [
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
  paneOf(activeView.peek())?.querySelector<HTMLInputElement>('input[type="search"]')?.focus();
}

function offerPageKeys(): void {
  offerKeys("Page", [
    ...views.map((view, position) => ({ key: String(position + 1), text: view.name, act: () => open(view.name) })),
    { key: "e", text: "One view more", act: () => (splitMenuOpen.value = true) },
    { key: "q", text: "Close the view", act: () => close(activeView.peek()) },
    { key: "w", text: "Next view", act: () => nextPane(1) },
    { key: "W", text: "View before", act: () => nextPane(-1) },
    { key: "d", text: "Desk: program, plant and scope", act: openDesk },
    { key: "PageDown", text: "On in the view", act: () => scrollPage(1) },
    { key: "PageUp", text: "Back in the view", act: () => scrollPage(-1) },
    { key: "/", text: "Search field", act: focusSearch },
    { key: "?", text: "This sheet", act: () => (helpOpen.value = true) },
  ]);
}

function Page() {
  useEffect(listenToKeys, []);
  if (hello.value?.mode === "gallery") return <Gallery />;
  return (
    <>
      <header class="top">
        <TimeBar />
        <div class="views">
          <TabList views={views} />
          <ViewButtons views={views} />
          <KeepButtons />
        </div>
        <Notice />
      </header>
      <Panes views={views} />
      <Timeline />
      <Help />
      <TraceDialog />
    </>
  );
}

listenToServer();
offerViews(views.map((view) => view.name));
followSettings();
offerTimeKeys();
offerPageKeys();
offerToPrograms();
offerKeepKeys();
takeDrops(openTrace);
connect(standsAlone ? inBrowser : overSocket);
render(<Page />, document.getElementById("page") as HTMLElement);
