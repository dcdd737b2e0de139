// The last telegrams one after the other: filters, find, follow, and one of them in detail.
import { useEffect, useLayoutEffect, useRef, useState } from "preact/hooks";

import type { TraceFrame } from "../server/protocol";
import { complain } from "../shell/notice";
import { Rows, type Range } from "../shell/rows";
import { identityText, microText } from "./identity";
import { SaveTrace } from "./save_trace";
import { Detail } from "./telegram_detail";
import * as trace from "./trace_state";

// With the class of their cells: what a column is called stands where its cells stand.
const columns = { Time: "time", Delta: "delta", Line: "wire", Direction: "way", Sender: "sender", Identifier: "identity", DLC: "dlc", Data: "data", Meaning: "meaning" };

function Row({ frame, before }: { frame: TraceFrame; before: TraceFrame | undefined }) {
  const bytes = frame.remote ? "remote" : (frame.data.match(/../g) ?? []).join(" ");
  return (
    <tr
      role="row"
      class={frame.error ? "bad" : ""}
      aria-current={trace.chosen.value?.n === frame.n ? "true" : undefined}
      onClick={() => (trace.chosen.value = frame)}
    >
      <td role="cell" class="mono time">
        {microText(frame.us)}
      </td>
      <td role="cell" class="mono quiet delta">
        {before ? `+${microText(frame.us - before.us)}` : ""}
      </td>
      <td role="cell" class="wire">
        {frame.bus}
      </td>
      <td role="cell" class="quiet way" title={frame.ours ? "sent by a station of ours" : "from outside, over the port"}>
        {frame.ours ? "Tx" : "Rx"}
      </td>
      <td role="cell" class="sender">
        {frame.sender}
      </td>
      <td role="cell" class="mono identity">
        {identityText(frame, trace.lineKinds.value.get(frame.bus))}
      </td>
      <td role="cell" class="mono dlc">
        {frame.dlc}
      </td>
      <td role="cell" class="mono data" title={bytes}>
        {bytes}
      </td>
      <td role="cell" class="meaning" title={frame.text}>
        {frame.text}
      </td>
    </tr>
  );
}

function Table() {
  const box = useRef<HTMLDivElement>(null);
  const frames = trace.frames.value;
  const drawn = useRef<Range>({ first: 0, end: 0 });
  // A trace that follows stands at its newest telegram, which is the first row.
  useLayoutEffect(() => {
    if (trace.follows.value && box.current) box.current.scrollTop = 0;
  }, [frames, trace.follows.value]);
  const scrolled = () => {
    const element = box.current;
    if (!element) return;
    if (element.scrollTop > 40) trace.follows.value = false;
    if (element.scrollTop + element.clientHeight > element.scrollHeight - 400 && !trace.follows.peek()) void trace.older();
  };
  const move = (event: KeyboardEvent) => {
    const by = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (by === undefined || frames.length === 0) return;
    event.preventDefault();
    const now = frames.findIndex((frame) => frame.n === trace.chosen.value?.n);
    const to = Math.max(0, Math.min(frames.length - 1, now < 0 ? 0 : now + by));
    trace.follows.value = false;
    trace.chosen.value = frames[to] ?? null;
    if (to > frames.length - 20) void trace.older();
    box.current?.querySelectorAll("tbody > tr:not([aria-hidden])")[to - drawn.current.first]?.scrollIntoView({ block: "nearest" });
  };
  return (
    <div ref={box} class="scroll part trace" tabIndex={0} role="group" aria-label="Trace, arrow keys choose a telegram" onScroll={scrolled} onKeyDown={move}>
      <table class="values grid" role="table" aria-label="Telegrams" aria-rowcount={frames.length + 1}>
        <thead role="rowgroup">
          <tr role="row">
            {Object.entries(columns).map(([name, area]) => (
              <th key={name} role="columnheader" scope="col" class={area}>
                {name}
              </th>
            ))}
          </tr>
        </thead>
        <Rows
          items={frames}
          row={(frame, position) => <Row key={frame.n} frame={frame} before={frames[position + 1]} />}
          onRange={(range) => (drawn.current = range)}
        />
      </table>
      {frames.length === 0 && <p class="empty">No telegram.</p>}
    </div>
  );
}

function Find() {
  const [text, setText] = useState("");
  const [outcome, setOutcome] = useState("");
  const next = () => {
    if (!text.trim()) return;
    trace
      .find(text.trim())
      .then((found) => setOutcome(found ? "" : "none further back"))
      .catch(complain);
  };
  return (
    <form
      class="row"
      aria-label="Find in the trace"
      onSubmit={(event) => {
        event.preventDefault();
        next();
      }}
    >
      <input
        type="text"
        size={12}
        aria-label="Find"
        placeholder="find"
        value={text}
        onInput={(event) => {
          setText(event.currentTarget.value);
          setOutcome("");
        }}
      />
      <button type="submit">Next</button>
      {outcome && (
        <span class="quiet" role="status">
          {outcome}
        </span>
      )}
    </form>
  );
}

export function Trace() {
  useEffect(trace.followTrace, []);
  const paused = trace.paused.value.size;
  return (
    <section aria-label="Trace" class="traces">
      <div class="bar">
        <h2 class="caption">Trace</h2>
        <input
          type="search"
          aria-label="Filter of the trace"
          placeholder="id:20B -token sender:saw fault"
          title="All words must fit, one with a minus must not: id:20B,300-30F address:9 line:sbus sender:saw data:0600 dlc:8 is:error, or any text"
          value={trace.filter.value}
          onInput={(event) => (trace.filter.value = event.currentTarget.value)}
        />
        {trace.hasTokens.value && (
          <label class="field">
            <input type="checkbox" checked={trace.hidesTokens.value} onChange={(event) => (trace.hidesTokens.value = event.currentTarget.checked)} />
            <span>Hide tokens</span>
          </label>
        )}
        <button aria-pressed={trace.follows.value} onClick={() => (trace.follows.value = !trace.follows.value)}>
          Follow
        </button>
        <Find />
        {paused > 0 && (
          <button onClick={() => (trace.paused.value = new Map())}>
            Unmute {paused}
          </button>
        )}
        <SaveTrace />
        <span class="quiet">
          {trace.follows.value ? `newest first, the last ${trace.newest}` : `${trace.frames.value.length} telegrams, newest first`}
        </span>
      </div>
      {trace.problem.value && (
        <p class="bad" role="status">
          {trace.problem.value}
        </p>
      )}
      <Table />
      <Detail />
    </section>
  );
}
