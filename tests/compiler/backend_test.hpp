// What the tests of the back end share: compiling a text, its commands as text, and its messages.
#pragma once

#include <string>
#include <vector>

#include "compiler/asm/disassembler.hpp"
#include "compiler/compile.hpp"
#include "compiler/diag/render.hpp"

namespace ipos::compiler::test {

inline Compilation compile_text(const std::string& text, const char* unit = nullptr) {
  CompileOptions options;
  if (unit != nullptr) options.unit = stdlib::find_unit(std::string_view(unit));
  return compile("test.IPC", "", text, options);
}

// The commands of a program as the disassembler writes them, labels included, each with single blanks.
inline std::vector<std::string> commands(const Compilation& compilation) {
  if (!compilation.image) return {render_text(compilation.diagnostics.all(), *compilation.sources, false)};
  vm::Image bare = *compilation.image;
  bare.lines.clear();
  const std::string text = disassemble(bare);
  std::vector<std::string> out;
  for (size_t at = 0; at < text.size();) {
    const size_t end = text.find('\n', at);
    std::string line;
    for (const char c : text.substr(at, end - at))
      if (c != ' ' || (!line.empty() && line.back() != ' ')) line += c;
    if (line[0] != '.') out.push_back(line);
    at = end + 1;
  }
  return out;
}

// `a b c` are H420.. of a main with these statements.
inline std::vector<std::string> main_commands(const std::string& statements) {
  return commands(compile_text("long a, b, c, d;\nlong v[4];\nlong p;\nmain() {\n" + statements + "\n}\n"));
}

// The codes of all messages.
inline std::vector<std::string> codes(const std::string& source, const char* unit = nullptr) {
  std::vector<std::string> out;
  const Compilation c = compile_text(source, unit);
  for (const Diagnostic& one : c.diagnostics.all()) out.emplace_back(info(one.diag).code);
  return out;
}

// The same as "LINE CODE TEXT", for programs with a case in each line.
inline std::vector<std::string> told_by_line(const std::string& source, const char* unit = nullptr) {
  std::vector<std::string> out;
  const Compilation c = compile_text(source, unit);
  for (const Diagnostic& one : c.diagnostics.all())
    out.push_back(std::to_string(c.sources->position(one.span.begin).line) + " " +
                  std::string(info(one.diag).code) + " " + one.text);
  return out;
}

}  // namespace ipos::compiler::test
