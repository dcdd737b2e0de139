// Hover: names by the index; numbers, and the parameters and faults that comments speak of, by their text.
#include <fmt/format.h>

#include <charconv>

#include "compiler/preprocess/number.hpp"
#include "stdlib/faults.hpp"
#include "stdlib/parameters.hpp"
#include "tools/lsp/features.hpp"

namespace ipos::tools::lsp {
namespace {

std::string describe_number(std::string_view word) {
  const compiler::ParsedNumber parsed = compiler::parse_number(word, false);
  if (parsed.form != compiler::NumberForm::Good) return {};
  return fmt::format("{} = 0x{:X} = 0b{:b}\n", static_cast<int32_t>(parsed.value), parsed.value,
                     parsed.value);
}

// P130 and F10, in comments as well.
std::string describe_code(const Program& program, std::string_view word) {
  if (word.size() < 2 || word.find_first_not_of("0123456789", 1) != std::string_view::npos) return {};
  if (word[0] == 'P') {
    const stdlib::Parameter* row = stdlib::parameter_table(*program.compiled.unit).find(word);
    if (row == nullptr) return {};
    compiler::IndexedSymbol symbol;
    symbol.kind = compiler::SymbolKind::Parameter;
    symbol.number = row->index;
    if (row->index != 0) return describe(program, symbol, row->index);
    return fmt::format("**P{} {}**, at the keypad only\n", row->number, row->name);
  }
  uint8_t number = 0;
  if (word[0] != 'F' || std::from_chars(word.data() + 1, word.data() + word.size(), number).ec != std::errc{})
    return {};
  const stdlib::FaultRow* row = stdlib::find_fault(number);
  return row == nullptr ? std::string()
                        : fmt::format("**F{:02} {}**: {}\n", row->number, row->name,
                                      stdlib::meaning_on(*program.compiled.unit, *row));
}

}  // namespace

Json hover(Workspace& workspace, const Json& params) {
  const Cursor cursor = cursor_of(workspace, params);
  if (cursor.file == nullptr) return nullptr;
  std::string text;
  compiler::Place place = word_at(cursor);
  if (cursor.symbol != nullptr) {
    place = cursor.occurrence->place;
    text = describe(cursor.program, *cursor.symbol, cursor.occurrence->number);
  } else if (place.end > place.begin) {
    const std::string_view word =
        std::string_view(cursor.file->text).substr(place.begin, place.end - place.begin);
    text = word[0] >= '0' && word[0] <= '9' ? describe_number(word) : describe_code(cursor.program, word);
  }
  if (text.empty()) return nullptr;
  return {{"contents", {{"kind", "markdown"}, {"value", text}}},
          {"range", range_of(cursor.file->text, place.begin, place.end, workspace.encoding)}};
}

}  // namespace ipos::tools::lsp
