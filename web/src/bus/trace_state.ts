// The telegrams that are looked at: the newest ones as they come, or those around a moment. The server filters and keeps
// them; the page asks for what it does not have yet, so an idle or a hidden trace costs nothing.
import { computed, effect, signal } from "@preact/signals";

import { Refusal, request, type Message } from "../server/connection";
import { generation, hello, plant, time } from "../server/live";
import type { TraceFrame } from "../server/protocol";
import { shared } from "../server/shared";
import { complain } from "../shell/notice";
import { setting } from "../shell/settings";
import { keyOf } from "./rows";

const refresh_ms = 500;
export const newest = 200; // telegrams that a trace has which follows
const most_kept = 20_000;
const patience = 50; // questions for a filter that takes little

export const line = setting("bus.line", "");
export const hidesTokens = setting("bus.tokens", false);
export const filter = signal("");
export const follows = signal(true);
export const frames = signal<TraceFrame[]>([]); // newest first
export const chosen = signal<TraceFrame | null>(null);
export const problem = signal(""); // of the filter
export const complete = signal(false); // nothing older is kept
// Identifiers that are paused, with the number of the last telegram before.
export const paused = signal<ReadonlyMap<string, Message & { since: number }>>(new Map());

export const lineKinds = computed(() => new Map(plant.value?.buses.map((bus) => [bus.name, bus.kind])));
export const chosenLine = computed(() => (lineKinds.value.has(line.value) ? line.value : ""));
export const hasTokens = computed(() => (chosenLine.value ? lineKinds.value.get(chosenLine.value) === "profibus" : [...lineKinds.value.values()].includes("profibus")));

// What the server shall choose.
export const choice = computed<Message>(() => ({
  ...(chosenLine.value ? { bus: chosenLine.value } : {}),
  filter: `${filter.value}${hasTokens.value && hidesTokens.value ? " -token" : ""}`.trim(),
  paused: [...paused.value.values()],
}));

let known = 0; // number of the last telegram that was looked at
let begun = 0; // an answer to what was asked before a new beginning counts for nothing
let asks = false;
let asked_us = -1;
// What the rows fit, and where a trace stands that does not follow: at most this number; null: the newest one of now.
let drawn: Message | null = null;
let stands_at: number | null = null;

interface Answer {
  frames: TraceFrame[];
  last: number;
  reached: number | null;
}

// Older ones until there are enough; a filter that takes little makes the server stop on its way.
async function search(bounds: Message, limit: number, wanted: Message): Promise<TraceFrame[]> {
  let found: TraceFrame[] = [];
  let before = bounds.before as number | undefined;
  const began = begun;
  for (let turn = 0; turn < patience; ++turn) {
    const reply = (await request({
      do: "bus.trace",
      ...wanted,
      ...bounds,
      ...(before === undefined ? {} : { before }),
      limit: limit - found.length,
    })) as unknown as Answer;
    found = [...found, ...reply.frames.reverse()];
    if (bounds.before === undefined && turn === 0 && began === begun) known = reply.last;
    if (reply.reached === null || found.length >= limit || wanted !== choice.peek()) break;
    before = reply.reached;
  }
  return found;
}

function notice(reason: unknown): void {
  if (reason instanceof Refusal) problem.value = reason.message;
  else complain(reason);
}

async function look(): Promise<void> {
  if (asks || !follows.peek() || asked_us === time.peek().us) return;
  asks = true;
  const wanted = choice.peek();
  asked_us = time.peek().us;
  const first = known === 0;
  const began = begun;
  try {
    const fresh = await search(first ? {} : { after: known }, newest, wanted);
    if (began !== begun || wanted !== choice.peek() || !follows.peek()) return;
    problem.value = "";
    if (first || fresh.length > 0) {
      frames.value = (fresh.length === newest ? fresh : [...fresh, ...(first ? [] : frames.peek())]).slice(0, newest);
      complete.value = frames.peek().length < newest;
    }
    drawn = wanted;
  } catch (reason) {
    if (wanted === choice.peek()) notice(reason);
  } finally {
    asks = false;
    if (began !== begun || wanted !== choice.peek()) void look();
  }
}

function begin(): void {
  ++begun;
  known = 0;
  asked_us = -1;
  stands_at = null;
  if (follows.peek()) void look();
  else void choose();
}

// Where it stands, the rows that fit by now.
async function choose(): Promise<void> {
  const wanted = choice.peek();
  const began = begun;
  try {
    const found = await search(stands_at === null ? {} : { before: stands_at + 1 }, newest, wanted);
    if (began !== begun || wanted !== choice.peek() || follows.peek()) return;
    stands_at ??= known;
    problem.value = "";
    frames.value = found;
    complete.value = found.length < newest;
    drawn = wanted;
  } catch (reason) {
    if (wanted === choice.peek()) notice(reason);
  }
}

// Those before the oldest one that is there.
export async function older(): Promise<void> {
  const last = frames.peek().at(-1);
  if (asks || complete.peek() || !last || frames.peek().length >= most_kept) return;
  asks = true;
  const wanted = choice.peek();
  try {
    const more = await search({ before: last.n }, newest, wanted);
    if (wanted !== choice.peek()) return;
    complete.value = more.length < newest;
    frames.value = [...frames.peek(), ...more];
  } catch (reason) {
    notice(reason);
  } finally {
    asks = false;
  }
}

// The next one further back with this text, whether it is loaded or not; then the trace stands there.
export async function find(text: string): Promise<boolean> {
  const wanted = choice.peek();
  const from = chosen.peek()?.n;
  follows.value = false;
  const both = { ...wanted, filter: `${String(wanted.filter)} ${text}`.trim() };
  const [found] = await search(from === undefined ? {} : { before: from }, 1, both);
  if (!found) return false;
  await show(found);
  return true;
}

export async function show(frame: TraceFrame): Promise<void> {
  follows.value = false;
  chosen.value = frame;
  if (frames.peek().some((one) => one.n === frame.n)) return;
  // It may lie beside the filter: an answer to what the filter takes.
  const around = await search({ before: frame.n + 20 }, newest, choice.peek());
  stands_at = frame.n + 19;
  frames.value = around.some((one) => one.n === frame.n) ? around : [...around, frame].sort((a, b) => b.n - a.n);
  complete.value = around.length < newest;
}

export function pause(telegram: { bus: string; id: number; extended: boolean; remote: boolean }): void {
  const next = new Map(paused.peek());
  const key = keyOf(telegram);
  const { bus, id, extended, remote } = telegram;
  if (!next.delete(key)) next.set(key, { bus, id, extended, remote, since: known });
  paused.value = next;
}

export const followTrace = shared(() => {
  const ends = [
    // Another plant or another time: nothing of before counts.
    effect(() => {
      void generation.value;
      void hello.value;
      frames.value = [];
      chosen.value = null;
      paused.value = new Map();
      begin();
    }),
    effect(() => {
      const wanted = choice.value;
      if (follows.value) return begin();
      stands_at ??= known || null;
      if (drawn !== wanted) void choose();
      return undefined;
    }),
  ];
  const timer = setInterval(() => void look(), refresh_ms);
  return () => {
    for (const end of ends) end();
    clearInterval(timer);
  };
});
