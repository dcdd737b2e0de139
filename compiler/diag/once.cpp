// Messages are the same where code, text and spelling are: a header that is included twice, a macro that is used again, a loop
// that two analyses walk through.
#include "compiler/diag/once.hpp"

#include <fmt/format.h>

#include <map>
#include <tuple>

namespace ipos::compiler {
namespace {

// Of what is spelled in a macro, the place in its definition; of what is spelled in a file, that place.
using Spelled = std::tuple<Diag, std::string_view, std::string_view, uint32_t, uint32_t>;

Spelled spelled(const Diagnostic& diagnostic, const SourceMap& map) {
  const Location at = diagnostic.span.begin;
  const Position place = map.position(at.in_macro() ? map.expansion(at).spelling : at);
  return {diagnostic.diag, diagnostic.text, place.file == nullptr ? std::string_view() : std::string_view(place.file->name), place.line,
          place.column};
}

struct Repeats {
  size_t first = 0;    // in what is told
  size_t more = 0;
  Span second{};       // where it is used again in another place; none: everywhere in the same one
};

bool is_elsewhere(Span span, Span other, const SourceMap& map) {
  const Position a = map.position(span.begin), b = map.position(other.begin);
  return a.file != b.file || a.line != b.line || a.column != b.column;
}

}  // namespace

std::vector<Diagnostic> each_once(std::span<const Diagnostic> all, const SourceMap& map) {
  std::vector<Diagnostic> told;
  std::map<Spelled, Repeats> known;
  for (const Diagnostic& one : all) {
    const auto [entry, is_new] = known.try_emplace(spelled(one, map), Repeats{told.size(), 0, {}});
    if (is_new) {
      told.push_back(one);
      continue;
    }
    Repeats& repeats = entry->second;
    ++repeats.more;
    const bool in_macro = one.span.begin.in_macro();
    if (in_macro && !repeats.second.begin.valid() && is_elsewhere(one.span, told[repeats.first].span, map)) repeats.second = one.span;
  }
  for (const auto& [place, repeats] : known)
    if (repeats.more != 0)
      told[repeats.first].notes.push_back(
          {repeats.second.begin.valid() ? Span{repeats.second.begin, repeats.second.begin} : Span{},
           repeats.second.begin.valid()
               ? fmt::format("the same in {} more use{} of the macro, the next one here", repeats.more, repeats.more == 1 ? "" : "s")
               : fmt::format("the same {} more time{} in this place", repeats.more, repeats.more == 1 ? "" : "s")});
  return told;
}

}  // namespace ipos::compiler
