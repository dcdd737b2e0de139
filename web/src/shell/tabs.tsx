// The tabs, after the ARIA pattern. With one view open the arrows open what they come to; with several they only move, so
// that passing a tab takes no view away, and Enter opens.
import { activeView, open, openViews, paneId, severalOpen, tabId, type View } from "./desk";
import { startDrag } from "./drag";

function moveByKey(event: KeyboardEvent, views: View[], position: number): void {
  const last = views.length - 1;
  const to = { ArrowRight: position === last ? 0 : position + 1, ArrowLeft: position === 0 ? last : position - 1, Home: 0, End: last }[event.key];
  const view = to === undefined ? undefined : views[to];
  if (!view) return;
  event.preventDefault();
  if (!severalOpen.peek()) open(view.name);
  document.getElementById(tabId(view.name))?.focus();
}

export function TabList({ views }: { views: View[] }) {
  return (
    <div role="tablist" aria-label="Views">
      {views.map(({ name }, position) => {
        const selected = activeView.value === name;
        const shown = openViews.value.includes(name);
        return (
          <button
            key={name}
            role="tab"
            id={tabId(name)}
            class={shown && !selected ? "shown" : ""}
            aria-selected={selected}
            aria-controls={paneId(name)}
            tabIndex={selected ? 0 : -1}
            onClick={() => open(name)}
            onKeyDown={(event) => moveByKey(event, views, position)}
            onPointerDown={(event) => event.pointerType === "mouse" && startDrag(event, name)}
          >
            {name}
          </button>
        );
      })}
    </div>
  );
}
