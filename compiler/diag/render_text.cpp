// Diagnostics as text for the terminal.
#include <fmt/format.h>

#include <algorithm>

#include "compiler/diag/places.hpp"
#include "compiler/diag/render.hpp"

namespace ipos::compiler {
namespace {

constexpr size_t kWidth = 160;  // of a quoted line (ours); longer ones are cut around the place

struct Colors {
  std::string_view place, error, warning, note, caret, off;
};
constexpr Colors kPlain{};
constexpr Colors kAnsi{"\x1b[1m", "\x1b[1;31m", "\x1b[1;35m", "\x1b[1;36m", "\x1b[1;32m", "\x1b[0m"};

// The line and below it a caret under the first character and ~ under the others; `begin` and `end` count its bytes.
std::string quote(uint32_t number, std::string_view line, size_t begin, size_t end, const Colors& colors) {
  if (begin > kWidth / 2 && line.size() > kWidth) {
    const size_t cut = begin - kWidth / 2;
    line.remove_prefix(cut);
    begin -= cut;
    end -= cut;
  }
  line = line.substr(0, kWidth);
  end = std::min(end, line.size());

  std::string below;
  for (char c : printable(line.substr(0, begin)))
    if ((static_cast<unsigned char>(c) & 0xC0U) != 0x80U) below += c == '\t' ? '\t' : ' ';
  below += colors.caret;
  below += '^';
  if (end > begin) below.append(characters(line.substr(begin, end - begin)) - 1, '~');
  below += colors.off;
  return fmt::format("{:5} | {}\n      | {}\n", number, printable(line), below);
}

class TextRenderer {
 public:
  TextRenderer(const SourceMap& map, bool color) : map_(map), colors_(color ? kAnsi : kPlain) {}

  void diagnostic(const Diagnostic& diagnostic) {
    const DiagInfo& row = info(diagnostic.diag);
    const std::string flag = row.flag.empty() ? "" : fmt::format(", -W{}", row.flag);
    message(diagnostic.span, diagnostic.severity, diagnostic.text, fmt::format(" [{}{}]", row.code, flag));
    for (const Note& note : all_notes(diagnostic, map_)) message(note.span, Severity::Note, note.text, "");
  }

  std::string take() { return std::move(out_); }

 private:
  void message(Span span, Severity severity, std::string_view text, std::string_view code) {
    const Range range = range_of(span, map_);
    if (range.begin.file != nullptr)
      out_ += fmt::format("{}{}:{}:{}:{} ", colors_.place, printable(range.begin.file->name),
                          range.begin.line, range.begin.column, colors_.off);
    const std::string_view color = severity == Severity::Error     ? colors_.error
                                   : severity == Severity::Warning ? colors_.warning
                                                                   : colors_.note;
    out_ += fmt::format("{}{}:{} {}{}\n", color, severity_word(severity), colors_.off, printable(text), code);
    if (range.begin.file != nullptr) quote_range(range);
  }

  void quote_range(const Range& range) {
    const std::string_view line = SourceMap::line_text(*range.begin.file, range.begin.line);
    const size_t end = range.end.line == range.begin.line
                           ? std::min<size_t>(range.end.column - 1, line.size())
                           : line.size();
    out_ +=
        quote(range.begin.line, line, std::min<size_t>(range.begin.column - 1, line.size()), end, colors_);
  }

  const SourceMap& map_;
  const Colors& colors_;
  std::string out_;
};

}  // namespace

std::string render_text(std::span<const Diagnostic> diagnostics, const SourceMap& map, bool color) {
  TextRenderer renderer(map, color);
  for (const Diagnostic& diagnostic : diagnostics) renderer.diagnostic(diagnostic);
  return renderer.take();
}

std::string render_mistake(std::string_view place, std::string_view text, uint32_t number,
                           std::string_view line, size_t begin, bool color) {
  const Colors& colors = color ? kAnsi : kPlain;
  const std::string head = fmt::format("{}{}{} {}error:{} {}\n", colors.place, printable(place), colors.off,
                                       colors.error, colors.off, printable(text));
  return line.empty() ? head : head + quote(number, line, begin, begin + 1, colors);
}

}  // namespace ipos::compiler
