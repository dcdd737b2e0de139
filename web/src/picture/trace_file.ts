// A trace that `ipos run --trace FILE.ipos-trace` has written, as what a plot shows. docs/reference/trace-file.md has the bytes.
// Numbers are those of JavaScript, exact to 53 bits; no signal of a drive has more.
import type { Recorded, RecordedChannel } from "./plot";
import { crc32 } from "./crc";
import { ms_us } from "./points";

const magic = [0x89, 0x49, 0x50, 0x4f, 0x53, 0x74, 0x72, 0x63, 0x0d, 0x0a, 0x1a, 0x0a];
const version = 1;
const header = 12;
const checksum = 4;
const most_content = 2 ** 28;
const most_samples = 100e6; // of all signals: 800 MB

type Bytes = Uint8Array<ArrayBuffer>;

interface Head {
  signals: (RecordedChannel & { factor: number })[];
  tracks: { bus: string; can: boolean }[];
}

export class TraceError extends Error {
  constructor(offset: number, text: string) {
    super(`byte ${offset}: ${text}`);
  }
}

// Numbers of seven bits a byte, and texts behind their length.
class Numbers {
  private at = 0;
  constructor(private readonly bytes: Bytes) {}
  byte(): number {
    const byte = this.bytes[this.at++];
    if (byte === undefined) throw new Error("the block ends within a number or a text");
    return byte;
  }
  number(): number {
    for (let value = 0, scale = 1; ; scale *= 128) {
      const byte = this.byte();
      value += (byte & 0x7f) * scale;
      if (byte < 0x80) return value;
      if (scale > 2 ** 60) throw new Error("a number has more than 64 bits");
    }
  }
  signed(): number {
    const value = this.number();
    return value % 2 === 1 ? -(value + 1) / 2 : value / 2;
  }
  part(): Bytes {
    const length = this.number();
    if (length > this.bytes.length - this.at) throw new Error("the block ends within a number or a text");
    return this.bytes.subarray(this.at, (this.at += length));
  }
  atEnd(): boolean {
    return this.at === this.bytes.length;
  }
}

// The samples of a signal, row by row, as numbers that people read.
class Column {
  private values = new Float64Array(4096);
  length = 0;
  constructor(private readonly factor: number) {}
  add(sample: number, count: number): void {
    if (this.length + count > this.values.length) {
      const more = new Float64Array(Math.max(this.length + count, 2 * this.values.length));
      more.set(this.values);
      this.values = more;
    }
    this.values.fill(this.factor === 1 ? sample : sample * this.factor, this.length, (this.length += count));
  }
  all(): Float64Array {
    return this.values.subarray(0, this.length);
  }
}

class Trace {
  readonly columns: Column[];
  readonly events: Recorded["events"] = [];
  readonly frames: number[][];
  first_ns = -1;
  last_ns = -1;
  constructor(readonly head: Head) {
    this.columns = head.signals.map((signal) => new Column(signal.factor));
    this.frames = head.tracks.map(() => []);
  }

  take(numbers: Numbers): void {
    const rows: number[] = []; // milliseconds of each, from the row before on
    let time = 0;
    for (let runs = numbers.number(); runs > 0; --runs) {
      const [gap, step, count] = [numbers.number(), numbers.number(), numbers.number()];
      for (let n = 0; n < count; ++n) {
        time += n === 0 ? gap : step;
        if (time <= this.last_ns) throw new Error("the times of the rows do not rise");
        if (this.first_ns < 0) this.first_ns = time;
        rows.push(this.last_ns < 0 ? 1 : Math.round((time - this.last_ns) / 1e6));
        this.last_ns = time;
        if (rows.length * this.columns.length > most_samples) throw new Error("the block has a number of rows that it cannot have");
      }
    }
    for (const column of this.columns) takeColumn(new Numbers(numbers.part()), rows, column);
    time = 0;
    for (let count = numbers.number(); count > 0; --count) {
      time += numbers.number();
      const fault = numbers.byte() !== 0;
      this.events.push({ time: time / 1e6, fault, text: new TextDecoder().decode(numbers.part()) });
    }
    time = 0;
    for (let count = numbers.number(); count > 0; --count) {
      time += numbers.number();
      const track = this.frames[numbers.number()];
      const marks = numbers.byte();
      numbers.number();
      numbers.part();
      if (marks & 4) numbers.part();
      if (!track) throw new Error("a frame is of a bus that is not there");
      track.push(time / 1e6);
    }
    if (!numbers.atEnd()) throw new Error("the block goes on behind its frames");
  }
}

// A picture has a sample each millisecond: where rows are left out the sample before holds.
function takeColumn(numbers: Numbers, rows: number[], column: Column): void {
  let value = numbers.signed();
  const runs = Array.from({ length: numbers.number() }, (): [number, number] => [numbers.number(), numbers.number()]);
  let row = 0;
  const put = (changed: number) => {
    const ms = rows[row++];
    if (ms === undefined) throw new Error("a column changes in rows that are not there");
    if (ms > 1) column.add(value, ms - 1);
    column.add((value = changed), 1);
  };
  for (const [skipped, count] of runs) {
    for (let n = 0; n < skipped; ++n) put(value);
    for (let n = 0, step = 0; n < count; ++n) put(value + (step += numbers.signed()));
  }
  while (row < rows.length) put(value);
  if (!numbers.atEnd()) throw new Error("a column has another length than it says");
}

async function inflated(bytes: Bytes): Promise<Bytes> {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// On or off: a lane. Also a plain number that was only 0 and 1.
function isBinary(signal: RecordedChannel & { factor: number; bits: number }, values: Float64Array): boolean {
  if (signal.bits !== 0) return signal.bits === 1;
  return signal.unit === "" && signal.factor === 1 && values.includes(1) && values.every((value) => value === 0 || value === 1);
}

export async function readTrace(file: ArrayBuffer, name: string): Promise<Recorded> {
  const bytes = new Uint8Array(file);
  const view = new DataView(file);
  if (magic.some((byte, n) => bytes[n] !== byte)) throw new TraceError(0, "this is no .ipos-trace");
  let at = magic.length + 4;
  if (bytes.length < at || view.getUint32(magic.length, true) !== version) throw new TraceError(magic.length, "the trace is of another version");
  let trace: Trace | undefined;
  let ended = false;
  while (!ended && bytes.length - at >= header + checksum) {
    const length = view.getUint32(at + 4, true);
    const end = at + header + length;
    if (end + checksum > bytes.length) break; // the run that wrote it was killed
    if (crc32(bytes.subarray(at, end)) !== view.getUint32(end, true)) throw new TraceError(at, "the block is damaged: its checksum differs");
    try {
      const size = view.getUint32(at + 8, true);
      let content = bytes.slice(at + header, end);
      if (bytes[at + 1] === 1 && size <= most_content) content = await inflated(content);
      if (content.length !== size) throw new Error("the block has another length than it says");
      const kind = String.fromCharCode(bytes[at] as number);
      if (kind === "H" && !trace) trace = new Trace(JSON.parse(new TextDecoder().decode(content)) as Head);
      else if (kind === "R" && trace) trace.take(new Numbers(content));
      else if (kind === "E" && trace) ended = true;
      else throw new Error("the block does not belong here");
    } catch (reason) {
      throw new TraceError(at, reason instanceof Error ? reason.message : String(reason));
    }
    at = end + checksum;
  }
  if (!trace) throw new TraceError(at, "the file ends before it says what was recorded");
  const { head, columns, events, frames } = trace;
  const begin = trace.first_ns < 0 ? 1 : trace.first_ns / 1e6;
  return {
    title: ended ? name : `${name} (ends early: the run was killed, or has not ended)`,
    begin,
    end: Math.max(0, trace.last_ns / 1e6),
    samples: { first_us: begin * ms_us, values: columns.map((column) => column.all()) },
    signals: head.signals.map((signal, n) => ({ ...signal, binary: isBinary(signal as never, (columns[n] as Column).all()) })),
    events,
    tracks: head.tracks.map((track, n) => ({ name: `${track.bus}.frames`, times: frames[n] as number[] })),
  };
}
