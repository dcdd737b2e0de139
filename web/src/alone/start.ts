// How the page begins without a server: with what a link brings along, else with the plant of the last time, else with a hoist
// that moves. And what a program may ask of the page (window.ipos).
import { request } from "../server/connection";
import { hello } from "../server/live";
import { complain } from "../shell/notice";
import { inWorker, openFile, runVerb, writeFiles, filesBelow } from "./plant_worker";
import { sharedFiles } from "./share";

export const home = "/home"; // folders of plants lie below
const first_example = "hoist";
const last_opened = `${home}/.last`;

declare global {
  interface Window {
    ipos?: { version: string; hash(): Promise<string> };
  }
}

export async function open(path: string): Promise<void> {
  await openFile(path);
  await writeFiles({ [last_opened]: new TextEncoder().encode(path) });
}

function plantIn(paths: string[]): string | undefined {
  const plants = paths.filter((path) => path.endsWith(".toml") && !path.endsWith(".test.toml")).sort();
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

async function runWhenThere(): Promise<void> {
  await request({ do: "run" });
}

async function started(): Promise<void> {
  const shared = await sharedFiles();
  if (shared) {
    await writeFiles(
      Object.fromEntries(Object.entries(shared.files).map(([name, bytes]) => [`${home}/${shared.name}/${name}`, bytes])),
    );
    await open(`${home}/${shared.name}/${shared.plant}`);
    return runWhenThere();
  }
  const known = await filesBelow(home);
  const last = known[last_opened];
  const path = last && new TextDecoder().decode(last);
  if (path !== undefined && path in known) {
    try {
      return await openFile(path);
    } catch (reason) {
      complain(reason); // the file has mistakes by now: the hoist is there, and the folder can be opened again
    }
  }
  await openExample(first_example);
  await runWhenThere();
}

export const inBrowser = inWorker(started, (text) => complain(`ipos cannot go on in this page: ${text}`));

export function offerToPrograms(): void {
  hello.subscribe((host) => {
    if (!host) return;
    window.ipos = {
      version: host.version,
      hash: async () => (await request({ do: "hash" })).hash as string,
    };
  });
}
