// The scope: channels, trigger, two cursors, zoom, layouts, files.
import { useEffect } from "preact/hooks";

import { hello } from "../server/live";
import { download } from "../shell/download";
import { offerKeys, withdrawKeys } from "../shell/keys";
import { command, complain } from "../shell/notice";
import { ChannelsForm } from "./channels_form";
import { keepCursors, Layouts } from "./layouts";
import { pictureFile, pointer, ScopePicture } from "./picture";
import { Plane, PlaneForm } from "./plane";
import { Readings } from "./readings";
import { csv, followScope, pictureText } from "./recording";
import { OpenTrace } from "./trace_dialog";
import { TriggerForm } from "./trigger_form";
import { follow, moveBy, moveCursor, putCursor, scope, shownWindow, zoomBy, zoomed, type Window } from "./window";

const state_texts = { free: "records", armed: "waits for the trigger", triggered: "triggered", done: "complete" };

// Without a condition the trigger is now.
function trigger(single: boolean): void {
  follow();
  if (scope.peek()?.trigger.kind === "none" && !single) void command({ do: "scope.trigger" });
  else void command({ do: "scope.arm", single });
}

function visible(): Window {
  const { from_us, to_us } = shownWindow.peek();
  return { from_us: Math.max(0, Math.floor(from_us)), to_us: Math.max(0, Math.ceil(to_us)) };
}

async function save(name: string, text: Promise<string | undefined>): Promise<void> {
  const content = await text;
  if (content !== undefined) download(name, content);
}

const saveCsv = () => save("scope.csv", csv());
const saveVisible = () => save("scope-part.csv", csv(visible()));

// SVG and HTML are those of `ipos run --plot`, of what the picture shows.
function saveDrawing(form: "svg" | "html"): Promise<void> {
  return save(`scope.${form}`, pictureText(form, hello.peek()?.title ?? "Scope", visible()));
}

function savePicture(): void {
  const file = pictureFile();
  if (file) download("scope.png", file);
  else complain("There is no picture yet.");
}

function middle(): number {
  const { from_us, to_us } = shownWindow.peek();
  return pointer.peek() ?? (from_us + to_us) / 2;
}

function offerScopeKeys(): () => void {
  offerKeys("Scope", [
    { key: "g", text: "Trigger", act: () => trigger(false) },
    { key: "G", text: "Single shot", act: () => trigger(true) },
    { key: "f", text: "Follow the newest part", act: follow },
    { key: "a", text: "Cursor A at the pointer", act: () => putCursor("A", middle()) },
    { key: "b", text: "Cursor B at the pointer", act: () => putCursor("B", middle()) },
    { key: "ArrowLeft", text: "Cursor a millisecond to the left", act: () => moveCursor(-1) },
    { key: "ArrowRight", text: "Cursor a millisecond to the right", act: () => moveCursor(1) },
    { key: "z", text: "Zoom in", act: () => zoomBy(0.5) },
    { key: "x", text: "Zoom out", act: () => zoomBy(2) },
    { key: "+", text: "Zoom in", act: () => zoomBy(0.5) },
    { key: "-", text: "Zoom out", act: () => zoomBy(2) },
    { key: "[", text: "Earlier", act: () => moveBy(-0.5) },
    { key: "]", text: "Later", act: () => moveBy(0.5) },
    { key: "v", text: "CSV of everything", act: () => void saveCsv() },
    { key: "V", text: "CSV of the visible part", act: () => void saveVisible() },
    { key: "i", text: "PNG of the picture", act: savePicture },
  ]);
  return () => withdrawKeys("Scope");
}

function Buttons() {
  const state = scope.value;
  return (
    <div class="row" style="margin-bottom:8px">
      <button aria-pressed={state?.state === "armed" && !state.single} title="Waits for the trigger again and again; without a condition it is now (g)" onClick={() => trigger(false)}>
        Trigger
      </button>
      <button aria-pressed={state?.state === "armed" && state.single} title="Waits once and keeps the picture (G)" onClick={() => trigger(true)}>
        Single
      </button>
      <button aria-pressed={state?.state === "free"} title="Records without trigger" onClick={() => void command({ do: "scope.free" })}>
        Free
      </button>
      <span class={state?.state === "armed" ? "warn" : "quiet"}>
        {state ? state_texts[state.state] : ""}
        {state?.trigger_text && ` · ${state.trigger_text}`}
        {state?.computes?.length ? ` · computes what was of ${state.computes.join(", ")}` : ""}
      </span>
      <span class="spread group">
        <button aria-label="Zoom in" title="Zoom in (z)" onClick={() => zoomBy(0.5)}>
          +
        </button>
        <button aria-label="Zoom out" title="Zoom out (x)" onClick={() => zoomBy(2)}>
          −
        </button>
        <button aria-label="Earlier" title="Earlier ([)" onClick={() => moveBy(-0.5)}>
          ◂
        </button>
        <button aria-label="Later" title="Later (])" onClick={() => moveBy(0.5)}>
          ▸
        </button>
        <button aria-pressed={zoomed.value === null} title="The newest part, or that around the trigger (f)" onClick={follow}>
          Follow
        </button>
      </span>
      <button title="Every millisecond recorded (v)" onClick={() => void saveCsv()}>
        CSV
      </button>
      <button title="Only what the picture shows (V)" onClick={() => void saveVisible()}>
        Part
      </button>
      <button title="The picture as it stands (i)" onClick={savePicture}>
        PNG
      </button>
      <button title="What the picture shows, as ipos run --plot x.svg draws it" onClick={() => void saveDrawing("svg")}>
        SVG
      </button>
      <button title="What the picture shows, as a page that stands alone" onClick={() => void saveDrawing("html")}>
        HTML
      </button>
      <OpenTrace />
    </div>
  );
}

export function Scope() {
  useEffect(followScope, []);
  useEffect(offerScopeKeys, []);
  useEffect(keepCursors, []);
  return (
    <div class="scope">
      <figure class="panel" aria-label="Scope">
        <Buttons />
        <ScopePicture />
        <Readings />
        <Plane />
      </figure>
      <aside aria-label="Settings of the scope">
        <ChannelsForm />
        <TriggerForm />
        <PlaneForm />
        <Layouts />
        <p class="quiet">
          Drag to zoom, double click to follow again, wheel to zoom while it runs, right button or a finger to move. A click puts a cursor, with
          Shift the other one; between two of them is measured.
        </p>
      </aside>
    </div>
  );
}
