// Places and texts for the renderers.
#include "compiler/diag/places.hpp"

#include <fmt/format.h>

namespace ipos::compiler {
namespace {

// Length of the UTF-8 character at the start of the text, 0 when there is none.
size_t utf8_length(std::string_view text) {
  const auto byte = [&text](size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U; };
  const auto follows = [&byte](size_t i) { return (byte(i) & 0xC0U) == 0x80U; };
  const unsigned first = byte(0);
  if (first < 0x80) return 1;
  if (first >= 0xC2 && first <= 0xDF) return follows(1) ? 2 : 0;
  if (first >= 0xE0 && first <= 0xEF) {
    const bool overlong = first == 0xE0 && byte(1) < 0xA0;
    const bool surrogate = first == 0xED && byte(1) >= 0xA0;
    return follows(1) && follows(2) && !overlong && !surrogate ? 3 : 0;
  }
  if (first >= 0xF0 && first <= 0xF4) {
    const bool overlong = first == 0xF0 && byte(1) < 0x90;
    const bool beyond = first == 0xF4 && byte(1) >= 0x90;
    return follows(1) && follows(2) && follows(3) && !overlong && !beyond ? 4 : 0;
  }
  return 0;
}

bool is_control(std::string_view character) {
  const auto first = static_cast<unsigned char>(character[0]);
  const bool high = character.size() == 2 && first == 0xC2 && static_cast<unsigned char>(character[1]) < 0xA0;
  return (first < 0x20 && first != '\t') || first == 0x7F || high;
}

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
    const size_t length = utf8_length(text);
    const std::string_view character = text.substr(0, length == 0 ? 1 : length);
    if (length == 0) {
      const auto byte = static_cast<unsigned char>(text[0]);
      if (byte < 0xA0) {
        out += '?';
      } else {
        out += static_cast<char>(0xC0U | byte >> 6U);
        out += static_cast<char>(0x80U | (byte & 0x3FU));
      }
    } else if (is_control(character)) {
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
    const size_t length = utf8_length(text);
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
