// The open views in their panes. All panes are children of one element, in reading order, and lie where the layout says; so
// a view that moves stays the same one, with what it holds. On a phone they stand one below the other (style/shell.css).
import { useEffect, useLayoutEffect } from "preact/hooks";

import { hello } from "../server/live";
import { Borders } from "./borders";
import { activate, activeView, close, followScroll, layout, moveToSide, openViews, paneId, settleScrolls, severalOpen, tabId, type View } from "./desk";
import { dropZone, startDrag } from "./drag";
import { placed, rectsOf, type Rect, type Side } from "./layout";

const arrows: Record<string, Side> = { ArrowLeft: "left", ArrowRight: "right", ArrowUp: "above", ArrowDown: "below" };

function Title({ view }: { view: string }) {
  const moveByKey = (event: KeyboardEvent) => {
    const side = arrows[event.key];
    if (!side || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    moveToSide(view, side);
    const handle = event.currentTarget;
    if (handle instanceof HTMLElement) requestAnimationFrame(() => handle.focus());
  };
  return (
    <header class="pane-title">
      <button class="grip" aria-label={`Move ${view}`} title="Drag it, or use the arrow keys" onPointerDown={(event) => startDrag(event, view)} onKeyDown={moveByKey}>
        {view}
      </button>
      <button class="small" aria-label={`Close ${view}`} title="Close (q)" onClick={() => close(view)}>
        ✕
      </button>
    </header>
  );
}

function Body({ view }: { view: View }) {
  useEffect(() => followScroll(view.name), [view.name]);
  const Content = view.body;
  return hello.value?.mode === "device" && view.notOfDrives ? <p class="empty">{view.notOfDrives}</p> : <Content />;
}

function Pane({ view, rect }: { view: View; rect: Rect | undefined }) {
  const several = severalOpen.value;
  const alone = !several || !rect;
  const used = () => {
    if (activeView.peek() !== view.name) activate(view.name);
  };
  return (
    <section
      class={`pane${activeView.value === view.name ? " active" : ""}`}
      role={alone ? "tabpanel" : "region"}
      id={paneId(view.name)}
      aria-label={alone ? undefined : view.name}
      aria-labelledby={alone ? tabId(view.name) : undefined}
      hidden={!rect}
      style={rect && placed(rect)}
      tabIndex={-1}
      onFocusIn={rect ? used : undefined}
      onPointerDown={rect ? used : undefined}
    >
      {several && rect && <Title view={view.name} />}
      <div class="view">{rect && <Body view={view} />}</div>
    </section>
  );
}

export function Panes({ views }: { views: View[] }) {
  const rects = rectsOf(layout.value);
  const order = [...openViews.value, ...views.map((view) => view.name).filter((name) => !rects.has(name))];
  useLayoutEffect(settleScrolls, [layout.value]);
  return (
    <main class={severalOpen.value ? "desk several" : "desk"}>
      {order.map((name) => {
        const view = views.find((one) => one.name === name);
        return view && <Pane key={name} view={view} rect={rects.get(name)} />;
      })}
      <Borders />
      {dropZone.value && <div class="drop-zone" style={placed(dropZone.value)} />}
    </main>
  );
}
