// What the page and its worker say to each other.
import type { Files } from "./stored";

export interface Start {
  kind: "start";
  wasm: ArrayBuffer;
  files: Files; // of the storage
}
// A client's message for the host.
export interface ToHost {
  kind: "host";
  text: string;
}
// So many bytes of what the host has sent were taken.
export interface Drained {
  kind: "drained";
  bytes: number;
}
// Each is answered once.
export type Asked =
  | { ask: "open"; path: string } // plant, program or session; the host begins anew. Answer: its mistakes, or ""
  | { ask: "gallery" } // the host of the gallery takes its place
  | { ask: "verb"; folder: string; words: string[] } // as on a command line
  | { ask: "files"; folder: string } // those below
  | { ask: "write"; files: Record<string, Uint8Array<ArrayBuffer> | null> }; // null: it goes
export type Ask = Asked & { kind: "ask"; id: number };
export type ToWorker = Start | ToHost | Drained | Ask;

// Of a verb.
export interface Ended {
  code: number;
  out: string;
  err: string;
}

export type FromWorker =
  | { kind: "started" }
  | { kind: "opened"; path: string | null } // a host is there; null: that of the gallery
  | { kind: "text"; text: string; drains: number } // bytes that the host counts as on their way
  | { kind: "frame"; frame: ArrayBuffer }
  | { kind: "answer"; id: number; value: unknown }
  | { kind: "refused"; id: number; text: string }
  | { kind: "changed"; files: Record<string, Uint8Array<ArrayBuffer> | null> } // to be stored
  | { kind: "broken"; text: string }; // the program has ended
