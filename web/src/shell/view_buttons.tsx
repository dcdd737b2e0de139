// Beside the tabs: one view more, and the default layout.
import { signal } from "@preact/signals";
import { useLayoutEffect, useRef, useState } from "preact/hooks";

import { openDesk, openViews, split, type View } from "./desk";
import type { Side } from "./layout";

export const splitMenuOpen = signal(false);

const sides: { side: Side | undefined; text: string }[] = [
  { side: undefined, text: "Where there is room" },
  { side: "right", text: "To the right" },
  { side: "below", text: "Below" },
];

function moveInMenu(event: KeyboardEvent): void {
  const menu = event.currentTarget;
  if (!(menu instanceof HTMLElement)) return;
  const items = [...menu.querySelectorAll<HTMLElement>("[role^=menuitem]")];
  const at = items.findIndex((item) => item === document.activeElement);
  const letter = event.key.length === 1 && event.key !== " " ? event.key.toLowerCase() : undefined;
  const to = { ArrowDown: at + 1, ArrowUp: at - 1, Home: 0, End: -1 }[event.key];
  const found =
    to !== undefined
      ? items.at(to % items.length)
      : letter && [...items.slice(at + 1), ...items].find((item) => item.textContent?.toLowerCase().startsWith(letter));
  if (found) found.focus();
  if (found || letter) event.preventDefault();
}

function SplitMenu({ views }: { views: View[] }) {
  const menu = useRef<HTMLDivElement>(null);
  const [side, setSide] = useState<Side | undefined>(undefined);
  const shut = () => (splitMenuOpen.value = false);
  useLayoutEffect(() => {
    menu.current?.querySelector<HTMLElement>("[role^=menuitem]")?.focus();
    const outside = (event: PointerEvent) => {
      if (event.target instanceof Node && !menu.current?.parentElement?.contains(event.target)) shut();
    };
    document.addEventListener("pointerdown", outside);
    return () => document.removeEventListener("pointerdown", outside);
  }, []);
  const others = views.filter((view) => !openViews.value.includes(view.name));
  return (
    <div
      ref={menu}
      class="menu"
      role="menu"
      aria-label="View to add"
      onKeyDown={(event) => {
        if (event.key === "Escape" || event.key === "Tab") {
          shut();
          if (event.key === "Escape") event.preventDefault();
          menu.current?.parentElement?.querySelector("button")?.focus();
        } else moveInMenu(event);
      }}
    >
      {others.map(({ name }) => (
        <button
          key={name}
          role="menuitem"
          tabIndex={-1}
          onClick={() => {
            shut();
            split(name, side);
          }}
        >
          {name}
        </button>
      ))}
      {others.length === 0 && <p class="quiet">All views are open.</p>}
      <div role="group" aria-label="Where it comes to" class="sides">
        {sides.map((one) => (
          <button key={one.text} role="menuitemradio" tabIndex={-1} aria-checked={side === one.side} onClick={() => setSide(one.side)}>
            {one.text}
          </button>
        ))}
      </div>
    </div>
  );
}

export function ViewButtons({ views }: { views: View[] }) {
  return (
    <div class="view-buttons">
      <div class="with-menu">
        <button
          aria-haspopup="menu"
          aria-expanded={splitMenuOpen.value}
          title="One view more, beside the one that was used last (e)"
          onClick={() => (splitMenuOpen.value = !splitMenuOpen.value)}
        >
          Split
        </button>
        {splitMenuOpen.value && <SplitMenu views={views} />}
      </div>
      <button title="Program left, plant and scope right (d)" onClick={openDesk}>
        Desk
      </button>
    </div>
  );
}
