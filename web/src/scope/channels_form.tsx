// The channels: what is drawn where, one more by its name, or picked from the tree.
import { useState } from "preact/hooks";

import { request } from "../server/connection";
import { hello } from "../server/live";
import type { WatchName } from "../server/protocol";
import { addChannel, channelNames, mostChannels, places, removeChannel, setPlace } from "./channels";
import { SignalTree } from "./signal_tree";

const panels = ["1", "2", "3", "4"];

async function propose(text: string): Promise<string[]> {
  try {
    const reply = await request({ do: "search", text, limit: 20 });
    return (reply.names as WatchName[]).map((one) => one.name);
  } catch {
    return [];
  }
}

function ChannelRow({ name, position }: { name: string; position: number }) {
  return (
    <div class="channel">
      <span class="swatch" style={`background:var(--s${(position % 8) + 1})`} />
      <span class="mono name" title={name}>
        {name}
      </span>
      <select aria-label={`Panel of channel ${position + 1}`} title={`Where ${name} is drawn`} value={places.value[name] ?? ""} onChange={(event) => setPlace(name, event.currentTarget.value)}>
        <option value="">by unit</option>
        {panels.map((panel) => (
          <option key={panel} value={panel}>
            panel {panel}
          </option>
        ))}
        <option value="lane">lane</option>
      </select>
      <button class="small" aria-label={`Remove ${name}`} disabled={channelNames.value.length < 2} onClick={() => removeChannel(name)}>
        ✕
      </button>
    </div>
  );
}

export function ChannelsForm() {
  const names = channelNames.value;
  const [proposals, setProposals] = useState<string[]>([]);
  const drive = hello.value?.mode === "device";
  return (
    <fieldset>
      <legend>
        Channels, {names.length} of {mostChannels.value}
      </legend>
      {names.map((name, position) => (
        <ChannelRow key={name} name={name} position={position} />
      ))}
      <datalist id="signals">
        {proposals.map((name) => (
          <option key={name} value={name} />
        ))}
      </datalist>
      <input
        type="text"
        list="signals"
        aria-label="Add channel"
        placeholder={drive ? "Add P000, 8318, H20" : "Add STATION.NAME"}
        onInput={(event) => void propose(event.currentTarget.value).then(setProposals)}
        onChange={(event) => {
          const field = event.currentTarget;
          void addChannel(field.value.trim()).then(() => (field.value = ""));
        }}
      />
      {!drive && (
        <details>
          <summary>Pick from the list</summary>
          <SignalTree />
        </details>
      )}
    </fieldset>
  );
}
