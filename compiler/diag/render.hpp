// Diagnostics for people and for programs. All forms name the chain of macros and includes after a place.
// Bytes that are not UTF-8 are shown as Latin-1, so every output is valid UTF-8.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "compiler/diag/diag.hpp"

namespace ipos::compiler {

// `file:line:col: error: text [E0123]`, the source line, a caret with its range, then the notes.
std::string render_text(std::span<const Diagnostic> diagnostics, const SourceMap& map, bool color);

// An error of another kind of file in the same form: `place` is "plant.toml:3:1:", `begin` counts bytes of `line` from 0.
// Without a line it is not quoted.
std::string render_mistake(std::string_view place, std::string_view text, uint32_t number,
                           std::string_view line, size_t begin, bool color);

// One JSON object a line.
std::string render_json(std::span<const Diagnostic> diagnostics, const SourceMap& map);

// One SARIF 2.1.0 log. Columns count characters there, not bytes.
std::string render_sarif(std::span<const Diagnostic> diagnostics, const SourceMap& map);

}  // namespace ipos::compiler
