// A telegram of a person's own.
import { useState } from "preact/hooks";

import { command } from "../shell/notice";

// "1034", "40Ah" or "0x40A".
function identifier(text: string): number {
  const hex = /^(?:0x([0-9a-f]+)|([0-9a-f]+)h)$/i.exec(text.trim());
  return hex ? Number.parseInt(hex[1] ?? hex[2] ?? "", 16) : Number(text);
}

export function Send({ line, kind }: { line: string; kind: string }) {
  const [id, setId] = useState("");
  const [data, setData] = useState("");
  const can = kind === "can";
  const send = () =>
    void command({
      do: "bus.send",
      bus: line,
      data: data.replace(/\s+/g, ""),
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
        placeholder="data, 06 00 13 88"
        value={data}
        onInput={(event) => setData(event.currentTarget.value)}
      />
      <button type="submit" disabled={!line || (can && !Number.isFinite(identifier(id)))}>
        Send
      </button>
    </form>
  );
}
