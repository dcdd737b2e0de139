// The page's end of the worker: a carrier of the host's messages, and what is asked of the worker beside them.
import { signal } from "@preact/signals";

import type { Carrier, Ends } from "../server/carrier";
import { webAssembly, workerScript } from "./packed";
import { storedFiles, storeFiles, type Files } from "./stored";
import type { Asked, Ended, FromWorker, ToWorker } from "./worker_messages";

// The plant or session that is open, by its path in the worker's file system; null: none yet, or the gallery.
export const openPlant = signal<string | null>(null);

interface Waiting {
  done: (value: unknown) => void;
  failed: (reason: Error) => void;
}

let worker: Worker | undefined;
let has_host = false;
let next_id = 1;
let storing: Promise<boolean> = Promise.resolve(true);
const waiting = new Map<number, Waiting>();

function post(message: ToWorker, transfer: Transferable[] = []): void {
  worker?.postMessage(message, transfer);
}

// Resolved when the worker has the files of the storage: what is asked before waits until then.
let isThere: () => void;
const there = new Promise<void>((done) => (isThere = done));

async function ask(what: Asked): Promise<unknown> {
  await there;
  const id = next_id++;
  return new Promise((done, failed) => {
    waiting.set(id, { done, failed });
    post({ kind: "ask", id, ...what });
  });
}

export const openFile = (path: string) => ask({ ask: "open", path }) as Promise<string>;
export const openGallery = () => ask({ ask: "gallery" }) as Promise<void>;
export const runVerb = (folder: string, words: string[]) => ask({ ask: "verb", folder, words }) as Promise<Ended>;
export const filesBelow = (folder: string) => ask({ ask: "files", folder }) as Promise<Files>;
export const writeFiles = (files: Record<string, Uint8Array<ArrayBuffer> | null>) =>
  ask({ ask: "write", files }) as Promise<void>;

// The browser itself stores one after the other; each begins at once, as the page may be left any time.
async function both(before: Promise<boolean>, now: Promise<boolean>): Promise<boolean> {
  await before;
  return now;
}

// What the worker has told of so far is stored. False: this browser keeps nothing.
export const areStored = () => storing;

// `started` says what to open, once the files of the storage are there.
export function inWorker(started: () => Promise<void>, broken: (text: string) => void): (ends: Ends) => Carrier {
  return (ends) => {
    const settle = (id: number, settle_it: (one: Waiting) => void) => {
      const one = waiting.get(id);
      waiting.delete(id);
      if (one) settle_it(one);
    };
    const taken = (bytes: number) => post({ kind: "drained", bytes });
    const take = (message: FromWorker) => {
      switch (message.kind) {
        case "started":
          isThere();
          return void started().catch((problem: unknown) => broken(String(problem)));
        case "opened":
          openPlant.value = message.path;
          if (has_host) ends.lost();
          has_host = true;
          return ends.opened();
        case "text":
          ends.text(message.text);
          return message.drains === 0 ? undefined : taken(message.drains);
        case "frame":
          ends.frame(new DataView(message.frame));
          return taken(message.frame.byteLength);
        case "answer":
          return settle(message.id, (one) => one.done(message.value));
        case "refused":
          return settle(message.id, (one) => one.failed(new Error(message.text)));
        case "changed":
          storing = both(storing, storeFiles(message.files));
          return;
        case "broken":
          has_host = false;
          ends.lost();
          return broken(message.text);
      }
    };
    void (async () => {
      try {
        const [script, wasm, files] = await Promise.all([workerScript(), webAssembly(), storedFiles()]);
        worker = new Worker(URL.createObjectURL(script));
        worker.onmessage = ({ data }: MessageEvent<FromWorker>) => take(data);
        worker.onerror = (event) => broken(event.message);
        post({ kind: "start", wasm, files }, [wasm]);
      } catch (problem) {
        broken(String(problem));
      }
    })();
    return { isOpen: () => has_host, send: (text) => post({ kind: "host", text }) };
  };
}
