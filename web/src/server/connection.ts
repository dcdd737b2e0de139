// The page's connection to its host: commands with their replies, topics that are asked for again when the host comes
// back, binary frames by the request that wanted them. Who carries them is given to connect().
import { signal } from "@preact/signals";

import type { Carrier, Carry } from "./carrier";
import { united, type Wish } from "./wishes";

export type Message = Record<string, unknown>;
export type Link = "connecting" | "open" | "lost";

// What the server answered instead of doing it; `refused` when the drive itself said no.
export class Refusal extends Error {
  constructor(
    text: string,
    readonly refused: boolean,
  ) {
    super(text);
  }
}

// There is no server to ask: the page says so by itself for as long as it lasts, whoever asked.
export class Away extends Error {}

interface Waiting {
  parts: Message[];
  done: (parts: Message[]) => void;
  failed: (reason: Error) => void;
}

export const link = signal<Link>("connecting");

let carrier: Carrier | undefined;
let next_id = 1;
// What views ask before the first server has come.
const early: string[] = [];
const waiting = new Map<number, Waiting>();
const views = new Map<number, (frame: DataView) => void>();
const topics = new Map<string, Wish[]>();
const listeners = new Map<string, (event: Message) => void>();

// Events that come without subscription.
export function listen(event: string, take: (event: Message) => void): void {
  listeners.set(event, take);
}

function transmit(command: Message): Promise<Message[]> {
  const id = next_id++;
  return new Promise((done, failed) => {
    const text = JSON.stringify({ id, ...command });
    if (carrier?.isOpen()) carrier.send(text);
    else if (link.peek() === "connecting") early.push(text);
    else return failed(new Away("The server is not there."));
    waiting.set(id, { parts: [], done, failed });
  });
}

// The reply; of a reply in parts the last one.
export async function request(command: Message): Promise<Message> {
  const parts = await transmit(command);
  return parts[parts.length - 1] ?? {};
}

export function requestParts(command: Message): Promise<Message[]> {
  return transmit(command);
}

// A command whose answer is a binary frame.
export function requestFrame(command: Message): Promise<DataView> {
  const id = next_id;
  return new Promise((done, failed) => {
    views.set(id, done);
    transmit(command).catch((reason: unknown) => {
      views.delete(id);
      failed(reason);
    });
  });
}

function ask(name: string, wishes: Wish[]): void {
  if (link.peek() === "open") void transmit({ do: "subscribe", topic: name, ...united(wishes) }).catch(() => undefined);
}

// One subscription a topic, whoever wants it. It is asked for anew with each that comes, so that this one gets everything.
export function subscribe(name: string, options: Message, take: (event: Message) => void): () => void {
  const wish = { options, take };
  const all = [...(topics.get(name) ?? []), wish];
  topics.set(name, all);
  ask(name, all);
  return () => {
    const before = topics.get(name) ?? [];
    const rest = before.filter((one) => one !== wish);
    if (rest.length === before.length) return;
    if (rest.length > 0) {
      topics.set(name, rest);
      if (JSON.stringify(united(rest)) !== JSON.stringify(united(before))) ask(name, rest);
      return;
    }
    topics.delete(name);
    if (link.peek() === "open") void transmit({ do: "unsubscribe", topic: name }).catch(() => undefined);
  };
}

function take(message: Message): void {
  if (typeof message.event === "string") {
    const wishes = topics.get(message.event);
    if (wishes) for (const wish of wishes) wish.take(message);
    else listeners.get(message.event)?.(message);
    return;
  }
  if (typeof message.re !== "number") return;
  const asked = waiting.get(message.re);
  if (!asked) return;
  if (typeof message.error === "string") {
    waiting.delete(message.re);
    asked.failed(new Refusal(message.error, message.refused === true));
    return;
  }
  asked.parts.push(message);
  if (message.more === true) return;
  waiting.delete(message.re);
  asked.done(asked.parts);
}

function takeFrame(frame: DataView): void {
  if (frame.byteLength < 8 || frame.getUint8(0) !== 1) return;
  const id = frame.getUint32(4, true);
  const done = views.get(id);
  views.delete(id);
  waiting.delete(id);
  done?.(frame);
}

export function connect(carry: Carry): void {
  carrier = carry({
    opened: () => {
      link.value = "open";
      for (const [name, wishes] of topics) ask(name, wishes);
      for (const text of early.splice(0)) carrier?.send(text);
    },
    text: (text) => take(JSON.parse(text) as Message),
    frame: takeFrame,
    lost: () => {
      link.value = "lost";
      const failed = [...waiting.values()];
      waiting.clear();
      views.clear();
      early.length = 0;
      for (const one of failed) one.failed(new Away("The server went away before it answered."));
    },
  });
}
