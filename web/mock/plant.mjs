// The cardboard plant of the mock server: two drives and a control on a line, a sine to look at.

const source = `// Counts and turns.
long lCount, lWrong;

main()
{
  while (1)
  {
    lCount++;
    if (lCount == 300)
      lWrong = 1;
    _Wait(2);
  }
}
`;

const source_file = { name: "SAW.IPC", kind: "program", uri: "file:///SAW.IPC", read_only: "" };
const stationNames = ["saw", "lift"];
const variables = stationNames.flatMap((name) => [`${name}.lCount`, `${name}.lWrong`]);

function describe() {
  return {
    stations: stationNames.map((name) => ({
      name,
      unit: "mdxb",
      title: "MOVIDRIVE B",
      program: "SAW.IPC",
      drive: true,
      inputs: ["/controller inhibit", "CW/STOP", "CCW/STOP", "enable"].map((text, bit) => ({
        name: `DI0${bit}`,
        bit,
        function: text,
      })),
      outputs: [
        { name: "DB00", bit: 0, function: "/brake" },
        { name: "DO01", bit: 1, function: "ready" },
      ],
      analog: [{ name: "AI1", units: ["V"], least: -10, most: 10 }],
      lines: ["sbus"],
    })),
    buses: [
      {
        name: "sbus",
        kind: "can",
        baud: 500000,
        stations: stationNames,
        faults: ["drop", "cut", "corrupt"],
        fault_rules: {
          drop: { text: "loses a frame behind the acknowledge", station: "may", rate: true, identifier: true },
          cut: { text: "is cut", station: "must", rate: false, identifier: false },
          corrupt: { text: "has a disturbed bit", station: "may", rate: true, identifier: true },
        },
      },
    ],
    controls: [{ name: "plc", bus: "sbus" }],
    wires: [{ from: "saw.DO01", to: "lift.DI03", invert: false }],
    switches: [{ input: "saw.DI02", from: -1000, to: 1000, active_high: true }],
    barriers: [],
  };
}

export function newPlant() {
  return {
    us: 0,
    running: false,
    speed: 1,
    generation: 1,
    stations: Object.fromEntries(
      stationNames.map((name) => [name, { in: 0, forced: 0, powered: true, fault: 0, analog: "0.000 V", shaft: 0 }]),
    ),
    faults: [],
    variables: [...variables],
    watched: [],
    written: {},
    forced: {},
    changed: {},
    breakpoints: [],
    settings: {},
    scope: {
      recording: 1,
      channels: stationNames.map((name) => ({ name: `${name}.speed`, unit: "rpm", decimals: 1 })),
      trigger: { kind: "none" },
      pre: 20,
      length_ms: 2000,
      state: "free",
      single: false,
      trigger_us: null,
      trigger_text: "",
    },
  };
}

export function tick(plant, ms) {
  plant.us += ms * 1000;
  for (const station of Object.values(plant.stations))
    if (enabled(station)) station.shaft = (station.shaft + (ms / 60000) * 30) % 1;
}

// The lift is a hoist, the saw no more than a shaft.
const machines = {
  saw: { kind: "shaft", unit: "turns", per_turn: 1, given: false, from: null, to: null, limits: null, reference: null },
  lift: { kind: "hoist", unit: "mm", per_turn: 40, given: true, from: 0, to: 2000, limits: [0, 200000], reference: 0 },
};

const enabled = (station) => station.powered && !station.fault && (station.in & 11) === 11;
const counted = (plant) => Math.floor(plant.us / 10000);

function stationState(plant, name) {
  const station = plant.stations[name];
  const on = enabled(station);
  return {
    in: station.in,
    forced: station.forced,
    out: (on ? 1 : 0) + 2,
    analog: { AI1: station.analog },
    powered: station.powered,
    state: on ? "enable" : "no enable",
    enabled: on,
    why: on ? "" : "DI00 (/controller inhibit) is off",
    display: station.fault ? `F${station.fault}` : on ? "A" : "1",
    status: on ? 0x0407 : 0x0002,
    fault: station.fault,
    fault_text: station.fault ? "Overcurrent" : "",
    error: station.fault > 0,
    speed: on ? 30 : 0,
    position: Math.floor(station.shaft * 4096),
    shaft: station.shaft,
    machine: { shaft: Math.floor(station.shaft * 4096), target: 102400, setpoint: 0, in_position: false, referenced: true },
    torque: 12,
    dc_link: 560,
    pd_out: ["0006", "0BB8", "0000"],
    pd_in: ["0407", "0BB8", "0000"],
  };
}

function watchValue(plant, name) {
  const value = plant.forced[name] ?? plant.written[name] ?? (name.endsWith("lCount") ? counted(plant) : 0);
  const hex = `${(value >>> 0).toString(16).toUpperCase().padStart(8, "0")} h`;
  return { value, text: String(value), hex, forced: name in plant.forced };
}

const nameRow = (name) => ({ name, group: "variables", unit: "", text: "", writable: true });

function parameterRows(plant, station) {
  const text = plant.changed[station] ?? "2.000 s";
  return {
    groups: [
      { number: "P1", name: "Setpoints, integrators" },
      { number: "P13", name: "Speed ramps 1" },
      { number: "P8", name: "Drive functions" },
      { number: "P81", name: "Serial communication" },
    ],
    parameters: [
      {
        number: "P130", index: 8470, name: "Ramp t11 UP CW", group: "P13", unit: "s", access: "N",
        default: "2.000 s", least: "0.000 s", most: "2000.000 s", choices: [], value: 2000, text, changed: text !== "2.000 s",
      },
      {
        number: "P816", index: 8603, name: "SBus baud rate", group: "P81", unit: "", access: "N",
        default: "500 kBaud", least: null, most: null, choices: ["125 kBaud", "250 kBaud", "500 kBaud"], value: 2,
        text: "500 kBaud", changed: false,
      },
      {
        number: "P003", index: 8321, name: "Actual position", group: "P0", unit: "Inc", access: "RO",
        default: null, least: null, most: null, choices: [], value: 0, text: "0 Inc", changed: false,
      },
    ],
  };
}

const sine = (us, channel) => Math.sin(us / 3e5 + channel) * 1500;

function viewFrame(plant, command) {
  const last = Math.min(plant.us, command.to_us);
  const from = Math.max(1000, Math.ceil(command.from_us / 1000) * 1000);
  const ms = Math.max(0, Math.floor((last - from) / 1000) + 1);
  const step = Math.max(1, Math.ceil(ms / command.points));
  const count = Math.ceil(ms / step);
  const channels = plant.scope.channels.length;
  const bytes = command.exact ? 8 : 4;
  const frame = Buffer.alloc(32 + count * channels * bytes);
  frame.writeUInt8(1, 0);
  frame.writeUInt8(channels, 1);
  frame.writeUInt8(1, 2);
  frame.writeUInt8(command.exact ? 1 : 0, 3);
  frame.writeUInt32LE(command.id, 4);
  frame.writeUInt32LE(plant.scope.recording, 8);
  frame.writeUInt32LE(count, 12);
  frame.writeUInt32LE(step * 1000, 16);
  frame.writeBigUInt64LE(BigInt(from), 24);
  for (let n = 0; n < count * channels; ++n) {
    const value = sine(from + Math.floor(n / channels) * step * 1000, n % channels);
    if (command.exact) frame.writeDoubleLE(value, 32 + n * bytes);
    else frame.writeFloatLE(value, 32 + n * bytes);
  }
  return frame;
}

function setInput(plant, { station, name, action, on }) {
  const bit = 1 << Number(name.slice(2));
  const state = plant.stations[station];
  if (action === "release") state.forced &= ~bit;
  else state.in = on ? state.in | bit : state.in & ~bit;
  if (action === "force") state.forced |= bit;
  return { ok: true };
}

const commands = {
  licences: () => ({ ok: true, text: "licences of cardboard" }),
  plant: () => ({ ok: true, plant: describe() }),
  run: (plant) => ((plant.running = true), { ok: true }),
  pause: (plant) => ((plant.running = false), { ok: true }),
  step: (plant, { ms = 1 }) => ((plant.running = false), tick(plant, ms), { ok: true }),
  speed: (plant, { speed }) => ((plant.speed = speed), { ok: true }),
  back: (plant, { ms }) => ((plant.us = Math.max(0, plant.us - ms * 1000)), ++plant.generation, (plant.running = false), { ok: true }),
  go: (plant, { us }) => ((plant.us = us), ++plant.generation, (plant.running = false), { ok: true, us }),
  restart: (plant) => ((plant.us = 0), ++plant.generation, (plant.running = false), { ok: true }),
  input: setInput,
  analog: (plant, { station, value }) => ((plant.stations[station].analog = value), { ok: true }),
  reset: (plant, { station }) => ((plant.stations[station].fault = 0), { ok: true }),
  power: (plant, { station, on }) => ((plant.stations[station].powered = on), { ok: true }),
  fault: (plant, { kind, station, on }) => {
    plant.faults = plant.faults.filter((one) => one.kind !== kind || one.station !== station);
    if (on) plant.faults.push({ kind, station });
    return { ok: true };
  },
  search: (plant, { text = "", station }) => {
    const names = plant.variables.filter((name) => name.includes(text) && (!station || name.startsWith(`${station}.`)));
    return { ok: true, names: names.map(nameRow), total: names.length, groups: ["variables", "parameters"] };
  },
  watch: (plant, { names }) => ((plant.watched = names), { ok: true, names: names.map(nameRow) }),
  set: (plant, { name, value }) => {
    if (Number.isNaN(Number(value))) return { error: `${value} is no number.` };
    plant.written[name] = Number(value);
    return { ok: true, text: value };
  },
  force: (plant, { name, value }) => ((plant.forced[name] = Number(value)), { ok: true }),
  release: (plant, { name }) => (delete plant.forced[name], { ok: true }),
  scope: (plant, command) => {
    for (const key of ["trigger", "pre", "length_ms"]) if (key in command) plant.scope[key] = command[key];
    if (command.channels) {
      plant.scope.channels = command.channels.map((name) => ({ name, unit: name.endsWith("speed") ? "rpm" : "", decimals: 1 }));
      ++plant.scope.recording;
    }
    return { ok: true };
  },
  "scope.arm": (plant, { single }) => (Object.assign(plant.scope, { state: "armed", single }), { ok: true }),
  "scope.trigger": (plant) => (Object.assign(plant.scope, { state: "triggered", trigger_us: plant.us, trigger_text: "by hand" }), { ok: true }),
  "scope.free": (plant) => (Object.assign(plant.scope, { state: "free", trigger_us: null }), { ok: true }),
  "scope.view": viewFrame,
  "scope.csv": (plant) => ({ ok: true, csv: `time_ms,${plant.scope.channels.map((one) => one.name)}\n1,0.0,0.0\n` }),
  parameters: (plant, { station }) => ({ ok: true, ...parameterRows(plant, station) }),
  "parameters.set": (plant, { station, number, value }) => {
    if (number !== "P130") return { error: "read access only", refused: true };
    plant.changed[station] = `${Number(value).toFixed(3)} s`;
    return { ok: true, text: plant.changed[station] };
  },
  "parameters.compare": () => ({ ok: true, rows: [{ number: "P130", index: 8470, name: "Ramp t11 UP CW", text: "2.000 s", with: "1.000 s" }] }),
  "parameters.save": () => ({ ok: true, file: "saw.param", text: "P130 = 2.000 s\n" }),
  "parameters.load": () => ({ ok: true, set: 1, refused: [] }),
  "bus.trace": (plant) => ({
    ok: true,
    frames: Array.from({ length: Math.min(40, counted(plant)) }, (_, n) => ({
      n: n + 1, us: n * 5000, bus: "sbus", id: 524, extended: false, remote: false, error: false, sender: "saw", ours: true, dlc: 6, data: "000613880000",
      text: "PO1-PO3 to 33",
    })),
    last: Math.min(40, counted(plant)),
    reached: null,
  }),
  "bus.telegram": (plant, { n, bus }) => ({
    ok: true, telegram: { n, bus }, from_us: 0, channels: true, answer: null, question: null,
    fields: [{ signal: "sbus.20C.PO1", meaning: "process word", value: 6, bits: 16 }],
  }),
  "bus.save": () => ({ ok: true, file: "trace.log", text: "(946684800.000000) sbus 20C#000613880000\n", telegrams: 1, left_out: [], until: 1, next: null }),
  settings: (plant) => ({ ok: true, settings: plant.settings }),
  "settings.set": (plant, { name, value }) => ((plant.settings[name] = value), { ok: true }),
  program: () => ({ ok: true, files: [{ name: "SAW.IPC", text: source, lines: [6, 8, 9, 10, 11] }], tasks: ["1"] }),
  files: () => ({ ok: true, files: [source_file], build: { good: true, messages: [], waits: false } }),
  "file.read": () => ({ ok: true, ...source_file, text: source, version: "1" }),
  language: (_plant, { method }) => ({ ok: true, result: method === "diagnostics" ? {} : null }),
  "break.set": (plant, { station, file, line }) => {
    const breakpoint = { number: plant.breakpoints.length + 1, station, file, line, hits: 0 };
    plant.breakpoints.push(breakpoint);
    return { ok: true, breakpoint };
  },
  "break.clear": (plant, { number }) => ((plant.breakpoints = plant.breakpoints.filter((one) => one.number !== number)), { ok: true }),
  breaks: (plant) => ({ ok: true, breakpoints: plant.breakpoints }),
};

export function answer(plant, command) {
  return commands[command.do]?.(plant, command) ?? { ok: true };
}

const events = {
  time: (plant) => ({
    us: plant.us, running: plant.running, speed: plant.speed, rate: 1, generation: plant.generation, over: false, stopped: null,
    furthest_us: Math.max(plant.us, 5_000_000),
  }),
  timeline: (plant) => ({
    us: plant.us, furthest_us: Math.max(plant.us, 5_000_000), dropped: null,
    marks: [
      { us: 1_037_000, kind: "click", what: "DI10", station: "saw", text: "" },
      { us: 3_000_000, kind: "fault", what: "F26", station: "lift", text: "F26 external fault" },
      { us: 3_500_000, kind: "journal", what: "not enabled: controller inhibit", station: "lift", text: "not enabled: controller inhibit" },
    ],
  }),
  plant: (plant) => ({
    us: plant.us,
    stations: Object.fromEntries(stationNames.map((name) => [name, stationState(plant, name)])),
    machines,
    buses: { sbus: { load: 12.5, frames: counted(plant) * 2, lost: 0, faults: plant.faults } },
  }),
  watch: (plant) => ({ us: plant.us, values: Object.fromEntries(plant.watched.map((name) => [name, watchValue(plant, name)])) }),
  scope: (plant) => ({ ...plant.scope, first_us: 1000, last_us: plant.us }),
  parameters: (plant, { station }) => ({
    us: plant.us,
    station,
    values: Object.fromEntries(
      parameterRows(plant, station).parameters.map(({ index, value, text, changed }) => [index, { value, text, changed }]),
    ),
  }),
  bus: (plant) => ({
    us: plant.us,
    rows: [
      { bus: "sbus", id: 524, extended: false, remote: false, count: counted(plant), rate: 200, data: "000613880000", changed: [3], text: "PO1-PO3 to 33" },
      { bus: "sbus", id: 523, extended: false, remote: false, count: counted(plant), rate: 200, data: "040713880000", changed: [], text: "PI1-PI3 of 33" },
    ],
    buses: { sbus: { load: 12.5, frames: counted(plant) * 2, errors: 0, state: "" } },
  }),
  files: () => ({ versions: { "SAW.IPC": "1" } }),
  values: (plant, { station, names }) => ({ us: plant.us, station, values: Object.fromEntries(names.map((name) => [name, "5"])) }),
  program: (plant, { station }) => ({
    us: plant.us,
    station,
    tasks: [{ task: 1, state: "ready", file: "SAW.IPC", line: 8 + (counted(plant) % 2), function: "main" }],
    covered: { "SAW.IPC": [6, 8, 9] },
    breakpoints: plant.breakpoints,
  }),
};

export function event(plant, topic, options, first) {
  if (topic === "journal")
    return first
      ? { event: "journal", entries: [
            { n: 1, us: 1000, station: "saw", weight: "why", text: "not enabled: DI00 is off" },
            { n: 2, us: 5000, station: "lift", weight: "fault", text: "F01 overcurrent" },
            { n: 3, us: 6000, station: "saw", weight: "warning", text: "a telegram is late (SAW.IPC:9:3)" },
          ] }
      : null;
  return { event: topic, ...events[topic]?.(plant, options) };
}
