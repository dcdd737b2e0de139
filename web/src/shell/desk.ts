// Which views are open, where they stand, and which of them was used last. A view is open once at most. The layout is kept
// with the plant as long as there are several views; the address has the view that was used last.
import { computed, signal } from "@preact/signals";
import type { FunctionComponent } from "preact";

import { hello } from "../server/live";
import {
  exchange,
  isSplit,
  neighbour,
  place,
  readLayout,
  viewsOf,
  without,
  type Layout,
  type Side,
} from "./layout";
import { comeBack, leave, noteScrolls } from "./scroll_memory";
import { setting, whenSettingsCome } from "./settings";

export interface View {
  name: string;
  notOfDrives?: string; // why real drives do not have it
  body: FunctionComponent;
}

const first_view = "Plant";
const name_of_desk = "Desk"; // in an address, for the default layout

const program_left: Layout = {
  direction: "row",
  parts: [
    { share: 0.5, layout: { view: "Program" } },
    {
      share: 0.5,
      layout: {
        direction: "column",
        parts: [
          { share: 0.5, layout: { view: "Plant" } },
          { share: 0.5, layout: { view: "Scope" } },
        ],
      },
    },
  ],
};

let names: readonly string[] = [];
const kept = setting<Layout | null>("desk.layout", null);

export const layout = signal<Layout>({ view: first_view });
export const activeView = signal(first_view);
export const openViews = computed(() => viewsOf(layout.value));
export const severalOpen = computed(() => isSplit(layout.value));

export function tabId(view: string): string {
  return `tab-${view.toLowerCase()}`;
}

export function paneId(view: string): string {
  return `panel-${view.toLowerCase()}`;
}

export function paneOf(view: string): HTMLElement | null {
  return document.getElementById(paneId(view));
}

export function activate(view: string): void {
  activeView.value = view;
  const address = new URL(location.href);
  address.hash = view;
  address.searchParams.delete(name_of_desk.toLowerCase());
  if (address.href !== location.href) history.replaceState(null, "", address);
}

let putScrollsBack = () => {};

function panesOf(views: readonly string[]): HTMLElement[] {
  return views.flatMap((view) => paneOf(view) ?? []);
}

export function setLayout(next: Layout): void {
  const before = openViews.peek();
  const after = viewsOf(next);
  putScrollsBack = noteScrolls(panesOf(before));
  for (const view of before) {
    const pane = paneOf(view);
    if (pane && !after.includes(view)) leave(view, pane);
  }
  layout.value = next;
  kept.value = isSplit(next) ? next : null;
  activate(after.includes(activeView.peek()) ? activeView.peek() : (after[0] ?? first_view));
}

// While a border is dragged the layout changes with each move; setLayout() follows when it rests.
export function showLayout(next: Layout): void {
  layout.value = next;
}

// When the document has the layout: what was scrolled is so again.
export function settleScrolls(): void {
  putScrollsBack();
  putScrollsBack = () => {};
}

export function followScroll(view: string): () => void {
  const pane = paneOf(view);
  return pane ? comeBack(view, pane) : () => undefined;
}

function focusPane(view: string): void {
  requestAnimationFrame(() => paneOf(view)?.focus());
}

// Shows a view: where it stands already, else in the pane that was used last.
export function open(name: string): void {
  if (!names.includes(name)) return;
  if (!openViews.peek().includes(name)) {
    const next = exchange(layout.peek(), activeView.peek(), name);
    activeView.value = name;
    setLayout(next);
    return;
  }
  activate(name);
  if (severalOpen.peek()) focusPane(name);
}

export function split(view: string, side?: Side): void {
  const beside = activeView.peek();
  const box = paneOf(beside)?.getBoundingClientRect();
  const next = place(layout.peek(), view, beside, side ?? (box && box.width < box.height * 1.2 ? "below" : "right"));
  activeView.value = view;
  setLayout(next);
  focusPane(view);
}

export function move(view: string, beside: string | null, side: Side): void {
  const next = place(layout.peek(), view, beside, side);
  activeView.value = view;
  setLayout(next);
}

export function takePlace(view: string, of: string): void {
  const next = exchange(layout.peek(), of, view);
  activeView.value = view;
  setLayout(next);
}

// Past the view on that side; where there is none, to that side of the whole.
export function moveToSide(view: string, side: Side): void {
  move(view, neighbour(layout.peek(), view, side) ?? null, side);
}

export function close(view: string): void {
  const rest = without(layout.peek(), view);
  if (!rest) return;
  const beside = (["left", "above", "right", "below"] as const).map((side) => neighbour(layout.peek(), view, side)).find(Boolean);
  const next = beside ?? viewsOf(rest)[0] ?? first_view;
  if (activeView.peek() === view) activeView.value = next;
  setLayout(rest);
  focusPane(activeView.peek());
}

export function nextPane(by: number): void {
  const open_now = openViews.peek();
  const next = open_now[(open_now.indexOf(activeView.peek()) + by + open_now.length) % open_now.length];
  if (next && open_now.length > 1) open(next);
}

// What of the view is too long for it moves on by so many pages.
export function scrollPage(pages: number): void {
  const parts = paneOf(activeView.peek())?.querySelectorAll(".view, .view > *, .view > .split > *") ?? [];
  for (const part of parts) {
    if (part.scrollHeight <= part.clientHeight || getComputedStyle(part).overflowY === "visible") continue;
    part.scrollBy({ top: pages * part.clientHeight * 0.9 });
    return;
  }
}

export function openDesk(): void {
  // A real drive does not give its source away.
  const desk = hello.peek()?.mode === "device" ? exchange(program_left, "Program", "Watch") : program_left;
  setLayout(desk);
}

// The address names a view, or the desk.
function followAddress(): boolean {
  const name = decodeURIComponent(location.hash.slice(1));
  const desk = name === name_of_desk || new URLSearchParams(location.search).has(name_of_desk.toLowerCase());
  if (desk) openDesk();
  else open(name);
  return desk;
}

export function offerViews(all: readonly string[]): void {
  names = all;
  const desk = followAddress();
  addEventListener("hashchange", followAddress);
  let wanted = desk;
  whenSettingsCome(() => {
    const found = wanted ? undefined : readLayout(kept.peek(), names);
    if (wanted) openDesk();
    wanted = false;
    if (!found || JSON.stringify(found) === JSON.stringify(layout.peek())) return;
    const used = activeView.peek();
    setLayout(found);
    open(used);
  });
}
