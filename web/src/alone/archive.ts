// A folder as one zip file and back: stored or deflated entries, no encryption, no parts, as every system's tools make and
// read them (APPNOTE.TXT 4.3 of PKWARE has the records).
import { crc32 } from "../picture/crc";
import type { Files } from "./stored";

const local_header = 0x04034b50;
const central_header = 0x02014b50;
const end_of_directory = 0x06054b50;
const deflated = 8;
const names_are_utf8 = 0x0800;
const day = 0x21; // 1 January 1980: an archive of the same files has the same bytes

type Bytes = Uint8Array<ArrayBuffer>;

export async function through(bytes: Bytes, stream: GenericTransformStream): Promise<Bytes> {
  return new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(stream)).arrayBuffer());
}

// Numbers of two and four bytes, one after the other: [size, value].
function record(...fields: [2 | 4, number][]): Bytes {
  const bytes = new Uint8Array(fields.reduce((sum, [size]) => sum + size, 0));
  const view = new DataView(bytes.buffer);
  let at = 0;
  for (const [size, value] of fields) {
    if (size === 2) view.setUint16(at, value, true);
    else view.setUint32(at, value, true);
    at += size;
  }
  return bytes;
}

// Of paths without a slash in front.
export async function archiveOf(files: Files): Promise<Blob> {
  const parts: Bytes[] = [];
  const directory: Bytes[] = [];
  let offset = 0;
  for (const path of Object.keys(files).sort()) {
    const bytes = files[path] as Bytes;
    const name = new TextEncoder().encode(path);
    const packed = await through(bytes, new CompressionStream("deflate-raw"));
    const described: [2 | 4, number][] = [
      [2, 20], // version that is needed
      [2, names_are_utf8],
      [2, deflated],
      [2, 0],
      [2, day],
      [4, crc32(bytes)],
      [4, packed.length],
      [4, bytes.length],
      [2, name.length],
      [2, 0],
    ];
    directory.push(record([4, central_header], [2, 20], ...described, [2, 0], [2, 0], [2, 0], [4, 0], [4, offset]), name);
    const head = record([4, local_header], ...described);
    parts.push(head, name, packed);
    offset += head.length + name.length + packed.length;
  }
  const count = Object.keys(files).length;
  const directory_size = directory.reduce((sum, one) => sum + one.length, 0);
  const end = record([4, end_of_directory], [2, 0], [2, 0], [2, count], [2, count], [4, directory_size], [4, offset], [2, 0]);
  return new Blob([...parts, ...directory, end], { type: "application/zip" });
}

const smallest_end = 22;

export async function filesOf(archive: Bytes): Promise<Files> {
  const view = new DataView(archive.buffer, archive.byteOffset, archive.byteLength);
  let end = archive.length - smallest_end;
  while (end >= 0 && view.getUint32(end, true) !== end_of_directory) --end;
  if (end < 0) throw new Error("this is no zip archive");
  const files: Files = {};
  let at = view.getUint32(end + 16, true);
  for (let left = view.getUint16(end + 10, true); left > 0; --left) {
    if (view.getUint32(at, true) !== central_header) throw new Error("the archive is damaged");
    const method = view.getUint16(at + 10, true);
    const size = view.getUint32(at + 20, true);
    const name_length = view.getUint16(at + 28, true);
    const name = new TextDecoder().decode(archive.subarray(at + 46, at + 46 + name_length));
    const local = view.getUint32(at + 42, true);
    const begin = local + 30 + view.getUint16(local + 26, true) + view.getUint16(local + 28, true);
    const packed = archive.slice(begin, begin + size);
    at += 46 + name_length + view.getUint16(at + 30, true) + view.getUint16(at + 32, true);
    if (name.endsWith("/")) continue; // a folder
    if (name.split("/").includes("..") || name.startsWith("/")) throw new Error(`the archive has a file outside of it: ${name}`);
    if (method !== 0 && method !== deflated) throw new Error(`${name}: packed in a way that is not known here`);
    files[name] = method === 0 ? packed : await through(packed, new DecompressionStream("deflate-raw"));
  }
  return files;
}
