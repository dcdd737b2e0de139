// A source file line by line. A click on the left edge sets or clears a breakpoint.
import { useEffect, useRef } from "preact/hooks";

import type { Breakpoint, SourceFile, TaskState } from "../server/protocol";
import { command } from "../shell/notice";
import { breakpoints, station } from "./program_state";

interface Shown {
  file: SourceFile;
  covered: ReadonlySet<number>;
  here: TaskState[];
  breakpoints: Breakpoint[];
}

async function toggle(file: string, line: number, point: Breakpoint | undefined): Promise<void> {
  const reply = point
    ? await command({ do: "break.clear", number: point.number })
    : await command({ do: "break.set", station: station.peek(), file, line });
  if (!reply) return;
  const all = await command({ do: "breaks" });
  if (all) breakpoints.value = all.breakpoints as Breakpoint[];
}

export function Source({ file, covered, here, breakpoints: points }: Shown) {
  const list = useRef<HTMLOListElement>(null);
  const current = here[0]?.line;
  useEffect(() => {
    if (current !== undefined) list.current?.children[current - 1]?.scrollIntoView({ block: "nearest" });
  }, [current, file.name]);
  const executable = new Set(file.lines);
  return (
    <div class="panel source" role="region" aria-label={`Source ${file.name}`} tabIndex={0}>
      <ol ref={list}>
        {file.text.split("\n").map((text, position) => {
          const line = position + 1;
          const point = points.find((one) => one.line === line);
          const standing = here.filter((task) => task.line === line);
          const face = executable.has(line) ? (covered.has(line) ? " covered" : " missed") : "";
          return (
            <li key={line} class={`line${face}${standing.length ? " here" : ""}`} aria-current={standing.length ? "step" : undefined}>
              {executable.has(line) ? (
                <button
                  class="point"
                  aria-label={`Breakpoint in line ${line}`}
                  aria-pressed={point !== undefined}
                  title={point ? `${point.hits} hits` : ""}
                  onClick={() => void toggle(file.name, line, point)}
                />
              ) : (
                <span />
              )}
              <span class="line-number">{line}</span>
              <span class="count">{standing.map((task) => `▶${task.task}`).join("")}</span>
              <span class="text">{text.replace(/\r$/, "")}</span>
            </li>
          );
        })}
      </ol>
    </div>
  );
}
