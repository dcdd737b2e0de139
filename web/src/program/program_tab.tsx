// The programs, plant and tests in an editor, with what belongs to the text that runs: the lines where tasks stand, coverage,
// breakpoints, values, stepping forward and back. What is edited takes effect by Restart or Load.
import { EditorView } from "@codemirror/view";
import { useEffect, useRef, useState } from "preact/hooks";

import { generation, hello, plant } from "../server/live";
import type { Breakpoint } from "../server/protocol";
import { offerKeys, withdrawKeys } from "../shell/keys";
import { command } from "../shell/notice";
import { setting } from "../shell/settings";
import {
  build,
  documents,
  edited,
  followFiles,
  hasChanged,
  isUnsaved,
  openDocument,
  plantFiles,
  ready,
  saveAndBuild,
  takeChanged,
  type BuildMessage,
  type Document,
} from "./documents";
import { canFormat, Editor, extensionsOf, format } from "./editor";
import { compiledLine, pointAt, setCompiled, setMarks, shownLine } from "./marks";
import { Messages, messages } from "./messages";
import { isFile, wantedLine } from "./open_line";
import { breakpoints, chosenTask, covered, files, followProgram, openFile, station, tasks } from "./program_state";
import { followValues } from "./values";

// Off at first: a plant that runs is not thrown back to 0 s by a key that saves (ours).
const restartAfterBuild = setting("program.restart", false);

// One and the same each time: marks that are the same are not set again.
const nothing: ReadonlySet<number> = new Set();

function plainText(text: string): string {
  return text.replaceAll("\r\n", "\n");
}

function goTo(view: EditorView, line: number, column: number): void {
  const at = view.state.doc.line(Math.min(line, view.state.doc.lines));
  const head = Math.min(at.to, at.from + Math.max(0, column - 1));
  view.dispatch({ selection: { anchor: head }, effects: EditorView.scrollIntoView(head, { y: "center" }) });
  view.focus();
}

const motions = [
  { kind: "over", text: "Over", key: "n", what: "To the next line of this function" },
  { kind: "into", text: "Into", key: "i", what: "To the next line, into functions" },
  { kind: "out", text: "Out", key: "o", what: "Out of this function" },
  { kind: "command", text: "Command", key: "c", what: "One command of the machine" },
];

function move(kind: string, back: boolean): void {
  void command({ do: "program.step", station: station.peek(), task: chosenTask.peek(), kind, back });
}

function offerProgramKeys(): () => void {
  offerKeys("Program", [
    ...motions.map((motion) => ({ key: motion.key, text: motion.what, act: () => move(motion.kind, false) })),
    ...motions
      .filter((motion) => motion.kind !== "out")
      .map((motion) => ({ key: motion.key.toUpperCase(), text: `Back: ${motion.what.toLowerCase()}`, act: () => move(motion.kind, true) })),
  ]);
  return () => withdrawKeys("Program");
}

function baseName(path: string): string {
  return path.slice(path.lastIndexOf("/") + 1);
}

function Motions() {
  return (
    <>
      <span class="group" role="group" aria-label="Forward">
        {motions.map((motion) => (
          <button key={motion.kind} title={`${motion.what} (${motion.key})`} onClick={() => move(motion.kind, false)}>
            {motion.text}
          </button>
        ))}
      </span>
      <span class="group" role="group" aria-label="Backward">
        {motions
          .filter((motion) => motion.kind !== "out")
          .map((motion) => (
            <button
              key={motion.kind}
              aria-label={`Back ${motion.text}`}
              title={`Back: ${motion.what} (${motion.key.toUpperCase()})`}
              onClick={() => move(motion.kind, true)}
            >
              ↶ {motion.text}
            </button>
          ))}
      </span>
    </>
  );
}

function Tasks() {
  return (
    <div class="row" role="radiogroup" aria-label="Task">
      {tasks.value.map((task) => (
        <label key={task.task} class="field">
          <input
            type="radio"
            name="task"
            checked={chosenTask.value === task.task}
            onChange={() => {
              chosenTask.value = task.task;
              if (task.file) openFile.value = task.file;
            }}
          />
          <span>
            task {task.task}{" "}
            <span class="quiet">
              {task.state}
              {task.function && `, ${task.function}`}
              {task.file && ` ${baseName(task.file)}:${task.line}`}
            </span>
          </span>
        </label>
      ))}
    </div>
  );
}

// Sets or clears the breakpoint at a line of the editor; it counts for the text that runs.
async function toggle(view: EditorView, line: number): Promise<void> {
  const point = pointAt(view.state, line);
  const reply = point
    ? await command({ do: "break.clear", number: point.number })
    : await command({ do: "break.set", station: station.peek(), file: openFile.peek(), line: compiledLine(view.state, line) });
  if (!reply) return;
  const all = await command({ do: "breaks" });
  if (all) breakpoints.value = all.breakpoints as Breakpoint[];
}

// Restart begins at 0 s, Load is a download: the program begins anew, the rest stays as it is.
const restart = () => command({ do: "restart" });
const load = () => command({ do: "load", station: station.peek() });

async function saveBuildAndMaybeRestart(over = false): Promise<void> {
  if ((await saveAndBuild(over)) && restartAfterBuild.peek()) await restart();
}

function why(): string {
  const program = plant.peek()?.stations.find((one) => one.name === station.peek())?.program ?? "";
  return program.toLowerCase().endsWith(".ipx") ? "the station runs an image, which has no source to edit" : "it is none of the plant's files";
}

// What is edited, and what runs.
function Status({ document, runs }: { document: Document; runs: boolean }) {
  const name = baseName(document.name);
  const errors = messages().filter((one) => one.severity === "error").length;
  const unsaved = !document.read_only && isUnsaved(document);
  const changed = hasChanged(document);
  const program = document.kind === "program" || document.kind === "include";
  const parts: string[] = [];
  if (document.read_only) parts.push(`Read only: ${document.read_only}.`);
  if (changed) parts.push(`${name} has changed outside; what is edited here stays until you take the changed file, and comes back with undo.`);
  if (unsaved) parts.push(`${name} is not saved.`);
  if (!build.value.good && !edited.value) parts.push(`It does not build: ${errors} ${errors === 1 ? "error" : "errors"}. The plant goes on as it was.`);
  else if (build.value.waits && !edited.value)
    parts.push(program && runs ? "Restart begins at 0 s with what was built." : "Built. Restart begins at 0 s with it; Load puts the program into the drive, which goes on.");
  if (program && !runs) parts.push("The text shown is not the one that runs.");
  else if (program && !unsaved && !changed) parts.push("This text runs.");
  return (
    <p class={`status${changed || !build.value.good || (program && !runs) ? " warn" : ""}`} role="status" aria-label="State of the text">
      {parts.join(" ")}{" "}
      {changed && unsaved && (
        <button class="small" onClick={() => void saveBuildAndMaybeRestart(true)}>
          Save over it
        </button>
      )}
    </p>
  );
}

export function Program() {
  useEffect(followProgram, []);
  useEffect(followFiles, []);
  useEffect(offerProgramKeys, []);
  const [view, setView] = useState<EditorView | null>(null);
  const jump = useRef<BuildMessage | null>(null);
  const stations = plant.value?.stations.filter((one) => one.program) ?? [];
  const compiled = files.value.find((one) => one.name === openFile.value);
  const document = documents.value.get(openFile.value);
  const executed = covered.value.get(openFile.value) ?? nothing;
  const live = hello.value?.live ?? false;
  // Programs are those of the station. Where none has one they are to be mended.
  const listed = (kind: string) => kind !== "session" && (kind !== "program" || stations.length === 0);
  const names = [...files.value.map((one) => one.name), ...plantFiles.value.filter((one) => listed(one.kind)).map((one) => one.name)];
  const here = tasks.value.filter((task) => task.file === openFile.value);
  const points = breakpoints.value.filter((point) => point.station === station.value && point.file === openFile.value);

  const to_mend = stations.length === 0 && document?.kind === "program";

  useEffect(() => {
    if (plant.value && stations.length === 0 && openFile.value === "") openFile.value = plantFiles.value.find((one) => one.kind === "program")?.name ?? names[0] ?? "";
  }, [plant.value, plantFiles.value]);

  const show = () => {
    if (!view) return;
    if (compiled?.text != null) view.dispatch({ effects: setCompiled.of(compiled.text) });
    view.dispatch({ effects: setMarks.of({ lines: compiled?.lines ?? [], covered: executed, here: compiled ? here : [], points }) });
    const to = jump.current;
    if (to?.file !== openFile.value) return;
    jump.current = null;
    goTo(view, to.line, to.column);
  };
  useEffect(() => {
    if (!ready.value || !openFile.value || documents.peek().has(openFile.value)) return;
    const name = openFile.value;
    void openDocument(name, (uri, read_only) => extensionsOf(name, uri, read_only), compiled?.text ?? null, why());
  }, [openFile.value, plantFiles.value, ready.value, compiled]);
  useEffect(show, [compiled, executed, tasks.value, breakpoints.value, view]);
  useEffect(() => (view ? followValues(view) : undefined), [station.value, view, generation.value]);
  // The line that runs is kept in sight.
  const current = here[0]?.line;
  useEffect(() => {
    const line = view && compiled && current ? shownLine(view.state, current) : 0;
    if (view && line && !view.hasFocus) view.dispatch({ effects: EditorView.scrollIntoView(view.state.doc.line(line).from, { y: "nearest", yMargin: 40 }) });
  }, [current, view]);

  // A line that a text elsewhere on the page has named, once.
  useEffect(() => {
    const place = wantedLine.value;
    if (!view || !document || view.state.doc !== document.state.doc || !place || !isFile(openFile.value, place.file)) return;
    if (!compiled && document.kind === "program" && !to_mend) return; // its compiled text comes
    wantedLine.value = null;
    goTo(view, Math.max(1, compiled ? shownLine(view.state, place.line) : place.line), 1);
  }, [wantedLine.value, view, compiled, document, openFile.value]);

  const formatIt = (of: EditorView | null) => document && of && canFormat(document) && void format(of, document.uri);
  const go = (message: BuildMessage) => {
    if (!message.line) return;
    if (message.file === openFile.value && view) return goTo(view, message.line, message.column);
    jump.current = message;
    if (names.includes(message.file)) openFile.value = message.file;
  };
  const runs = !document || (compiled?.text == null ? !to_mend : plainText(compiled.text) === document.state.doc.toString());
  return (
    <div
      class="program"
      onKeyDown={(event) => {
        if (!(event.ctrlKey || event.metaKey) || event.key !== "s" || event.defaultPrevented) return;
        event.preventDefault();
        void saveBuildAndMaybeRestart();
      }}
    >
      <div class="bar">
        <select aria-label="Station" value={station.value} onChange={(event) => (station.value = event.currentTarget.value)}>
          {stations.map((one) => (
            <option key={one.name}>{one.name}</option>
          ))}
        </select>
        <select aria-label="File" value={openFile.value} onChange={(event) => (openFile.value = event.currentTarget.value)}>
          {[...new Set(names)].map((name) => (
            <option key={name} value={name}>
              {baseName(name)}
            </option>
          ))}
        </select>
        <span class="row">
          <button title="Ctrl+S" onClick={() => void saveBuildAndMaybeRestart()}>
            Save and build
          </button>
          <button disabled={live} class={build.value.waits ? "primary" : ""} title="The plant as at power-on, with what is forced" onClick={() => void restart()}>
            Restart
          </button>
          <button disabled={!build.value.waits} title="The program begins anew; H variables and the drive stay" onClick={() => void load()}>
            Load
          </button>
          <button title="As ipos fmt (Shift+Alt+F)" disabled={!document || !canFormat(document)} onClick={() => formatIt(view)}>
            Format
          </button>
          <button disabled={!document || !hasChanged(document)} onClick={() => void takeChanged(openFile.peek())}>
            Take changed file
          </button>
        </span>
        <label class="field">
          <input type="checkbox" checked={restartAfterBuild.value} onChange={(event) => (restartAfterBuild.value = event.currentTarget.checked)} />
          <span>Restart after build</span>
        </label>
      </div>
      <div class="bar">
        {live ? <span class="quiet">Real ports: the program cannot be stopped.</span> : <Motions />}
        <Tasks />
        {compiled && (
          <span class="spread quiet">
            {compiled.lines.filter((line) => executed.has(line)).length} of {compiled.lines.length} lines executed
          </span>
        )}
      </div>
      {document && <Status document={document} runs={runs} />}
      {document ? (
        <Editor
          document={document}
          orders={{ save: () => void saveBuildAndMaybeRestart(), format: formatIt, toggle: (of, line) => void toggle(of, line) }}
          take={setView}
        />
      ) : (
        <p class="empty">{stations.length ? "The station has no source." : "No station has a program."}</p>
      )}
      <Messages go={go} />
    </div>
  );
}
