// The trace as a file of other tools: all that the server keeps of what is shown, in parts, put together here.
import { signal } from "@preact/signals";
import { useState } from "preact/hooks";

import { request } from "../server/connection";
import { download } from "../shell/download";
import { complain, forgive } from "../shell/notice";
import { choice, chosenLine, lineKinds } from "./trace_state";

const forms = { candump: "candump", pcapng: "pcapng", asc: "ASC" };
type Form = keyof typeof forms;
const chosen = signal<Form | "">("");

function bytesOf(base64: string): Uint8Array<ArrayBuffer> {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let n = 0; n < text.length; ++n) bytes[n] = text.charCodeAt(n);
  return bytes;
}

async function save(form: Form): Promise<string> {
  const parts: (string | Uint8Array<ArrayBuffer>)[] = [];
  let next: number | null = 0;
  let bounds = {};
  let file = "";
  let count = 0;
  let left_out: string[] = [];
  const wanted = choice.peek();
  while (next !== null) {
    const reply: Record<string, unknown> = await request({ do: "bus.save", form, ...wanted, ...bounds, after: next });
    parts.push(typeof reply.text === "string" ? reply.text : bytesOf(reply.base64 as string));
    file = reply.file as string;
    count += reply.telegrams as number;
    left_out = reply.left_out as string[];
    next = reply.next as number | null;
    bounds = { until: reply.until };
  }
  download(file, new Blob(parts));
  return [`${count} telegrams in ${file}.`, ...left_out.map((text) => `Left out: ${text}.`)].join(" ");
}

export function SaveTrace() {
  const [outcome, setOutcome] = useState("");
  const kinds = chosenLine.value ? [lineKinds.value.get(chosenLine.value)] : [...lineKinds.value.values()];
  // What carries all that is shown, until somebody chooses.
  const form: Form = chosen.value || (kinds.every((kind) => kind === "can") ? "candump" : "pcapng");
  const act = async () => {
    try {
      setOutcome(await save(form));
      forgive();
    } catch (reason) {
      setOutcome("");
      complain(reason);
    }
  };
  return (
    <>
      <select aria-label="Form of the file" value={form} onChange={(event) => (chosen.value = event.currentTarget.value as Form)}>
        {Object.entries(forms).map(([name, text]) => (
          <option key={name} value={name}>
            {text}
          </option>
        ))}
      </select>
      <button onClick={() => void act()}>Save trace</button>
      {outcome && (
        <span class="quiet" role="status">
          {outcome}
        </span>
      )}
    </>
  );
}
