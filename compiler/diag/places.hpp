// What the renderers share: places in words, the chain of notes, and text that is safe to print.
#pragma once

#include <string>
#include <vector>

#include "compiler/diag/diag.hpp"

namespace ipos::compiler {

// Valid UTF-8 without control characters; bytes that are no UTF-8 count as Latin-1. Tabs stay.
std::string printable(std::string_view text);

// Characters of printable(text).
size_t characters(std::string_view text);

struct Range {
  Position begin;
  Position end;  // after the last byte; in the same file, not before begin
};
Range range_of(Span span, const SourceMap& map);

// The notes of a diagnostic, then the macros its place is in (innermost first), then the includes of its
// file.
std::vector<Note> all_notes(const Diagnostic& diagnostic, const SourceMap& map);

std::string_view severity_word(Severity severity);

}  // namespace ipos::compiler
