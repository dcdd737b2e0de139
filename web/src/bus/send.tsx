// A telegram of a person's own.
import { useState } from "preact/hooks";

import { hello } from "../server/live";
import { command } from "../shell/notice";
import { armed } from "../shell/write_arm";

// "1034", "40Ah" or "0x40A".
function identifier(text: string): number {
  const hex = /^(?:0x([0-9a-f]+)|([0-9a-f]+)h)$/i.exec(text.trim());
  return hex ? Number.parseInt(hex[1] ?? hex[2] ?? "", 16) : Number(text);
}

// What one must know before sending; nothing on lines where everybody may send.
export function SendHint({ kind }: { kind: string }) {
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

export function Send({ line, kind }: { line: string; kind: string }) {
  const [id, setId] = useState("");
  const [data, setData] = useState("");
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
    <form
      class="row"
      onSubmit={(event) => {
        event.preventDefault();
        send();
      }}
    >
      {can && (
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
      <button type="submit" disabled={!line || (hello.value?.mode === "device" && !armed.value) || (can && !Number.isFinite(identifier(id)))}>
        Send
      </button>
    </form>
  );
}
