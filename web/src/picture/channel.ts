// What the picture is told of a curve, and where it draws it: numbers in a panel for each unit, levels, bits and words in
// lanes below. The page, plots and reports have it from one place (tools/recording/channel_json.cpp).

export interface Channel {
  name: string;
  unit: string;
  decimals: number;
  kind?: "curve" | "level" | "word" | "words"; // left out: a curve
  bit_names?: [number, string][]; // of a word
  texts?: [number, string][]; // of a value & mask
  mask?: number;
}

// What a person has said of a channel: in a panel of its own number, or in a lane.
export type Place = string; // "": by its unit, "lane", or the number of a panel

export interface Panel {
  title: string;
  channels: number[]; // in the order they are drawn
}
export interface Lane {
  channel: number;
  bit: number | null; // of a word; null: the whole
  text: string;
}

export const colour_count = 8;
const lane_bits = 16;
const most_bit_lanes = 24; // of all words; where there would be more, a word is one strip

export function ownName(channel: Channel): string {
  return channel.name.slice(channel.name.lastIndexOf(".") + 1);
}

// A setpoint lies under what follows it: drawn first and wide, so both are seen where they are equal.
export function isSetpoint(channel: Channel): boolean {
  return channel.name.endsWith("setpoint");
}

export function isCurve(channel: Channel, place: Place = ""): boolean {
  if (place === "lane") return false;
  return place !== "" || (channel.kind ?? "curve") === "curve";
}

export function panelsOf(channels: Channel[], places: Place[] = []): Panel[] {
  const panels = new Map<string, Panel>();
  channels.forEach((channel, number) => {
    const place = places[number] ?? "";
    if (!isCurve(channel, place)) return;
    const key = place ? `panel ${place}` : `unit ${channel.unit}`;
    const panel = panels.get(key) ?? { title: channel.unit || "value", channels: [] };
    if (place && !panel.title.split(", ").includes(channel.unit || "value") && panel.channels.length > 0)
      panel.title += `, ${channel.unit || "value"}`;
    panel.channels.push(number);
    panels.set(key, panel);
  });
  for (const panel of panels.values())
    panel.channels.sort((a, b) => Number(isSetpoint(channels[b] as Channel)) - Number(isSetpoint(channels[a] as Channel)));
  return [...panels.values()];
}

function bitsOf(word: number): [number, string][] {
  return Array.from({ length: lane_bits }, (_, bit): [number, string] => [bit, ""]).filter(([bit]) => (word >> bit) & 1);
}

// Of a word its bits with a name, else all that were on; and what it says as a whole.
export function lanesOf(channels: Channel[], places: Place[], seen: (channel: number) => number): Lane[] {
  const lanes: Lane[] = [];
  const named = channels.reduce((sum, channel) => sum + (channel.kind === "word" ? (channel.bit_names?.length ?? 0) : 0), 0);
  channels.forEach((channel, number) => {
    if (isCurve(channel, places[number])) return;
    if (channel.kind !== "word") {
      lanes.push({ channel: number, bit: null, text: channel.name });
      return;
    }
    if (channel.texts || !channel.bit_names) lanes.push({ channel: number, bit: null, text: channel.name });
    if (channel.texts && named > most_bit_lanes) return;
    const bits = channel.bit_names ?? bitsOf(seen(number));
    for (const [bit, text] of bits)
      lanes.push({ channel: number, bit, text: `${channel.name}.${bit}${text ? ` ${text}` : ""}` });
  });
  return lanes;
}

function hex(value: number, digits: number): string {
  return `${Math.round(value).toString(16).toUpperCase().padStart(digits, "0")}h`;
}

// The words of a value, of which a word may have been more than one: then nothing is said.
export function wordsOf(channel: Channel, least: number, greatest: number): string | null {
  const mask = channel.mask ?? -1;
  const part = (value: number) => (mask === -1 ? value : value & mask);
  if (part(least) !== part(greatest)) return null;
  const text = channel.texts?.find(([value]) => value === part(least))?.[1];
  if (text !== undefined) return text;
  return channel.kind === "word" ? hex(least, 4) : String(least);
}

export function valueText(channel: Channel, value: number | null | undefined): string {
  if (value === null || value === undefined || Number.isNaN(value)) return "–";
  if (channel.kind === "word") return hex(value, 4);
  if (channel.kind === "words") return wordsOf(channel, value, value) ?? String(value);
  return value.toFixed(Math.min(channel.decimals, 6));
}
