// The last telegrams one after the other; the server filters.
import { useEffect, useState } from "preact/hooks";

import { request } from "../server/connection";
import { secondsText, time } from "../server/live";
import type { TraceFrame } from "../server/protocol";
import { complain } from "../shell/notice";
import { identityText } from "./identity";

const refresh_ms = 500;
const shown_frames = 200;

// Digits of data that still stand in one line.
export const long_data = 40;

export function Trace({ line, kinds }: { line: string; kinds: Map<string, string> }) {
  const [filter, setFilter] = useState("");
  const [held, setHeld] = useState(false);
  const [frames, setFrames] = useState<TraceFrame[]>([]);
  useEffect(() => {
    if (held) return undefined;
    let asked_us = -1;
    const look = () => {
      if (asked_us === time.peek().us) return;
      asked_us = time.peek().us;
      request({ do: "bus.trace", limit: shown_frames, ...(line ? { bus: line } : {}), ...(filter ? { filter } : {}) })
        .then((reply) => setFrames(reply.frames as TraceFrame[]))
        .catch(complain);
    };
    look();
    const timer = setInterval(look, refresh_ms);
    return () => clearInterval(timer);
  }, [line, filter, held]);
  const shown = [...frames].reverse();
  return (
    <section class="trace" aria-label="Trace">
      <div class="bar">
        <h3>Trace</h3>
        <input
          type="search"
          aria-label="Filter of the trace"
          placeholder="line, identifier, data or meaning"
          value={filter}
          onInput={(event) => setFilter(event.currentTarget.value)}
        />
        <button aria-pressed={held} onClick={() => setHeld(!held)}>
          Hold
        </button>
        <span class="quiet">newest first, the last {shown_frames}</span>
      </div>
      <div class="scroll" tabIndex={0}>
        <table class="values" aria-label="Telegrams">
          <thead>
            <tr>
              <th scope="col" class="number">
                Time
              </th>
              <th scope="col">Line</th>
              <th scope="col">Identifier</th>
              <th scope="col">Data</th>
              <th scope="col">Meaning</th>
            </tr>
          </thead>
          <tbody>
            {shown.map((frame) => (
              <tr key={frame.n}>
                <td class="number shrink">{secondsText(frame.us).replace(" s", "")}</td>
                <td class="quiet shrink">{frame.bus}</td>
                <td class="mono shrink">{identityText(frame, kinds.get(frame.bus))}</td>
                <td class={frame.data.length > long_data ? "mono octets" : "mono shrink"}>{frame.remote ? "remote" : (frame.data.match(/../g) ?? []).join(" ")}</td>
                <td class={frame.error ? "meaning bad" : "meaning"}>{frame.text}</td>
              </tr>
            ))}
          </tbody>
        </table>
        {shown.length === 0 && <p class="empty">No telegram.</p>}
      </div>
    </section>
  );
}
