// The worker of a page without a server: ipos as WebAssembly with its files. It carries messages between the page and the
// host, gives the host its turns, and runs verbs, each in an instance of its own as a process would have it.
import type { Ask, Ended, FromWorker, ToWorker } from "./worker_messages";

// As web/wasm/site.mjs puts emscripten's script in front of this one.
interface FileSystem {
  readdir(path: string): string[];
  stat(path: string): { mode: number; mtime: Date; size: number };
  isDir(mode: number): boolean;
  readFile(path: string): Uint8Array<ArrayBuffer>;
  writeFile(path: string, bytes: Uint8Array): void;
  mkdirTree(path: string): void;
  unlink(path: string): void;
  chdir(path: string): void;
}
interface Instance {
  FS: FileSystem;
  HEAPU8: Uint8Array;
  callMain(words: string[]): number;
  _malloc(size: number): number;
  _free(at: number): void;
  _ipos_open(path: number): number;
  _ipos_open_to_mend(path: number): number;
  _ipos_open_gallery(): number;
  _ipos_take(kind: number, client: number, body: number, size: number): void;
  _ipos_turn(): number;
}
declare const ipos: (options: Record<string, unknown>) => Promise<Instance>;
declare const self: {
  postMessage(message: FromWorker, transfer?: Transferable[]): void;
  onmessage: (event: MessageEvent<ToWorker>) => void;
};

const home = "/home"; // what is stored lies below
// As tools/serve/host/message.hpp counts them.
const opened = 0;
const text_to_host = 1;
const drained = 3;
const reply = 5;
const event = 6;
const binary = 7;
const client = 1; // there is one

let wasm: WebAssembly.Module;
let host: Instance;
let has_host = false;
const encoder = new TextEncoder();
const decoder = new TextDecoder();

function tell(message: FromWorker, transfer: Transferable[] = []): void {
  self.postMessage(message, transfer);
}

interface Output {
  out: number[];
  err: number[];
}

function newInstance(output: Output): Promise<Instance> {
  return ipos({
    instantiateWasm: (imports: WebAssembly.Imports, done: (instance: WebAssembly.Instance) => void) => {
      void WebAssembly.instantiate(wasm, imports).then(done);
      return {};
    },
    stdin: () => null,
    stdout: (byte: number | null) => byte !== null && output.out.push(byte & 0xff),
    stderr: (byte: number | null) => byte !== null && output.err.push(byte & 0xff),
    take: (kind: number, _to: number, bytes: Uint8Array) => {
      if (kind === binary) {
        const frame = bytes.slice().buffer;
        tell({ kind: "frame", frame }, [frame]);
        return;
      }
      // The page stores what a command has written before it shows that it is done: who sees "Saved" may leave at once.
      if (kind === reply) storeChanges();
      if (kind === reply || kind === event)
        tell({ kind: "text", text: decoder.decode(bytes), drains: kind === event ? bytes.length : 0 });
    },
  });
}

function textOf(bytes: number[]): string {
  return decoder.decode(new Uint8Array(bytes.splice(0)));
}

// --- files ---

function filesBelow(files: FileSystem, folder: string, found: string[] = []): string[] {
  for (const name of files.readdir(folder)) {
    if (name === "." || name === "..") continue;
    const path = `${folder}/${name}`;
    if (files.isDir(files.stat(path).mode)) filesBelow(files, path, found);
    else found.push(path);
  }
  return found;
}

function writeFile(files: FileSystem, path: string, bytes: Uint8Array): void {
  files.mkdirTree(path.slice(0, path.lastIndexOf("/")));
  files.writeFile(path, bytes);
}

const stored = new Map<string, string>(); // by path: time and size of what the page has stored

function stamp(path: string): string {
  const { mtime, size } = host.FS.stat(path);
  return `${mtime.getTime()} ${size}`;
}

function storeChanges(): void {
  const files: Record<string, Uint8Array<ArrayBuffer> | null> = {};
  const there = filesBelow(host.FS, home);
  const now = Date.now();
  for (const path of there)
    if (stored.get(path) !== stamp(path)) {
      // Of this millisecond: it may be written again with the same stamp.
      stored.set(path, host.FS.stat(path).mtime.getTime() < now ? stamp(path) : "");
      files[path] = host.FS.readFile(path);
    }
  for (const path of [...stored.keys()])
    if (!there.includes(path)) {
      stored.delete(path);
      files[path] = null;
    }
  if (Object.keys(files).length !== 0) tell({ kind: "changed", files });
}

// --- the host ---

const output: Output = { out: [], err: [] };

function withBytes(bytes: Uint8Array, use: (at: number) => void): void {
  const at = host._malloc(bytes.length + 1);
  host.HEAPU8.set(bytes, at);
  host.HEAPU8[at + bytes.length] = 0;
  try {
    use(at);
  } finally {
    host._free(at);
  }
}

function give(kind: number, text: string): void {
  const bytes = encoder.encode(text);
  withBytes(bytes, (at) => host._ipos_take(kind, client, at, bytes.length));
}

// A timer waits four milliseconds at least; a message to oneself does not.
const at_once = new MessageChannel();
at_once.port1.onmessage = () => turn();
let timer: ReturnType<typeof setTimeout> | undefined;
let asked_at_once = false;

function turn(): void {
  asked_at_once = false;
  clearTimeout(timer);
  if (!has_host) return;
  guarded(() => {
    const wait = host._ipos_turn();
    if (wait < 1) turnSoon();
    else timer = setTimeout(turn, wait);
  });
}

function turnSoon(): void {
  if (asked_at_once) return;
  asked_at_once = true;
  at_once.port2.postMessage(null);
}

// An instance that has failed is not asked again.
function guarded(act: () => void): void {
  try {
    act();
  } catch (problem) {
    has_host = false;
    tell({ kind: "broken", text: `${String(problem)} ${textOf(output.err)}` });
  }
}

// `begin` gives 0 or what an exit code would be.
function hostIn(folder: string, path: string | null, begin: () => number): void {
  has_host = false;
  output.err.length = 0;
  host.FS.chdir(folder);
  if (begin() !== 0) throw new Error(textOf(output.err));
  has_host = true;
  tell({ kind: "opened", path });
  give(opened, "");
  turnSoon();
}

// A plant that has mistakes is opened to be mended. Returns them.
function open(path: string): string {
  const name = path.lastIndexOf("/") + 1;
  let mistakes = "";
  hostIn(path.slice(0, name - 1), path, () => {
    let code = 1;
    withBytes(encoder.encode(path.slice(name)), (at) => {
      code = host._ipos_open(at);
      if (code === 0 || path.endsWith(".ipos")) return;
      mistakes = textOf(output.err);
      code = host._ipos_open_to_mend(at);
    });
    return code;
  });
  return mistakes;
}

// --- verbs ---

async function verb(folder: string, words: string[]): Promise<Ended> {
  const output: Output = { out: [], err: [] };
  const process = await newInstance(output);
  for (const path of filesBelow(host.FS, home)) writeFile(process.FS, path, host.FS.readFile(path));
  const before = new Map(filesBelow(process.FS, home).map((path) => [path, process.FS.stat(path).mtime.getTime()]));
  process.FS.mkdirTree(folder);
  process.FS.chdir(folder);
  const code = process.callMain(words);
  for (const path of filesBelow(process.FS, home))
    if (before.get(path) !== process.FS.stat(path).mtime.getTime()) writeFile(host.FS, path, process.FS.readFile(path));
  storeChanges();
  return { code, out: textOf(output.out), err: textOf(output.err) };
}

async function answer(asked: Ask): Promise<unknown> {
  switch (asked.ask) {
    case "open":
      return open(asked.path);
    case "gallery":
      return hostIn(home, null, () => host._ipos_open_gallery());
    case "verb":
      return verb(asked.folder, asked.words);
    case "files":
      return Object.fromEntries(filesBelow(host.FS, asked.folder).map((path) => [path, host.FS.readFile(path)]));
    case "write":
      for (const [path, bytes] of Object.entries(asked.files)) {
        if (bytes) writeFile(host.FS, path, bytes);
        else host.FS.unlink(path);
      }
      return storeChanges();
  }
}

self.onmessage = async ({ data }) => {
  switch (data.kind) {
    case "start":
      try {
        wasm = await WebAssembly.compile(data.wasm);
        host = await newInstance(output);
        host.FS.mkdirTree(home);
        for (const [path, bytes] of Object.entries(data.files)) {
          writeFile(host.FS, path, bytes);
          stored.set(path, stamp(path));
        }
        tell({ kind: "started" });
      } catch (problem) {
        tell({ kind: "broken", text: String(problem) });
      }
      return;
    case "host":
      if (!has_host) return;
      guarded(() => give(text_to_host, data.text));
      return turnSoon();
    case "drained":
      if (has_host) guarded(() => give(drained, String(data.bytes)));
      return;
    case "ask":
      try {
        tell({ kind: "answer", id: data.id, value: await answer(data) });
      } catch (problem) {
        tell({ kind: "refused", id: data.id, text: problem instanceof Error ? problem.message : String(problem) });
      }
  }
};
