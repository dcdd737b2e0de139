// ipos-wasm: plants of IPOSplus-style drives in node and browsers. index.d.ts has the description of each function; the numbers
// and texts that go to and fro are those of bridge.cpp.
import createCore from "./core.js";

const status_ok = 0;
const writable_flag = 1;
const kinds = ["any", "variable", "parameter", "input", "output", "analog", "state", "word", "signal"];
const bus_kinds = ["can", "serial", "profibus"];
const weights = ["why", "warning", "fault"];
const frame_bytes = 32;
const frame_flags = { extended: 1, remote: 2, error: 4, own: 8 };

// The arguments of the functions of bridge.cpp: p a plant, n a number, s a text; and what they give.
const bridge = {
  version: ["", "s"], open: ["snn", "p"], close: ["p", ""], message: ["p", "s"], mistake: ["pn", "s"],
  time: ["p", "n"], run: ["pn", "n"], station: ["pn", "s"], why: ["pn", "s"], drive_fault: ["pnn", "n"], power: ["pnn", "n"],
  find: ["pns", "n"], signal: ["pn", "s"], name_at: ["pnnn", "s"], read: ["pn", "n"], read_text: ["pn", "s"],
  write: ["pnn", "n"], write_text: ["pns", "n"], force: ["pnn", "n"], release: ["pn", "n"],
  bus: ["pn", "s"], receive: ["pn", "n"], frames: ["", "n"], send: ["pn", "n"], journal: ["pn", "s"], hash: ["p", "s"],
  compile: ["ss", "s"], image: ["", "n"], image_size: ["", "n"],
}; // prettier-ignore
const c_types = { p: "number", n: "number", s: "string" };
const utf8 = new TextDecoder();

export class IposError extends Error {
  constructor(message, mistakes = []) {
    super(message);
    this.name = "IposError";
    this.mistakes = mistakes;
  }
}

async function moduleOf(given) {
  const wasm = await given;
  if (wasm instanceof WebAssembly.Module) return wasm;
  if (wasm === undefined || typeof wasm === "string" || wasm instanceof URL) {
    const url = new URL(wasm ?? "./ipos.wasm", import.meta.url);
    if (url.protocol === "file:" && typeof process !== "undefined")
      return WebAssembly.compile(await (await import("node:fs/promises")).readFile(url));
    const answer = await fetch(url);
    if (!answer.ok) throw new IposError(`${url}: ${answer.status} ${answer.statusText}`);
    return WebAssembly.compile(await answer.arrayBuffer());
  }
  return WebAssembly.compile(wasm);
}

// Everything that `next(n)` gives for n = 0, 1, ... up to nothing.
function all(next) {
  const out = [];
  for (let n = 0, one = next(0); one !== null; one = next(++n)) out.push(one);
  return out;
}

export async function load({ wasm } = {}) {
  const compiled = await moduleOf(wasm);
  const core = await createCore({
    instantiateWasm(imports, done) {
      WebAssembly.instantiate(compiled, imports).then((instance) => done(instance, compiled));
      return {};
    },
  });
  const c = {};
  // A text that is not there is a null pointer, and null.
  const textAt = (at) => (at === 0 ? null : utf8.decode(core.HEAPU8.slice(at, core.HEAPU8.indexOf(0, at))));
  for (const [name, [takes, gives]] of Object.entries(bridge)) {
    const call = core.cwrap(`js_${name}`, gives === "" ? null : "number", [...takes].map((one) => c_types[one]));
    c[name] = gives === "s" ? (...given) => textAt(call(...given)) : call;
  }
  return new Ipos(core, c);
}

class Ipos {
  #core;
  #c;
  #folders = 0;

  constructor(core, c) {
    this.#core = core;
    this.#c = c;
    this.version = c.version();
  }

  // Puts the files into a folder of their own, which is gone when `remove` is called.
  #place(files) {
    const { FS } = this.#core;
    const folder = `/plant${++this.#folders}`;
    FS.mkdirTree(folder);
    const folders = new Set([folder]);
    const paths = Object.keys(files).map((name) => {
      const path = `${folder}/${name}`;
      if (name.split("/").includes("..")) throw new IposError(`${name}: a file lies in the folder of its plant`);
      for (let end = path.indexOf("/", 1); end !== -1; end = path.indexOf("/", end + 1)) folders.add(path.slice(0, end));
      FS.mkdirTree(path.slice(0, path.lastIndexOf("/")));
      FS.writeFile(path, files[name]);
      return path;
    });
    const remove = () => {
      for (const path of paths) FS.unlink(path);
      for (const one of [...folders].reverse()) if (FS.readdir(one).length === 2) FS.rmdir(one);
    };
    return { folder, remove };
  }

  compile(files, main, { unit = "" } = {}) {
    const { folder, remove } = this.#place(files);
    this.#core.FS.chdir(folder); // the image names its sources as they are called here
    const told = this.#c.compile(main, unit);
    this.#core.FS.chdir("/");
    remove();
    if (told === null) throw new IposError(`there is no unit ${unit}`);
    const lines = told.split("\n");
    const messages = [];
    for (let at = 0; at + 3 < lines.length; at += 4)
      messages.push({ code: lines[at], line: Number(lines[at + 1]), column: Number(lines[at + 2]), text: lines[at + 3] });
    const size = this.#c.image_size();
    const image = size === 0 ? null : this.#core.HEAPU8.slice(this.#c.image(), this.#c.image() + size);
    return { image, messages };
  }

  open(files, main, { speed = 0, seed = 0 } = {}) {
    const { folder, remove } = this.#place(files);
    const handle = this.#c.open(`${folder}/${main}`, speed, seed);
    const mistakes = all((n) => this.#c.mistake(handle, n)).map((told) => {
      const [file, line, column, ...text] = told.split("\n");
      return { file: file.replace(`${folder}/`, ""), line: Number(line), column: Number(column), text: text.join("\n") };
    });
    if (mistakes.length === 0) return new Plant(this.#core, this.#c, handle, remove);
    this.#c.close(handle);
    remove();
    const { file, line, text } = mistakes[0];
    throw new IposError(`${file}:${line}: ${text}`, mistakes);
  }
}

class Plant {
  #core;
  #c;
  #handle;
  #remove;
  #numbers = new Map();
  #buses;

  constructor(core, c, handle, remove) {
    this.#core = core;
    this.#c = c;
    this.#handle = handle;
    this.#remove = remove;
    this.stations = all((n) => c.station(handle, n)).map((told) => {
      const [name, unit, title, program] = told.split("\n");
      return { name, unit, title, program };
    });
    this.#buses = all((n) => c.bus(handle, n)).map((told) => {
      const [name, kind, baud] = told.split("\n");
      return { name, kind: bus_kinds[kind], baud: Number(baud) };
    });
  }

  get buses() {
    return this.#buses;
  }
  get time() {
    return this.#c.time(this.#handle);
  }

  #check(status) {
    if (status !== status_ok) throw new IposError(this.#c.message(this.#handle));
  }
  #station(name) {
    const number = this.stations.findIndex((one) => one.name === name);
    if (number === -1) throw new IposError(`there is no station ${name}`);
    return number;
  }
  // "hoist.speed", or "speed" where there is one station.
  #signal(name) {
    const known = this.#numbers.get(name);
    if (known !== undefined) return known;
    const point = name.indexOf(".");
    const station = this.stations.findIndex((one) => one.name === name.slice(0, point));
    const number = station !== -1 ? this.#c.find(this.#handle, station, name.slice(point + 1)) : this.stations.length === 1 ? this.#c.find(this.#handle, 0, name) : -1;
    if (number === -1) throw new IposError(this.#c.message(this.#handle) || `there is no signal ${name}`);
    this.#numbers.set(name, number);
    return number;
  }

  run(ms) {
    if (!(ms >= 0)) throw new IposError("time does not go back");
    this.#check(this.#c.run(this.#handle, ms));
  }
  step() {
    this.run(1);
  }

  names(station, kind) {
    const number = this.#station(station);
    return all((n) => this.#c.name_at(this.#handle, number, kinds.indexOf(kind), n));
  }
  signal(name) {
    const [own, unit, factor, decimals, kind, flags] = this.#c.signal(this.#handle, this.#signal(name)).split("\n");
    return { name: own, unit, factor: Number(factor), decimals: Number(decimals), kind: kinds[kind], writable: (flags & writable_flag) !== 0 };
  }
  read(name) {
    return this.#c.read(this.#handle, this.#signal(name));
  }
  text(name) {
    return this.#c.read_text(this.#handle, this.#signal(name));
  }
  write(name, value) {
    const signal = this.#signal(name);
    this.#check(typeof value === "string" ? this.#c.write_text(this.#handle, signal, value) : this.#c.write(this.#handle, signal, Number(value)));
  }
  force(name, value) {
    this.#check(this.#c.force(this.#handle, this.#signal(name), Number(value)));
  }
  release(name) {
    this.#check(this.#c.release(this.#handle, this.#signal(name)));
  }

  why(station) {
    return this.#c.why(this.#handle, this.#station(station));
  }
  power(station, on) {
    this.#check(this.#c.power(this.#handle, this.#station(station), on ? 1 : 0));
  }
  fault(station, number) {
    this.#check(this.#c.drive_fault(this.#handle, this.#station(station), number));
  }

  #bus(name) {
    const number = name === undefined ? 0 : this.#buses.findIndex((one) => one.name === name);
    if (number === -1 || number >= this.#buses.length) throw new IposError(`there is no bus ${name ?? ""}`);
    return number;
  }
  frames(bus) {
    const out = [];
    for (const number = this.#bus(bus); ; ) {
      const count = this.#c.receive(this.#handle, number);
      if (count === -1) throw new IposError(this.#c.message(this.#handle));
      if (count === 0) return out;
      for (let n = 0; n < count; ++n) out.push(this.#frame(this.#c.frames() + n * frame_bytes));
    }
  }
  #frame(at) {
    const bytes = new DataView(this.#core.HEAPU8.buffer, at, frame_bytes);
    const flags = bytes.getUint32(12, true);
    const frame = { time: bytes.getFloat64(0, true), id: bytes.getUint32(8, true), length: bytes.getUint32(16, true) };
    for (const [name, bit] of Object.entries(frame_flags)) frame[name] = (flags & bit) !== 0;
    frame.data = this.#core.HEAPU8.slice(at + 24, at + 24 + frame.length);
    return frame;
  }
  send({ id, data = [], extended = false, remote = false }, bus) {
    const number = this.#bus(bus);
    const at = this.#c.frames();
    const bytes = new DataView(this.#core.HEAPU8.buffer, at, frame_bytes);
    bytes.setUint32(8, id, true);
    bytes.setUint32(12, (extended ? frame_flags.extended : 0) | (remote ? frame_flags.remote : 0), true);
    bytes.setUint32(16, data.length, true);
    this.#core.HEAPU8.set(data.slice(0, 8), at + 24);
    this.#check(this.#c.send(this.#handle, number));
  }

  get journal() {
    return all((n) => this.#c.journal(this.#handle, n)).map((told) => {
      const [time, weight, station, ...text] = told.split("\n");
      return { time: Number(time), weight: weights[weight], station, text: text.join("\n") };
    });
  }
  hash() {
    return this.#c.hash(this.#handle);
  }
  close() {
    if (this.#handle === 0) return;
    this.#c.close(this.#handle);
    this.#handle = 0;
    this.#remove();
  }
}
