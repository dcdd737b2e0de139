// What went wrong, as alerts: a lost server stands before everything else, then a drive that has not answered the stop,
// ports that have gone, and what was refused last.
import { signal } from "@preact/signals";

import { standsAlone } from "../alone/packed";
import { Away, link, Refusal, request, type Message } from "../server/connection";
import { manual, ports, secondsText } from "../server/live";

const complaint = signal<string | null>(null);

export function complain(reason: unknown): void {
  if (reason instanceof Away) return;
  const text = reason instanceof Error ? reason.message : String(reason);
  complaint.value = reason instanceof Refusal && reason.refused ? `Refused: ${text}` : text;
}

export function forgive(): void {
  complaint.value = null;
}

// A command a person gave: what the server has against it is shown.
export async function command(message: Message): Promise<Message | undefined> {
  try {
    const reply = await request(message);
    forgive();
    return reply;
  } catch (reason) {
    complain(reason);
    return undefined;
  }
}

export function Notice() {
  if (link.value === "lost" && !standsAlone)
    return (
      <div class="notice">
        <span class="lamp fault" />
        <div role="alert">
          The connection to the server is lost. The page tries again by itself, and goes on when ipos serve runs again. If that
          prints another address, open it.
        </div>
      </div>
    );
  // One to which nobody has come yet is no loss.
  const lost = ports.value.filter((port) => !port.there && port.since_us !== null);
  return (
    <>
      {manual.value.alarm !== "" && (
        <div class="notice danger">
          <span class="lamp fault" />
          <div role="alert">{manual.value.alarm}</div>
        </div>
      )}
      {manual.value.left.map((text) => (
        <div class="notice" key={text}>
          <div role="status">After manual operation {text}.</div>
        </div>
      ))}
      {lost.map((port) => (
        <div class="notice" key={port.bus}>
          <span class="lamp fault" />
          <div role="alert">
            {port.bus}: port {port.name} is away since {secondsText(port.since_us ?? 0)}: {port.text}. The plant goes on
            without it.
          </div>
        </div>
      ))}
      {complaint.value !== null && (
        <div class="notice">
          <div role="alert">{complaint.value}</div>
          <button class="small" onClick={forgive}>
            Close message
          </button>
        </div>
      )}
    </>
  );
}
