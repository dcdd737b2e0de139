// One telegram taken apart: its bits and words, who sent it, what belongs to it, and what of it the scope can follow.
import { useEffect, useState } from "preact/hooks";

import { request } from "../server/connection";
import type { TelegramDetail, TelegramField, TraceFrame } from "../server/protocol";
import { addChannel } from "../scope/channels";
import { complain } from "../shell/notice";
import { goTo, noPast } from "../timeline/moments";
import { identityText, microText } from "./identity";
import { chosen, lineKinds, show } from "./trace_state";

function bitsOf(field: TelegramField): string {
  if (field.bits === 0) return "";
  const text = (field.value >>> 0).toString(2).padStart(field.bits, "0");
  return text.replace(/(?=(?:....)+$)/g, " ").trim();
}

function Bits({ data }: { data: string }) {
  return (
    <p class="mono bits">
      {(data.match(/../g) ?? []).map((byte, n) => (
        <span key={n} title={`byte ${n}: ${Number.parseInt(byte, 16)}`}>
          {byte} <span class="quiet">{Number.parseInt(byte, 16).toString(2).padStart(8, "0")}</span>
        </span>
      ))}
    </p>
  );
}

function Fields({ detail }: { detail: TelegramDetail }) {
  if (!detail.channels) return <p class="quiet">Telegrams of a real line are no channels: the scope asks the drive for its values (P000, 8318, H20).</p>;
  if (detail.fields.length === 0) return <p class="quiet">Nothing in it has a name that the scope could follow.</p>;
  return (
    <table class="values grid" role="table" aria-label="Fields">
      <thead role="rowgroup">
        <tr role="row">
          {Object.entries({ Signal: "signal", Value: "value", Bits: "bit-field", "What it is": "what", Scope: "add" }).map(([name, area]) => (
            <th key={name} role="columnheader" scope="col" class={area}>
              {name}
            </th>
          ))}
        </tr>
      </thead>
      <tbody role="rowgroup">
        {detail.fields.map((field) => (
          <tr key={field.signal} role="row">
            <th role="rowheader" scope="row" class="mono signal">
              {field.signal}
            </th>
            <td role="cell" class="mono value">
              {field.value}
            </td>
            <td role="cell" class="mono bit-field">
              {bitsOf(field)}
            </td>
            <td role="cell" class="quiet what" title={field.meaning}>
              {field.meaning}
            </td>
            <td role="cell" class="add">
              <button class="small" aria-label={`Add channel ${field.signal}`} onClick={() => void addChannel(field.signal)}>
                Add channel
              </button>
            </td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}

function Partner({ what, frame }: { what: string; frame: TraceFrame | null }) {
  if (!frame) return null;
  return (
    <p>
      {what}:{" "}
      <button class="small mono" onClick={() => void show(frame).catch(complain)}>
        {microText(frame.us)}
      </button>{" "}
      {frame.text}
    </p>
  );
}

export function Detail() {
  const frame = chosen.value;
  const [detail, setDetail] = useState<TelegramDetail | null>(null);
  const [gone, setGone] = useState("");
  useEffect(() => {
    setDetail(null);
    setGone("");
    if (!frame) return undefined;
    let wanted = true;
    request({ do: "bus.telegram", bus: frame.bus, n: frame.n })
      .then((reply) => wanted && setDetail(reply as unknown as TelegramDetail))
      .catch((reason: unknown) => wanted && setGone(reason instanceof Error ? reason.message : String(reason)));
    return () => {
      wanted = false;
    };
  }, [frame]);
  if (!frame) return null;
  return (
    <section class="panel detail" aria-label="Telegram">
      <div class="bar">
        <strong class="mono">{identityText(frame, lineKinds.value.get(frame.bus))}</strong>
        <span>
          {frame.bus}
          {frame.sender && `, sent by ${frame.sender}`}
          {!frame.ours && ", over the port"}
          {detail && `, ${microText(detail.from_us)} to ${microText(frame.us)} s, ${frame.dlc} bytes`}
        </span>
        {!noPast.value && (
          <button class="spread" onClick={() => goTo(frame.us / 1000)}>
            Go to {microText(frame.us)} s
          </button>
        )}
        <button onClick={() => (chosen.value = null)}>Close detail</button>
      </div>
      <p class={frame.error ? "bad" : ""}>{frame.text}</p>
      {!frame.remote && <Bits data={frame.data} />}
      {gone && <p class="quiet">{gone}</p>}
      {detail && (
        <>
          <Partner what="Answered by" frame={detail.answer} />
          <Partner what="Answer to" frame={detail.question} />
          <Fields detail={detail} />
        </>
      )}
    </section>
  );
}
