// The real ports of the plant's lines, and whether they are there.
import { ports, secondsText } from "../server/live";
import type { PortState } from "../server/protocol";

function stateText({ there, text, since_us }: PortState): string {
  const since = since_us === null ? "" : ` since ${secondsText(since_us)}`;
  return there ? `there${since}` : `away${since}: ${text}`;
}

export function Ports() {
  if (ports.value.length === 0) return null;
  return (
    <section class="panel ports" aria-label="Ports">
      <h2 class="caption">Ports</h2>
      {ports.value.map((port) => (
        <p key={port.bus}>
          {port.bus}: {port.name}, <span role="status" aria-label={`Port of ${port.bus}`}>{stateText(port)}</span>
        </p>
      ))}
    </section>
  );
}
