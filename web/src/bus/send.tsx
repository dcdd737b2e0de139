// A telegram of a person's own. It says onto which line it goes; where there are several, one must be chosen.
import { signal } from "@preact/signals";
import { useState } from "preact/hooks";

import { hello, plant } from "../server/live";
import { command } from "../shell/notice";
import { armed } from "../shell/write_arm";
import { chosenLine, lineKinds } from "./trace_state";

const target = signal("");

// "1034", "40Ah" or "0x40A".
function identifier(text: string): number {
  const hex = /^(?:0x([0-9a-f]+)|([0-9a-f]+)h)$/i.exec(text.trim());
  return hex ? Number.parseInt(hex[1] ?? hex[2] ?? "", 16) : text.trim() === "" ? Number.NaN : Number(text);
}

// What one must know before sending; nothing on lines where everybody may send.
function Hint({ kind }: { kind: string }) {
  if (hello.value?.mode === "device" && !armed.value)
    return <p class="hint quiet whole">Sending to a real drive needs --write and “Allow writing” above.</p>;
  if (kind !== "profibus") return null;
  return (
    <p class="hint quiet whole">
      The page is no master of this line: its frame goes out without the token and collides with those of a master at work. <span class="mono">fcs</span>{" "}
      stands for the frame check.
    </p>
  );
}

export function Send() {
  const [id, setId] = useState("");
  const [data, setData] = useState("");
  const names = plant.value?.buses.map((bus) => bus.name) ?? [];
  // The line that is looked at, unless somebody has chosen another one for sending.
  const line = names.length === 1 ? (names[0] ?? "") : names.includes(target.value) ? target.value : chosenLine.value;
  const kind = lineKinds.value.get(line) ?? "";
  const can = kind === "can";
  const dp = kind === "profibus";
  const send = () =>
    void command({
      do: "bus.send",
      bus: line,
      data: dp ? data.trim() : data.replace(/\s+/g, ""), // the word fcs of a frame stands between blanks
      ...(can ? { identifier: identifier(id), extended: identifier(id) > 0x7ff } : {}),
    });
  return (
    <>
      <form
        class="bar send"
        aria-label="Send a telegram"
        onSubmit={(event) => {
          event.preventDefault();
          if (line) send();
        }}
      >
        {names.length > 1 && (
          <select aria-label="Send to" value={line} onChange={(event) => (target.value = event.currentTarget.value)}>
            <option value="">to which line?</option>
            {names.map((name) => (
              <option key={name} value={name}>
                to {name}
              </option>
            ))}
          </select>
        )}
        {(can || kind === "") && (
          <input
            type="text"
            size={9}
            aria-label="Identifier"
            placeholder="523 or 20Bh"
            value={id}
            onInput={(event) => setId(event.currentTarget.value)}
          />
        )}
        <input
          type="text"
          size={24}
          class="mono"
          aria-label="Data"
          placeholder={dp ? "10 08 01 49 fcs 16" : "data, 06 00 13 88"}
          value={data}
          onInput={(event) => setData(event.currentTarget.value)}
        />
        <button
          type="submit"
          title={line ? `onto ${line}` : "choose a line first"}
          disabled={!line || (hello.value?.mode === "device" && !armed.value) || (can && !Number.isFinite(identifier(id)))}
        >
          Send
        </button>
        <span class="quiet">{line ? `onto ${line}` : "choose a line first"}</span>
      </form>
      <Hint kind={kind} />
    </>
  );
}
