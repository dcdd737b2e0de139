// The keys of the page: one table that the handler and the help sheet read. What is open may add its own.
import { signal } from "@preact/signals";

import { activeView } from "./desk";
import { setting } from "./settings";

export interface Key {
  key: string;
  text: string;
  act: () => void;
}

export interface KeyGroup {
  title: string;
  keys: Key[];
}

export const keyGroups = signal<KeyGroup[]>([]);
// Single letters can be switched off: speech input types them by mistake (WCAG 2.1.4).
export const keysOn = setting("keys", true);

// Puts the group in place of an earlier one with its title.
export function offerKeys(title: string, keys: Key[]): void {
  keyGroups.value = [...keyGroups.peek().filter((group) => group.title !== title), { title, keys }];
}

export function withdrawKeys(title: string): void {
  keyGroups.value = keyGroups.peek().filter((group) => group.title !== title);
}

function typesText(target: EventTarget | null): boolean {
  if (!(target instanceof HTMLElement)) return false;
  if (target instanceof HTMLInputElement) return target.type !== "checkbox" && target.type !== "radio" && target.type !== "range";
  return target instanceof HTMLSelectElement || target instanceof HTMLTextAreaElement || target.isContentEditable;
}

// Space belongs to a button or switch that was reached by a key; after a click it is the page's.
let by_pointer = false; // what was used last
let focused_by_pointer = false;
let swallowed = false;

const acts_on_space = "button, select, summary, a, input, [role]:not(.pane, [role=log], [role=region])";

function ownsSpace(target: EventTarget | null): boolean {
  if (!(target instanceof HTMLElement)) return false;
  if (typesText(target) && !(target instanceof HTMLSelectElement)) return true;
  return (!focused_by_pointer || target.closest("[role=menu]") !== null) && target.matches(acts_on_space);
}

function find(key: string): Key | undefined {
  const first = keyGroups.value.filter((group) => group.title === activeView.value);
  return [...first, ...keyGroups.value].flatMap((group) => group.keys).find((one) => one.key === key);
}

function handle(event: KeyboardEvent): void {
  if (event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented) return;
  if (event.key === " " ? ownsSpace(event.target) : typesText(event.target)) {
    if (event.key === "Escape") (event.target as HTMLElement).blur();
    return;
  }
  if (document.querySelector("dialog[open]")) return;
  if (!keysOn.value && event.key !== "?") return;
  const found = find(event.key);
  if (!found) return;
  event.preventDefault();
  swallowed = event.key === " ";
  found.act();
}

// Firefox clicks a button when Space goes up.
function release(event: KeyboardEvent): void {
  if (event.key === " " && swallowed) event.preventDefault();
  swallowed = false;
}

export function listenToKeys(): void {
  document.addEventListener("keydown", handle);
  document.addEventListener("keyup", release);
  document.addEventListener("keydown", () => (by_pointer = false), true);
  document.addEventListener("pointerdown", () => (by_pointer = focused_by_pointer = true), true);
  document.addEventListener("focusin", () => (focused_by_pointer = by_pointer), true);
}
