// Colours of sources and of plant files. The words of IPOS come from the language server (language.ts), so there is no
// list of them here.
import { StreamLanguage, type StreamParser, type StringStream } from "@codemirror/language";

import type { Words } from "./language";

interface Comment {
  inside: boolean;
}

function endOfComment(stream: StringStream, state: Comment): string {
  state.inside = !stream.skipTo("*/");
  if (state.inside) stream.skipToEnd();
  else stream.match("*/");
  return "comment";
}

// `words` is asked at each token: they come later than the first text.
export function iposMode(words: () => Words): StreamLanguage<Comment> {
  const parser: StreamParser<Comment> = {
    name: "ipos",
    startState: () => ({ inside: false }),
    token(stream, state) {
      if (state.inside) return endOfComment(stream, state);
      if (stream.eatSpace()) return null;
      if (stream.match("//")) {
        stream.skipToEnd();
        return "comment";
      }
      if (stream.match("/*")) return endOfComment(stream, state);
      if (stream.match(/^#\s*\w+/)) return "meta";
      if (stream.match(/^"(?:[^"\\]|\\.)*"?/) || (/^\s*#\s*include\b/.test(stream.string) && stream.match(/^<[^>]*>?/))) return "string";
      if (stream.match(/^(?:0[xX][\da-fA-F]+|0[bB][01]+|\d+)/)) return "number";
      const word = stream.match(/^[A-Za-z_]\w*/) as RegExpMatchArray | null;
      if (!word) {
        stream.next();
        return null;
      }
      const known = words().get(word[0]);
      return known ?? (/^H\d+$/.test(word[0]) ? "variableName.standard" : "variableName");
    },
    languageData: { commentTokens: { line: "//", block: { open: "/*", close: "*/" } }, closeBrackets: { brackets: ["(", "[", "{", '"'] } },
  };
  return StreamLanguage.define(parser);
}

interface Value {
  value: boolean; // behind the =
}

export const tomlMode = StreamLanguage.define<Value>({
  name: "toml",
  startState: () => ({ value: false }),
  token(stream, state) {
    if (stream.sol()) state.value = false;
    if (stream.eatSpace()) return null;
    if (stream.match(/^#.*/)) return "comment";
    if (!state.value && stream.sol() && stream.match(/^\[\[?[^\]]*\]?\]?/)) return "heading";
    if (stream.match(/^"(?:[^"\\]|\\.)*"?/) || stream.match(/^'[^']*'?/)) return state.value ? "string" : "propertyName";
    if (stream.match("=")) {
      state.value = true;
      return "operator";
    }
    if (stream.match(/^[{,]/)) {
      state.value = false;
      return null;
    }
    if (state.value && stream.match(/^(?:true|false)\b/)) return "atom";
    if (state.value && stream.match(/^[+-]?(?:0x[\da-fA-F_]+|[\d_]+(?:\.[\d_]+)?(?:[eE][+-]?\d+)?)/)) return "number";
    if (stream.match(/^[\w.-]+/)) return state.value ? null : "propertyName";
    stream.next();
    return null;
  },
  languageData: { commentTokens: { line: "#" } },
});
