// What a telegram is known by: the identifier on CAN, the address on RS-485, source, destination and access points on
// PROFIBUS.
import type { FrameAddresses } from "../server/protocol";

interface Known extends FrameAddresses {
  id: number;
  extended: boolean;
}

function addressesText({ source, destination, ssap, dsap }: FrameAddresses): string {
  if (source === null || source === undefined) return "–";
  const points = ssap === null && dsap === null ? "" : `, SAP ${ssap ?? "–"} → ${dsap ?? "–"}`;
  return `${source} → ${destination}${points}`;
}

export function identityText(telegram: Known, kind: string | undefined): string {
  if (telegram.source !== undefined) return addressesText(telegram);
  if (kind !== undefined && kind !== "can") return String(telegram.id);
  return `${telegram.id} (${telegram.id.toString(16).toUpperCase().padStart(telegram.extended ? 8 : 3, "0")}h)`;
}

// To the microsecond, as a log has it.
export function microText(us: number): string {
  return (us / 1e6).toFixed(6);
}
