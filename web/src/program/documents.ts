// The texts in the editor, of the plant's files and of those that the programs were compiled from. What is edited stays
// here while another file or view is open.
import { EditorState, type Extension } from "@codemirror/state";
import { signal } from "@preact/signals";

import { listen, request, subscribe } from "../server/connection";
import { plant } from "../server/live";
import { complain, command } from "../shell/notice";
import { learnWords } from "./language";

export interface PlantFile {
  name: string;
  kind: "plant" | "program" | "include" | "test" | "session";
  uri: string;
  read_only: string;
}

export interface BuildMessage {
  severity: string;
  file: string;
  line: number;
  column: number;
  text: string;
}

export interface BuildState {
  good: boolean;
  messages: BuildMessage[];
  waits: boolean; // for Restart or Load
}

export interface Document extends PlantFile {
  saved: string; // as the file was when it was read or written here
  version: string; // of that text
  crlf: boolean;
  state: EditorState;
}

export const plantFiles = signal<PlantFile[]>([]);
// They are known, and the words of the language.
export const ready = signal(false);
export const build = signal<BuildState>({ good: true, messages: [], waits: false });
// What was edited since the last build.
export const edited = signal(false);
// Versions of the files as they are now.
export const versions = signal<Readonly<Record<string, string>>>({});
export const documents = signal<ReadonlyMap<string, Document>>(new Map());

function put(document: Document): void {
  documents.value = new Map(documents.peek()).set(document.name, document);
}

export function isUnsaved(document: Document): boolean {
  return document.state.doc.toString() !== plain(document.saved);
}

// CodeMirror has lines without their ends.
function plain(text: string): string {
  return text.replaceAll("\r\n", "\n");
}

function whole(document: Document): string {
  const text = document.state.doc.toString();
  return document.crlf ? text.replaceAll("\n", "\r\n") : text;
}

// Somebody else has changed the file since it was read or written here.
export function hasChanged(document: Document): boolean {
  const now = versions.value[document.name];
  return now !== undefined && now !== document.version;
}

export function keepState(name: string, state: EditorState): void {
  const document = documents.peek().get(name);
  if (!document || document.state === state) return;
  if (document.state.doc !== state.doc) edited.value = true;
  put({ ...document, state });
}

// Texts of the editor that are not those of the files, by URI.
export function unsavedTexts(): Record<string, string> {
  const texts: Record<string, string> = {};
  for (const document of documents.peek().values())
    if (document.uri && isUnsaved(document)) texts[document.uri] = document.state.doc.toString();
  return texts;
}

interface FileReply extends PlantFile {
  text: string;
  version: string;
}

async function fetchFile(name: string): Promise<FileReply> {
  return (await request({ do: "file.read", name })) as unknown as FileReply;
}

// `compiled`: for a text that no file has. `why`: it cannot be written, where the plant does not name it.
export async function openDocument(
  name: string,
  extensions: (uri: string, read_only: string) => Extension,
  compiled: string | null,
  why: string,
): Promise<void> {
  if (documents.peek().has(name)) return;
  let file: FileReply;
  try {
    file = await fetchFile(name);
  } catch {
    if (compiled === null) return;
    file = { name, kind: "program", uri: "", read_only: why, text: compiled, version: "" };
  }
  if (documents.peek().has(name)) return;
  const read_only = plantFiles.peek().some((one) => one.name === name) ? file.read_only : why;
  put({
    ...file,
    read_only,
    saved: file.text,
    crlf: file.text.includes("\r\n"),
    state: EditorState.create({ doc: plain(file.text), extensions: extensions(file.uri, read_only) }),
  });
}

// In place of the text in the editor, as one change that can be undone: what was not saved is not lost.
export async function takeChanged(name: string): Promise<void> {
  const document = documents.peek().get(name);
  if (!document) return;
  try {
    const file = await fetchFile(name);
    const text = plain(file.text);
    const state = document.state.update({ changes: { from: 0, to: document.state.doc.length, insert: text } }).state;
    edited.value = true;
    put({ ...document, ...file, saved: file.text, crlf: file.text.includes("\r\n"), state });
    versions.value = { ...versions.peek(), [name]: file.version };
  } catch (reason) {
    complain(reason);
  }
}

async function save(document: Document, over: boolean): Promise<boolean> {
  const text = whole(document);
  const reply = await command({ do: "file.write", name: document.name, text, version: document.version, over });
  if (!reply) return false;
  const now = documents.peek().get(document.name) ?? document;
  put({ ...now, saved: text, version: reply.version as string });
  versions.value = { ...versions.peek(), [document.name]: reply.version as string };
  return true;
}

// All that is not saved; then everything is built. `over`: also over what others have changed meanwhile.
export async function saveAndBuild(over = false): Promise<boolean> {
  for (const document of documents.peek().values())
    if (!document.read_only && isUnsaved(document) && !(await save(document, over))) return false;
  edited.value = false;
  const reply = await command({ do: "build" });
  if (reply) build.value = reply as unknown as BuildState;
  return reply?.good === true;
}

export async function readFiles(): Promise<void> {
  const reply = await request({ do: "files" });
  plantFiles.value = reply.files as PlantFile[];
  build.value = reply.build as BuildState;
}

// By whatever page.
listen("build", (event) => (build.value = event as unknown as BuildState));

// As long as an editor is open.
export function followFiles(): () => void {
  void readFiles()
    .catch(() => (plantFiles.value = []))
    .then(() => {
      const program = plantFiles.peek().find((file) => file.kind === "program");
      return program ? learnWords(program.uri, {}).catch(() => undefined) : undefined;
    })
    .then(() => (ready.value = true));
  const stopFiles = subscribe("files", { rate: 1 }, (event) => {
    const now = event.versions as Record<string, string>;
    if (Object.keys(now).join() !== Object.keys(versions.peek()).join()) void readFiles().catch(complain);
    versions.value = now;
  });
  // A plant that was built anew has other files, and nothing waits any more.
  let seen = plant.peek();
  const stopPlant = plant.subscribe((now) => {
    if (now !== seen) void readFiles().catch(complain);
    seen = now;
  });
  return () => {
    stopFiles();
    stopPlant();
  };
}

window.addEventListener("beforeunload", (event) => {
  if ([...documents.peek().values()].some((document) => !document.read_only && isUnsaved(document))) event.preventDefault();
});
