// How the page begins without a server: with what a link brings along, else with the plant of the last time, else with a hoist
// that moves. And what a program may ask of the page (window.ipos).
import { request } from "../server/connection";
import { hello } from "../server/live";
import { open as showView } from "../shell/desk";
import { complain } from "../shell/notice";
import { areStored, filesBelow, inWorker, openFile, runVerb, writeFiles } from "./plant_worker";
import { programOfMessage } from "./message_program";
import { namedInAddress, onLink, sharedFiles, type Named } from "./share";
import type { Files } from "./stored";

export const home = "/home"; // folders of plants lie below
const first_example = "hoist";
const last_opened = `${home}/.last`;

declare global {
  interface Window {
    ipos?: { version: string; hash(): Promise<string> };
  }
}

// What the compiler has to say stands below the text.
async function showMessages(): Promise<void> {
  showView("Program");
  await request({ do: "build" });
}

// One with mistakes stands in the editor with them.
async function openHere(path: string): Promise<void> {
  const mistakes = await openFile(path);
  if (mistakes === "") return;
  await showMessages();
  complain(`${path.slice(home.length + 1)} has mistakes; mend them, save, and restart: ${mistakes.split("\n")[0]}`);
}

// Into a page that has shown nothing yet; else the page begins anew, as its texts and settings are those of the plant before.
export async function open(path: string): Promise<void> {
  await writeFiles({ [last_opened]: new TextEncoder().encode(path) });
  if (hello.peek() && (await areStored())) return location.reload();
  await openHere(path);
}

function isPlant(path: string): boolean {
  return /(?<!\.test|\.campaign)\.toml$/.test(path);
}

export function canBeOpened(path: string): boolean {
  return isPlant(path) || path.endsWith(".ipos");
}

function plantIn(paths: string[]): string | undefined {
  const plants = paths.filter(isPlant).sort();
  return plants.find((path) => path.split("/").length === 4) ?? plants[0];
}

// Opens the plant of a folder below home.
export async function openFolder(name: string): Promise<void> {
  const folder = `${home}/${name}`;
  const plant = plantIn(Object.keys(await filesBelow(folder)));
  if (plant === undefined) throw new Error(`${name} has no plant file (*.toml)`);
  await open(plant);
}

// A copy of an example in a folder of its own, made where it is not there yet.
export async function openExample(name: string): Promise<void> {
  const known = Object.keys(await filesBelow(home));
  if (!known.some((path) => path.startsWith(`${home}/${name}/`))) {
    const made = await runVerb(home, ["new", name, "--from", name]);
    if (made.code !== 0) throw new Error(made.err);
  }
  await openFolder(name);
}

function sameBytes(one: Uint8Array, other: Uint8Array | undefined): boolean {
  return one.length === other?.length && one.every((byte, at) => byte === other[at]);
}

// Puts files that have come from elsewhere into a folder of that name, or name-2 and so on: what a person has changed stays.
// The name of the folder.
export async function placeFiles(name: string, files: Files): Promise<string> {
  const known = await filesBelow(home);
  for (let number = 1; ; ++number) {
    const folder = number === 1 ? name : `${name}-${number}`;
    const before = `${home}/${folder}/`;
    const is_new = !Object.keys(known).some((path) => path.startsWith(before));
    if (!is_new && !Object.entries(files).every(([path, bytes]) => sameBytes(bytes, known[before + path]))) continue;
    if (is_new) await writeFiles(Object.fromEntries(Object.entries(files).map(([path, bytes]) => [before + path, bytes])));
    return folder;
  }
}

async function runWhenThere(): Promise<void> {
  await request({ do: "run" });
}

async function openNamed({ kind, name }: Named): Promise<void> {
  if (kind === "example") {
    await openExample(name);
    return runWhenThere();
  }
  const [code = "", version = "wrong"] = name.split(".");
  const { out, err } = await runVerb(home, ["explain", code]);
  const program = programOfMessage(out, version);
  if (program === undefined) throw new Error(err || `the page of ${code} has no program for here`);
  const file = `${code}.IPC`;
  await open(`${home}/${await placeFiles(name, { [file]: new TextEncoder().encode(program) })}/${file}`);
  await showMessages();
}

// What the address brings along. False: nothing.
async function openShared(): Promise<boolean> {
  const named = namedInAddress();
  if (named) {
    await openNamed(named);
    return true;
  }
  const shared = await sharedFiles();
  if (!shared) return false;
  await open(`${home}/${await placeFiles(shared.name, shared.files)}/${shared.plant}`);
  await runWhenThere();
  return true;
}

async function started(): Promise<void> {
  onLink(() => location.reload());
  try {
    if (await openShared()) return;
  } catch (reason) {
    complain(reason); // the link is cut or damaged
  }
  const known = await filesBelow(home);
  const last = known[last_opened];
  const path = last && new TextDecoder().decode(last);
  if (path !== undefined && path in known) {
    try {
      return await openHere(path);
    } catch (reason) {
      complain(reason); // a session that its plant does not come to any more
    }
  }
  await openExample(first_example);
  await runWhenThere();
}

export const inBrowser = inWorker(started, (text) => complain(`ipos cannot go on; load the page again: ${text}`));

export function offerToPrograms(): void {
  hello.subscribe((host) => {
    if (!host) return;
    window.ipos = {
      version: host.version,
      hash: async () => (await request({ do: "hash" })).hash as string,
    };
  });
}
