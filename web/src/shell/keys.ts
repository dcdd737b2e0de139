// The keys of the page: one table that the handler and the help sheet read. What is open may add its own.
import { signal } from "@preact/signals";

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
  if (target instanceof HTMLInputElement) return target.type !== "checkbox" && target.type !== "range";
  return target instanceof HTMLSelectElement || target instanceof HTMLTextAreaElement;
}

function handle(event: KeyboardEvent): void {
  if (event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented) return;
  if (typesText(event.target)) {
    if (event.key === "Escape") (event.target as HTMLElement).blur();
    return;
  }
  if (document.querySelector("dialog[open]")) return;
  if (!keysOn.value && event.key !== "?") return;
  // Space belongs to the button that has the focus.
  if (event.key === " " && event.target instanceof HTMLElement && event.target.closest("button, [role], a, input"))
    return;
  for (const group of keyGroups.value) {
    const found = group.keys.find((key) => key.key === event.key);
    if (found) {
      event.preventDefault();
      found.act();
      return;
    }
  }
}

export function listenToKeys(): void {
  document.addEventListener("keydown", handle);
}
