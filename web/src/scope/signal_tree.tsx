// Everything that has a name: stations, their groups, and the signals of these; a search leaves what fits. A tick makes a
// signal a channel.
import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";

import { request } from "../server/connection";
import type { WatchName } from "../server/protocol";
import { addChannel, channelNames, removeChannel } from "./channels";

const pause_ms = 150;
const most_names = 1000;

interface Branch {
  station: string;
  groups: { name: string; count: number }[];
}

function Leaves({ text, station, group }: { text: string; station: string; group: string }) {
  const names = useSignal<WatchName[]>([]);
  useEffect(() => {
    void request({ do: "search", text, station, group, limit: most_names })
      .then((reply) => (names.value = reply.names as WatchName[]))
      .catch(() => undefined);
  }, [text, station, group]);
  return (
    <ul>
      {names.value.map((one) => (
        <li key={one.name}>
          <label title={one.text}>
            <input
              type="checkbox"
              checked={channelNames.value.includes(one.name)}
              onChange={(event) => (event.currentTarget.checked ? void addChannel(one.name) : removeChannel(one.name))}
            />{" "}
            {one.name.slice(station.length + 1)} <span class="quiet">{one.unit || one.text}</span>
          </label>
        </li>
      ))}
    </ul>
  );
}

// Its contents come when it is opened.
function Node({ text, open, children }: { text: string; open: boolean; children: () => preact.ComponentChildren }) {
  const opened = useSignal(open);
  useEffect(() => {
    opened.value = open;
  }, [open]);
  return (
    <details open={opened.value} onToggle={(event) => (opened.value = event.currentTarget.open)}>
      <summary>{text}</summary>
      {opened.value && children()}
    </details>
  );
}

export function SignalTree() {
  const text = useSignal("");
  const asked = useSignal("");
  const tree = useSignal<Branch[]>([]);
  const total = useSignal(0);
  useEffect(() => {
    void request({ do: "search", text: asked.value, limit: 1 })
      .then((reply) => {
        tree.value = (reply.tree as Branch[] | undefined) ?? [];
        total.value = reply.total as number;
      })
      .catch(() => undefined);
  }, [asked.value]);
  useEffect(() => {
    const timer = setTimeout(() => (asked.value = text.value), pause_ms);
    return () => clearTimeout(timer);
  }, [text.value]);
  const few = total.value <= 40;
  return (
    <div class="signal-tree">
      <input
        type="search"
        aria-label="Search signals"
        placeholder="Search signals"
        value={text.value}
        onInput={(event) => (text.value = event.currentTarget.value)}
      />
      {tree.value.map(({ station, groups }) => (
        <Node key={station} text={station} open={few || tree.value.length === 1}>
          {() =>
            groups.map(({ name, count }) => (
              <Node key={`${station} ${name}`} text={`${name} (${count})`} open={few}>
                {() => <Leaves text={asked.value} station={station} group={name} />}
              </Node>
            ))
          }
        </Node>
      ))}
      {tree.value.length === 0 && asked.value && <p class="quiet">No signal has this in its name or its meaning.</p>}
    </div>
  );
}
