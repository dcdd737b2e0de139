// Places and texts for the renderers.
#include "compiler/diag/places.hpp"

#include <fmt/format.h>

#include "stdlib/plain_text.hpp"

namespace ipos::compiler {
namespace {

constexpr size_t kMaxChain = 8;  // notes of one chain (ours)

void append_macros(std::vector<Note>& notes, Location at, const SourceMap& map) {
  size_t count = 0;
  for (; at.in_macro(); at = map.expansion(at).use) {
    if (++count > kMaxChain) continue;
    const SourceMap::Expansion& expansion = map.expansion(at);
    const Position place = map.position(expansion.spelling);
    notes.push_back(
        {{expansion.spelling, expansion.spelling},
         fmt::format("in macro '{}', defined at {}:{}", expansion.macro, place.file->name, place.line)});
  }
  if (count > kMaxChain) notes.push_back({{}, fmt::format("and in {} more macros", count - kMaxChain)});
}

void append_includes(std::vector<Note>& notes, Location at, const SourceMap& map) {
  size_t count = 0;
  for (const SourceFile* file = map.file_of(at); file != nullptr && file->included_at.valid();
       file = map.file_of(file->included_at)) {
    if (++count > kMaxChain) continue;
    const Position place = map.position(file->included_at);
    notes.push_back({{file->included_at, file->included_at},
                     fmt::format("'{}' included from {}:{}", file->name, place.file->name, place.line)});
  }
  if (count > kMaxChain) notes.push_back({{}, fmt::format("and {} more files", count - kMaxChain)});
}

}  // namespace

std::string printable(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const size_t length = stdlib::utf8_length(text);
    const std::string_view character = text.substr(0, length == 0 ? 1 : length);
    if (length == 0) {
      const auto byte = static_cast<unsigned char>(text[0]);
      if (byte < 0xA0) {
        out += '?';
      } else {
        out += static_cast<char>(0xC0U | byte >> 6U);
        out += static_cast<char>(0x80U | (byte & 0x3FU));
      }
    } else if (stdlib::is_control(character) && character != "\t") {
      out += '?';
    } else {
      out += character;
    }
    text.remove_prefix(character.size());
  }
  return out;
}

size_t characters(std::string_view text) {
  size_t count = 0;
  while (!text.empty()) {
    const size_t length = stdlib::utf8_length(text);
    text.remove_prefix(length == 0 ? 1 : length);
    ++count;
  }
  return count;
}

Range range_of(Span span, const SourceMap& map) {
  Range range{map.position(span.begin), map.position(span.end)};
  const bool ordered = range.end.file == range.begin.file &&
                       (range.end.line > range.begin.line ||
                        (range.end.line == range.begin.line && range.end.column >= range.begin.column));
  if (!ordered) range.end = range.begin;
  return range;
}

std::vector<Note> all_notes(const Diagnostic& diagnostic, const SourceMap& map) {
  std::vector<Note> notes = diagnostic.notes;
  append_macros(notes, diagnostic.span.begin, map);
  append_includes(notes, diagnostic.span.begin, map);
  return notes;
}

std::string_view severity_word(Severity severity) {
  switch (severity) {
    case Severity::Note: return "note";
    case Severity::Warning: return "warning";
    case Severity::Error: return "error";
  }
  return "";
}

}  // namespace ipos::compiler
