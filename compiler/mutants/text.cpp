// Texts of nodes.
#include "compiler/mutants/text.hpp"

namespace ipos::compiler::mutants {
namespace {

constexpr size_t kLongest = 60;  // ours

}  // namespace

std::optional<MacroUse> Texts::macro_of(Span span) const {
  if (!span.begin.in_macro() || !span.end.in_macro()) return std::nullopt;
  Location begin = span.begin;
  while (sources_.expansion(begin).use.in_macro()) begin = sources_.expansion(begin).use;
  const std::string_view name = sources_.expansion(begin).macro;
  const Location use = sources_.use(span.begin);
  if (sources_.use(span.end).value - use.value != name.size()) return std::nullopt;  // from one macro to another
  const SourceFile* file = sources_.file_of(sources_.spelling(span.begin));
  return MacroUse{name, use, file == nullptr || file->path.empty()};
}

std::string Texts::written(Span span) const {
  const bool in_one = macro_of(span).has_value();
  std::string text = in_one ? text_between(sources_.spelling(span.begin), sources_.spelling(span.end)) : "";
  return text.empty() ? used(span) : text;
}

bool Texts::is_own(Location at) const {
  const SourceFile* file = sources_.file_of(at);
  return file != nullptr && !file->path.empty();
}

std::string Texts::text_between(Location begin, Location end) const {
  const SourceFile* file = sources_.file_of(begin);
  if (file == nullptr || end.value <= begin.value || end.value > file->base + file->text.size()) return {};
  std::string text;
  for (const char c : std::string_view(file->text).substr(begin.value - file->base, end.value - begin.value)) {
    const bool blank = c == ' ' || c == '\t' || c == '\r' || c == '\n';
    if (!blank)
      text += c;
    else if (!text.empty() && text.back() != ' ')
      text += ' ';
  }
  return text.size() > kLongest ? text.substr(0, kLongest) + "..." : text;
}

}  // namespace ipos::compiler::mutants
