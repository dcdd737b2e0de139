// The names of the eight channels; the server proposes while one types.
import { useState } from "preact/hooks";

import { request } from "../server/connection";
import { hello } from "../server/live";
import type { Channel, WatchName } from "../server/protocol";
import { command } from "../shell/notice";
import { scope } from "./window";

const most_channels = 8;

async function propose(text: string): Promise<string[]> {
  try {
    const reply = await request({ do: "search", text, limit: 20 });
    return (reply.names as WatchName[]).map((one) => one.name);
  } catch {
    return [];
  }
}

export function ChannelsForm() {
  const channels = scope.value?.channels ?? [];
  const [proposals, setProposals] = useState<string[]>([]);
  const send = (position: number, name: string) => {
    const names = channels.map((channel: Channel) => channel.name);
    if ((names[position] ?? "") === name) return;
    if (name) names[Math.min(position, names.length)] = name;
    else names.splice(position, 1);
    if (names.length > 0) void command({ do: "scope", channels: names });
  };
  const fields = Math.min(most_channels, channels.length + 1);
  return (
    <fieldset>
      <legend>Channels</legend>
      <datalist id="signals">
        {proposals.map((name) => (
          <option key={name} value={name} />
        ))}
      </datalist>
      {Array.from({ length: fields }, (_, position) => (
        <div class="channel" key={`${position} ${channels[position]?.name ?? ""}`}>
          <span class="swatch" style={position < channels.length ? `background:var(--s${position + 1})` : ""} />
          <input
            type="text"
            list="signals"
            aria-label={`Channel ${position + 1}`}
            placeholder={hello.value?.mode === "device" ? "P000, 8318, H20" : "STATION.NAME"}
            defaultValue={channels[position]?.name ?? ""}
            onInput={(event) => void propose(event.currentTarget.value).then(setProposals)}
            onChange={(event) => send(position, event.currentTarget.value.trim())}
          />
          {position < channels.length && channels.length > 1 ? (
            <button class="small" aria-label={`Remove channel ${position + 1}`} onClick={() => send(position, "")}>
              ✕
            </button>
          ) : (
            <span />
          )}
        </div>
      ))}
    </fieldset>
  );
}
