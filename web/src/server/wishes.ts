// What several views want of one topic, as one subscription: as often as the one that wants it most often, as fine as the
// one that wants it finest, and every name of every list. Of anything else there is one, and it is that of the last.
import type { Message } from "./connection";

export interface Wish {
  options: Message;
  take: (event: Message) => void;
}

const most = new Set(["rate"]);
const least = new Set(["step_ms"]);

function both(option: string, one: unknown, other: unknown): unknown {
  if (typeof one === "number" && typeof other === "number") {
    if (most.has(option)) return Math.max(one, other);
    if (least.has(option)) return Math.min(one, other);
  }
  if (Array.isArray(one) && Array.isArray(other)) return [...new Set([...(one as unknown[]), ...(other as unknown[])])];
  return other;
}

export function united(wishes: Wish[]): Message {
  const all: Message = {};
  for (const { options } of wishes)
    for (const [option, value] of Object.entries(options)) all[option] = option in all ? both(option, all[option], value) : value;
  return all;
}
