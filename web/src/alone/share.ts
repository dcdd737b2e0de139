// What a link has in its fragment, which no browser sends anywhere: a plant with its files, packed by gzip, as base64 for
// addresses (#plant=), or the name of something that the page has itself: an example (#example=hoist), the failing program of
// a message's page or its mended one (#message=E0201, #message=E0201.right).
import { through } from "./archive";
import { bytesOf } from "./packed";
import type { Files } from "./stored";

const begin = "#plant=";
const begin_of_named = /^#(example|message)=([\w.-]+)$/;
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
  files: Record<string, string | { base64: string }>; // by path; bytes that are no UTF-8 as base64
}

function base64Of(bytes: Uint8Array): string {
  let text = "";
  for (const byte of bytes) text += String.fromCharCode(byte);
  return btoa(text).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
}

function bytesOfAddress(base64: string): Uint8Array<ArrayBuffer> {
  return bytesOf(base64.replaceAll("-", "+").replaceAll("_", "/"));
}

function written(bytes: Uint8Array): string | { base64: string } {
  try {
    return new TextDecoder("utf-8", { fatal: true, ignoreBOM: true }).decode(bytes);
  } catch {
    return { base64: base64Of(bytes) };
  }
}

function read(text: string | { base64: string }): Uint8Array<ArrayBuffer> {
  return typeof text === "string" ? new TextEncoder().encode(text) : bytesOfAddress(text.base64);
}

export async function linkOf({ name, plant, files }: Shared): Promise<string> {
  const content: InLink = { name, plant, files: {} };
  for (const path of Object.keys(files).sort()) content.files[path] = written(files[path] as Uint8Array);
  const packed = await through(new TextEncoder().encode(JSON.stringify(content)), new CompressionStream("gzip"));
  return location.href.replace(/#.*$/, "") + begin + base64Of(packed);
}

// What the page's own address brings along, once: after a reload the files are those of the storage.
export async function sharedFiles(): Promise<Shared | undefined> {
  if (!location.hash.startsWith(begin)) return undefined;
  const text = location.hash.slice(begin.length);
  history.replaceState(null, "", "#");
  const content = await contentOf(text).catch(() => undefined);
  if (!content) throw new Error("the link is cut or damaged");
  const { name, plant, files } = content;
  return {
    name,
    plant,
    files: Object.fromEntries(Object.entries(files).map(([path, text]) => [path, read(text)])),
  };
}

export interface Named {
  kind: string; // "example" or "message"
  name: string;
}

export function namedInAddress(): Named | undefined {
  const [, kind, name] = begin_of_named.exec(location.hash) ?? [];
  if (kind === undefined || name === undefined) return undefined;
  history.replaceState(null, "", "#");
  return { kind, name };
}

// A link that is put into the address of a page that is open.
export function onLink(act: () => void): void {
  addEventListener("hashchange", () => {
    if (location.hash.startsWith(begin) || begin_of_named.test(location.hash)) act();
  });
}

// Undefined: it has a path that leads out of the folder.
async function contentOf(base64: string): Promise<InLink | undefined> {
  const text = new TextDecoder().decode(await through(bytesOfAddress(base64), new DecompressionStream("gzip")));
  const content = JSON.parse(text) as InLink;
  const safe = (path: string) => path !== "" && !path.startsWith("/") && !path.split("/").includes("..");
  const { name, plant, files } = content;
  return safe(name) && !name.includes("/") && safe(plant) && Object.keys(files).every(safe) ? content : undefined;
}
