// What the document brings along when no server is behind it: the worker's script and ipos as WebAssembly, each packed by gzip.
// In ipos.html both stand in elements of the document as text (text_bytes.mjs); in the site the second is a file beside it.

import { bytesOfText } from "./text_bytes.mjs";

const script_id = "ipos-worker";
const wasm_id = "ipos-wasm";

function element(id: string): HTMLElement | null {
  return document.getElementById(id);
}

export const standsAlone = element(script_id) !== null;

export function bytesOf(base64: string): Uint8Array<ArrayBuffer> {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let at = 0; at < text.length; ++at) bytes[at] = text.charCodeAt(at);
  return bytes;
}

async function unpacked(stream: ReadableStream<BufferSource>): Promise<ArrayBuffer> {
  return new Response(stream.pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
}

async function packed(id: string): Promise<ArrayBuffer> {
  const place = element(id);
  if (!place) throw new Error(`the document has no ${id}`);
  const address = place.dataset.address;
  if (address === undefined) return unpacked(new Blob([bytesOfText(place.textContent ?? "", Number(place.dataset.bytes))]).stream());
  const answer = await fetch(address);
  if (!answer.ok || !answer.body) throw new Error(`${address}: ${answer.status}`);
  return answer.arrayBuffer();
}

export async function workerScript(): Promise<Blob> {
  return new Blob([await packed(script_id)], { type: "text/javascript" });
}

export function webAssembly(): Promise<ArrayBuffer> {
  return packed(wasm_id);
}
