// Values of the variables that the open text names, for the lines that read them.
import type { EditorView } from "@codemirror/view";

import { request, subscribe } from "../server/connection";
import { namesIn, setValues } from "./marks";
import { files, openFile, station } from "./program_state";

const most = 200; // of one text
const marked_ms = 700; // a value that has changed

const groups = ["variables", "system variables"];

// Until what it returns is called. The names are looked for in the text as it was when it began.
export function followValues(view: EditorView): () => void {
  const of = station.peek();
  let stop: (() => void) | undefined;
  let over = false;
  const texts = new Map<string, string>();
  const changed = new Map<string, number>();
  const show = () => view.dispatch({ effects: setValues.of({ texts: new Map(texts), changed: new Set(changed.keys()) }) });
  const begin = async () => {
    const text = view.state.doc.toString();
    if (!of || !files.peek().some((file) => file.name === openFile.peek())) return;
    const known = new Set<string>();
    for (const group of groups) {
      const reply = await request({ do: "search", station: of, group, limit: 1000 });
      for (const { name } of reply.names as { name: string }[]) known.add(name.slice(of.length + 1));
    }
    const names = [...new Set(namesIn(text))].filter((name) => known.has(name)).slice(0, most);
    if (over || names.length === 0) return;
    stop = subscribe("values", { station: of, names, rate: 5 }, (event) => {
      const now = performance.now();
      for (const [name, value] of Object.entries(event.values as Record<string, string>)) {
        if (texts.has(name) && texts.get(name) !== value) changed.set(name, now);
        texts.set(name, value);
      }
      for (const [name, at] of changed) if (now - at > marked_ms) changed.delete(name);
      show();
    });
  };
  void begin().catch(() => undefined);
  return () => {
    over = true;
    stop?.();
  };
}
