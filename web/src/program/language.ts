// What the language server says of the texts in the editor, asked through the host with the texts that are not saved.
import { signal } from "@preact/signals";

import { request } from "../server/connection";

export interface Position {
  line: number; // from 0
  character: number;
}

export interface Proposal {
  label: string;
  kind: number;
  detail?: string;
  documentation?: { value: string };
  sortText?: string; // begins with 0 where it fits the argument
}

export interface Diagnostic {
  range: { start: Position; end: Position };
  severity: number;
  message: string;
  code?: string;
}

export interface TextEdit {
  range: { start: Position; end: Position };
  newText: string;
}

// By word what it is, as the modes call it.
export type Words = ReadonlyMap<string, string>;
export const words = signal<Words>(new Map());
// By URI; null: nobody has been asked, or there is no language server.
export const diagnostics = signal<Readonly<Record<string, Diagnostic[]>> | null>(null);

// CompletionItemKind of the protocol.
const faces: Record<number, string> = { 3: "variableName.function", 14: "keyword", 21: "atom", 22: "typeName" };
export const kinds: Record<number, string> = { 3: "function", 5: "property", 6: "variable", 12: "constant", 14: "keyword", 17: "text", 21: "constant", 22: "type" };

type Texts = Record<string, string>;

async function ask(method: string, params: unknown, texts: Texts): Promise<unknown> {
  return (await request({ do: "language", method, params, texts })).result ?? null;
}

function at(uri: string, position: Position) {
  return { textDocument: { uri }, position };
}

export async function proposals(uri: string, position: Position, texts: Texts): Promise<Proposal[]> {
  const result = (await ask("textDocument/completion", at(uri, position), texts)) as Proposal[] | { items: Proposal[] } | null;
  return Array.isArray(result) ? result : (result?.items ?? []);
}

export async function hover(uri: string, position: Position, texts: Texts): Promise<string | null> {
  const result = (await ask("textDocument/hover", at(uri, position), texts)) as { contents: { value: string } } | null;
  return result?.contents.value ?? null;
}

// A Refusal says why the text cannot be formatted.
export async function formatted(uri: string, texts: Texts): Promise<TextEdit[]> {
  return ((await ask("textDocument/formatting", { textDocument: { uri }, options: {} }, texts)) ?? []) as TextEdit[];
}

export async function check(texts: Texts): Promise<void> {
  diagnostics.value = (await ask("diagnostics", {}, texts)) as Record<string, Diagnostic[]> | null;
}

// What may stand at the beginning of a program, by which its words get their colours.
export async function learnWords(uri: string, texts: Texts): Promise<void> {
  const found = new Map<string, string>();
  for (const one of await proposals(uri, { line: 0, character: 0 }, texts)) {
    const face = faces[one.kind];
    if (face && !found.has(one.label)) found.set(one.label, face);
  }
  words.value = found;
}
