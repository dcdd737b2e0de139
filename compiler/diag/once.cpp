// Messages are the same where code, text and spelling are: a header that is included twice, a macro that is used again, a loop
// that two analyses walk through.
#include "compiler/diag/once.hpp"

#include <fmt/format.h>

#include <map>
#include <set>
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

using Spot = std::tuple<std::string_view, uint32_t, uint32_t>;

Spot place_of(const Diagnostic& diagnostic, const SourceMap& map) {
  const Position at = map.position(diagnostic.span.begin);
  return {at.file == nullptr ? std::string_view() : std::string_view(at.file->name), at.line, at.column};
}

}  // namespace

std::vector<Repeats> repeats_of(std::span<const Diagnostic> all, const SourceMap& map) {
  std::vector<Repeats> groups;
  std::map<Spelled, size_t> known;
  std::map<size_t, std::set<Spot>> places;  // of those that came again
  for (size_t n = 0; n < all.size(); ++n) {
    const auto [entry, is_new] = known.try_emplace(spelled(all[n], map), groups.size());
    if (is_new) {
      groups.push_back({n});
      continue;
    }
    Repeats& group = groups[entry->second];
    std::set<Spot>& seen = places[entry->second];
    if (group.more++ == 0) seen.insert(place_of(all[group.first], map));
    if (all[n].span.begin.in_macro() && seen.insert(place_of(all[n], map)).second) group.elsewhere.push_back(n);
  }
  return groups;
}

std::vector<Diagnostic> each_once(std::span<const Diagnostic> all, const SourceMap& map) {
  std::vector<Diagnostic> told;
  for (const Repeats& group : repeats_of(all, map)) {
    told.push_back(all[group.first]);
    if (group.more == 0) continue;
    const char* const many = group.more == 1 ? "" : "s";
    if (group.elsewhere.empty()) {
      told.back().notes.push_back({Span{}, fmt::format("the same {} more time{} in this place", group.more, many)});
    } else {
      const Location next = all[group.elsewhere.front()].span.begin;
      told.back().notes.push_back({{next, next}, fmt::format("the same in {} more use{} of the macro, the next one here", group.more, many)});
    }
  }
  return told;
}

}  // namespace ipos::compiler
