// The text of one file in CodeMirror, with what the language server says of it.
import { autocompletion, closeBrackets, closeBracketsKeymap, completionKeymap, type CompletionContext, type CompletionResult } from "@codemirror/autocomplete";
import { defaultKeymap, history, historyKeymap } from "@codemirror/commands";
import { bracketMatching, indentOnInput, indentUnit, syntaxHighlighting } from "@codemirror/language";
import { linter, lintKeymap, type Diagnostic as Mark } from "@codemirror/lint";
import { highlightSelectionMatches, searchKeymap } from "@codemirror/search";
import { Compartment, EditorState, type Extension, type Text } from "@codemirror/state";
import { drawSelection, EditorView, highlightActiveLine, hoverTooltip, keymap, lineNumbers } from "@codemirror/view";
import { classHighlighter } from "@lezer/highlight";
import { useEffect, useRef } from "preact/hooks";

import { documents, keepState, unsavedTexts, type Document } from "./documents";
import { check, diagnostics, formatted, hover, kinds, proposals, words, type Position } from "./language";
import { iposMode, tomlMode } from "./language_modes";
import { complain } from "../shell/notice";
import { markExtensions, namesIn, valueOf } from "./marks";

const typed_ms = 120; // after the last key the text is checked

export interface Orders {
  save: () => void;
  format: (view: EditorView) => void;
  toggle: (view: EditorView, line: number) => void;
}

// What the extensions of all documents call: those of the view that is open.
let orders: Orders = { save: () => undefined, format: () => undefined, toggle: () => undefined };

function place(doc: Text, offset: number): Position {
  const line = doc.lineAt(offset);
  return { line: line.number - 1, character: offset - line.from };
}

function offset(doc: Text, at: Position): number {
  const line = doc.line(Math.max(1, Math.min(doc.lines, at.line + 1)));
  return Math.min(line.to, line.from + at.character);
}

function textsWith(uri: string, state: EditorState): Record<string, string> {
  return { ...unsavedTexts(), [uri]: state.doc.toString() };
}

function completionOf(uri: string) {
  return async (context: CompletionContext): Promise<CompletionResult | null> => {
    const word = context.matchBefore(/\w*/);
    const begins = context.matchBefore(/[.#<"[=]\s*$/);
    if (!context.explicit && !begins && (!word || word.from === word.to)) return null;
    const items = await proposals(uri, place(context.state.doc, context.pos), textsWith(uri, context.state)).catch(() => []);
    return {
      from: word?.from ?? context.pos,
      options: items.map((item) => ({
        label: item.label,
        type: kinds[item.kind] ?? "text",
        boost: item.sortText?.startsWith("0") ? 50 : 0,
        ...(item.detail ? { detail: item.detail } : {}),
        ...(item.documentation ? { info: prose(item.documentation.value) } : {}),
      })),
      validFor: /^\w*$/,
    };
  };
}

// Markdown of the server without its marks.
function prose(text: string): string {
  return text.replace(/^```.*\n?/gm, "").replace(/\*\*|`/g, "").trim();
}

function hoverOf(uri: string): Extension {
  return hoverTooltip(async (view, at) => {
    const line = view.state.doc.lineAt(at);
    const name = namesIn(line.text).find((one) => {
      const from = line.text.indexOf(one);
      return at - line.from >= from && at - line.from <= from + one.length;
    });
    const value = name === undefined ? undefined : valueOf(view.state, name);
    const text = await hover(uri, place(view.state.doc, at), textsWith(uri, view.state)).catch(() => null);
    if (!text && value === undefined) return null;
    return {
      pos: at,
      above: true,
      create() {
        const dom = document.createElement("div");
        dom.className = "about";
        dom.textContent = [value === undefined ? "" : `${name} = ${value}`, prose(text ?? "")].filter(Boolean).join("\n\n");
        return { dom };
      },
    };
  });
}

function linterOf(uri: string): Extension {
  return linter(
    async (view): Promise<Mark[]> => {
      await check(textsWith(uri, view.state)).catch(() => undefined);
      const { doc } = view.state;
      return (diagnostics.peek()?.[uri] ?? []).map((one) => {
        const from = offset(doc, one.range.start);
        return {
          from,
          to: Math.max(offset(doc, one.range.end), from),
          severity: one.severity === 1 ? ("error" as const) : one.severity === 2 ? ("warning" as const) : ("info" as const),
          message: one.message,
        };
      });
    },
    { delay: typed_ms },
  );
}

// As one change that can be undone. What was typed meanwhile stays, and nothing is formatted then.
export async function format(view: EditorView, uri: string): Promise<void> {
  const before = view.state.doc;
  try {
    const edits = await formatted(uri, textsWith(uri, view.state));
    if (view.state.doc !== before) return;
    view.dispatch({
      changes: edits.map(({ range, newText }) => ({
        from: offset(before, range.start),
        to: offset(before, range.end),
        insert: newText.replaceAll("\r\n", "\n"),
      })),
    });
  } catch (reason) {
    complain(reason);
  }
}

// A program and its headers have a formatter.
export function canFormat({ uri, read_only, kind }: Document): boolean {
  return uri !== "" && read_only === "" && (kind === "program" || kind === "include");
}

const locked = new Compartment();

export function extensionsOf(name: string, uri: string, read_only: string): Extension {
  const toml = name.endsWith(".toml");
  return [
    markExtensions((view, line) => orders.toggle(view, line)),
    lineNumbers(),
    history(),
    drawSelection(),
    highlightActiveLine(),
    highlightSelectionMatches(),
    bracketMatching(),
    closeBrackets(),
    indentOnInput(),
    indentUnit.of("    "),
    toml ? tomlMode : iposMode(() => words.peek()),
    syntaxHighlighting(classHighlighter),
    uri ? [autocompletion({ override: [completionOf(uri)], activateOnTypingDelay: 50 }), linterOf(uri), hoverOf(uri)] : [],
    keymap.of([
      { key: "Mod-s", preventDefault: true, run: () => (orders.save(), true) },
      {
        key: "Shift-Alt-f",
        run: (view) => {
          orders.format(view);
          return true;
        },
      },
      {
        key: "F9",
        run: (view) => {
          orders.toggle(view, view.state.doc.lineAt(view.state.selection.main.head).number);
          return true;
        },
      },
      ...closeBracketsKeymap,
      ...completionKeymap,
      ...lintKeymap,
      ...searchKeymap,
      ...historyKeymap,
      ...defaultKeymap,
    ]),
    locked.of([EditorState.readOnly.of(read_only !== "")]),
    EditorView.contentAttributes.of({ "aria-label": "Source", tabindex: "0", spellcheck: "false", ...(read_only ? { "aria-readonly": "true" } : {}) }),
  ];
}

interface Shown {
  document: Document;
  orders: Orders;
  take: (view: EditorView | null) => void;
}

export function Editor({ document: shown, orders: own, take }: Shown) {
  const place_of_it = useRef<HTMLDivElement>(null);
  const view = useRef<EditorView | null>(null);
  orders = own;
  useEffect(() => {
    const made = new EditorView({
      state: shown.state,
      parent: place_of_it.current as HTMLElement,
      dispatchTransactions: (transactions, of) => {
        // Another text was put in its place, which the view does not show yet.
        const kept = documents.peek().get(shown.name)?.state;
        if (kept && kept !== of.state) return of.setState(kept);
        of.update(transactions);
        keepState(shown.name, of.state);
      },
    });
    // The buttons of breakpoints stand there.
    made.dom.querySelector(".cm-gutters")?.removeAttribute("aria-hidden");
    view.current = made;
    take(made);
    return () => {
      take(null);
      view.current = null;
      made.destroy();
    };
  }, [shown.name]);
  // The text was taken from the file.
  useEffect(() => {
    const now = view.current;
    const state = documents.peek().get(shown.name)?.state;
    if (now && state && now.state !== state) now.setState(state);
  }, [shown.state]);
  return <div class="editor" ref={place_of_it} />;
}
