// The one WebSocket of the page: commands with their replies, topics that are asked for again when the server comes
// back, binary frames by the request that wanted them.
import { signal } from "@preact/signals";

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

interface Waiting {
  parts: Message[];
  done: (parts: Message[]) => void;
  failed: (reason: Error) => void;
}

export const link = signal<Link>("connecting");

const first_pause_ms = 300;
const longest_pause_ms = 3000;

let socket: WebSocket | undefined;
let pause_ms = first_pause_ms;
let next_id = 1;
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
    if (socket?.readyState !== WebSocket.OPEN) {
      failed(new Refusal("The server is not there.", false));
      return;
    }
    waiting.set(id, { parts: [], done, failed });
    socket.send(JSON.stringify({ id, ...command }));
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

export function connect(): void {
  const address = new URL("/ws", location.href);
  address.protocol = location.protocol === "https:" ? "wss:" : "ws:";
  address.search = location.search;
  socket = new WebSocket(address);
  socket.binaryType = "arraybuffer";
  socket.onopen = () => {
    pause_ms = first_pause_ms;
    link.value = "open";
    for (const [name, wishes] of topics) ask(name, wishes);
  };
  socket.onmessage = (event: MessageEvent<string | ArrayBuffer>) => {
    if (typeof event.data === "string") take(JSON.parse(event.data) as Message);
    else takeFrame(new DataView(event.data));
  };
  socket.onclose = () => {
    link.value = "lost";
    const failed = [...waiting.values()];
    waiting.clear();
    views.clear();
    for (const one of failed) one.failed(new Refusal("The server went away before it answered.", false));
    setTimeout(connect, pause_ms);
    pause_ms = Math.min(pause_ms * 2, longest_pause_ms);
  };
}
