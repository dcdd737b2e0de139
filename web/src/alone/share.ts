// A link that has a plant with its files in its fragment, which no browser sends anywhere: packed by gzip, as base64 for
// addresses. `#plant=` and so on.
import { through } from "./archive";
import { bytesOf } from "./packed";
import type { Files } from "./stored";

const begin = "#plant=";
// Longer ones are cut by mail programs and chats (ours).
export const longest_link = 8192;

export interface Shared {
  name: string; // of the folder
  plant: string; // of the plant file in it
  files: Files;
}

interface InLink {
  name: string;
  plant: string;
  files: Record<string, string>;
}

function base64Of(bytes: Uint8Array): string {
  let text = "";
  for (const byte of bytes) text += String.fromCharCode(byte);
  return btoa(text).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
}

export async function linkOf({ name, plant, files }: Shared): Promise<string> {
  const texts: Record<string, string> = {};
  for (const path of Object.keys(files).sort()) texts[path] = new TextDecoder().decode(files[path]);
  const content: InLink = { name, plant, files: texts };
  const packed = await through(new TextEncoder().encode(JSON.stringify(content)), new CompressionStream("gzip"));
  return location.href.replace(/#.*$/, "") + begin + base64Of(packed);
}

// What the page's own address brings along.
export async function sharedFiles(): Promise<Shared | undefined> {
  if (!location.hash.startsWith(begin)) return undefined;
  const packed = bytesOf(location.hash.slice(begin.length).replaceAll("-", "+").replaceAll("_", "/"));
  const text = new TextDecoder().decode(await through(packed, new DecompressionStream("gzip")));
  const { name, plant, files } = JSON.parse(text) as InLink;
  const safe = (path: string) => path !== "" && !path.startsWith("/") && !path.split("/").includes("..");
  if (!safe(name) || name.includes("/") || !safe(plant) || !Object.keys(files).every(safe))
    throw new Error("the link is damaged");
  return {
    name,
    plant,
    files: Object.fromEntries(Object.entries(files).map(([path, text]) => [path, new TextEncoder().encode(text)])),
  };
}
