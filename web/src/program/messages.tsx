// What the compiler and the readers have against the texts: those in the editor while they are typed, those of the last
// build until something is typed again. A click leads to the place.
import { build, edited, plantFiles, type BuildMessage } from "./documents";
import { diagnostics } from "./language";

function nameOf(uri: string): string | undefined {
  return plantFiles.value.find((file) => file.uri === uri)?.name;
}

function typed(): BuildMessage[] {
  return Object.entries(diagnostics.value ?? {}).flatMap(([uri, all]) =>
    all.map((one) => ({
      severity: one.severity === 1 ? "error" : one.severity === 2 ? "warning" : "note",
      file: nameOf(uri) ?? decodeURIComponent(uri.slice(uri.lastIndexOf("/") + 1)),
      line: one.range.start.line + 1,
      column: one.range.start.character + 1,
      text: one.message,
    })),
  );
}

export function messages(): BuildMessage[] {
  const all = typed();
  if (!edited.value)
    for (const one of build.value.messages)
      if (!all.some((other) => other.file === one.file && other.line === one.line && other.severity === one.severity)) all.push(one);
  return all.sort((a, b) => Number(b.severity === "error") - Number(a.severity === "error"));
}

export function Messages({ go }: { go: (message: BuildMessage) => void }) {
  const all = messages();
  if (all.length === 0) return null;
  return (
    <div class="panel messages" tabIndex={0} role="region" aria-label="Messages of the texts">
      <table aria-label="Messages">
        <thead>
          <tr>
            <th>File</th>
            <th>Line</th>
            <th>Column</th>
            <th>Text</th>
          </tr>
        </thead>
        <tbody>
          {all.map((one, position) => (
            <tr key={position} class={one.severity} onClick={() => go(one)}>
              <td>{one.file.slice(one.file.lastIndexOf("/") + 1)}</td>
              <td>{one.line || ""}</td>
              <td>{one.column || ""}</td>
              <td>
                <button class="link" disabled={!one.line} onClick={() => go(one)}>
                  {one.severity}: {one.text}
                </button>
              </td>
            </tr>
          ))}
        </tbody>
      </table>
    </div>
  );
}
