// The program that runs: source with the lines where tasks stand, coverage, breakpoints, stepping forward and back.
import { useEffect } from "preact/hooks";

import { hello, plant } from "../server/live";
import { offerKeys, withdrawKeys } from "../shell/keys";
import { command } from "../shell/notice";
import { breakpoints, changed, chosenTask, covered, files, followProgram, openFile, station, tasks } from "./program_state";
import { Source } from "./source";

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

export function Program() {
  useEffect(followProgram, []);
  useEffect(offerProgramKeys, []);
  const stations = plant.value?.stations.filter((one) => one.program) ?? [];
  const file = files.value.find((one) => one.name === openFile.value);
  const executed = covered.value.get(openFile.value);
  return (
    <>
      <div class="bar">
        <select aria-label="Program of" value={station.value} onChange={(event) => (station.value = event.currentTarget.value)}>
          {stations.map((one) => (
            <option key={one.name}>{one.name}</option>
          ))}
        </select>
        <select aria-label="File" value={openFile.value} onChange={(event) => (openFile.value = event.currentTarget.value)}>
          {files.value.map((one) => (
            <option key={one.name} value={one.name}>
              {baseName(one.name)}
            </option>
          ))}
        </select>
        {hello.value?.live ? <span class="quiet">Real ports: the program cannot be stopped.</span> : <Motions />}
        <Tasks />
        {file && (
          <span class="spread quiet">
            {file.lines.filter((line) => executed?.has(line)).length} of {file.lines.length} lines executed
          </span>
        )}
      </div>
      {file && changed.value.includes(file.name) && (
        <p class="warn" role="status" aria-label="Changed source">
          {baseName(file.name)} has changed since it was compiled. Here stands the text that runs; start ipos serve again to run the new one.
        </p>
      )}
      {file ? (
        <Source
          file={file}
          covered={executed ?? new Set()}
          here={tasks.value.filter((task) => task.file === file.name)}
          breakpoints={breakpoints.value.filter((point) => point.station === station.value && point.file === file.name)}
        />
      ) : (
        <p class="empty">{stations.length ? "The station has no source." : "No station has a program."}</p>
      )}
    </>
  );
}
