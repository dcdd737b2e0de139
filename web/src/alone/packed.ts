// What the document brings along when no server is behind it: the worker's script and ipos as WebAssembly, each packed by gzip.
// In ipos.html both stand in elements of the document as text, 13 bits in two characters (web/wasm/site.mjs), which is 8 %
// shorter than base64; in the site the second is a file beside it.

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

// Characters from ! to ~ but ", < and \\ stand for 0 to 90.
function bytesOfText(text: string, count: number): Uint8Array<ArrayBuffer> {
  const digit = (at: number) => {
    const code = text.charCodeAt(at);
    return code - 33 - Number(code > 34) - Number(code > 60) - Number(code > 92);
  };
  const bytes = new Uint8Array(count);
  let held = 0;
  let bits = 0;
  let next = 0;
  for (let at = 0; next < count; at += 2) {
    held |= (digit(at) * 91 + digit(at + 1)) << bits;
    for (bits += 13; bits >= 8 && next < count; bits -= 8) {
      bytes[next++] = held & 255;
      held >>>= 8;
    }
  }
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
