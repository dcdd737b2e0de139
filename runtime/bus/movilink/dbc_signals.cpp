// Signals from the tables of the telegrams.
#include "runtime/bus/movilink/dbc_signals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>

#include "runtime/bus/movilink/unit_words.hpp"
#include "stdlib/parameters.hpp"
#include "stdlib/services.hpp"

namespace ipos::runtime::dbc {
namespace {

// A text in quotes has none inside.
std::string quotable(std::string_view text) {
  std::string out(text);
  std::replace(out.begin(), out.end(), '"', '\'');
  return out;
}

// The bits of a control or status word, and the high byte of a status word.
void add_bits(std::vector<Signal>& signals, const std::string& word, WordPlace place,
              const stdlib::UnitType& unit, bool input, uint8_t code) {
  for (const WordBit& row : unit_word_bits(unit, input, code)) {
    const uint32_t byte = row.bit < 8 ? place.low : place.high;
    signals.push_back({identifier(fmt::format("{}_{}", word, row.text)), 8 * byte + row.bit % 8, 1});
    if (!row.off.empty()) signals.back().values = {{0, row.off}, {1, row.on}};
  }
  if (!input) return;
  signals.push_back({word + "_state", 8 * place.high + (place.is_intel() ? 0 : 7), 8, place.is_intel()});
  for (const auto& [value, text] : unit_state_texts(code)) signals.back().values.emplace_back(value, text);
}

}  // namespace

std::string identifier(std::string_view text) {
  std::string name;
  for (const char c : text) {
    const bool good = std::isalnum(static_cast<unsigned char>(c)) != 0;
    if (good)
      name += c;
    else if (!name.empty() && name.back() != '_')
      name += '_';
  }
  while (!name.empty() && name.back() == '_') name.pop_back();
  if (name.empty() || std::isdigit(static_cast<unsigned char>(name[0])) != 0) name.insert(0, "_");
  return name.substr(0, kLongestName);
}

// DPointer carries the low-order bytes, DPointer + 1 those beyond the fourth. What is shorter than a variable
// is filled with zeros on reception, so it has no sign.
std::vector<Signal> object_signals(const ObjectNames& object) {
  const uint32_t length = object.format.length;
  const bool intel = object.format.layout == VariableLayout::Intel;
  const uint32_t low_bytes = std::min(length, 4U);
  const uint32_t high_bytes = length - low_bytes;
  std::vector<Signal> signals;
  if (low_bytes > 0)
    signals.push_back({identifier(object.variables[0]), intel ? 0 : 8 * high_bytes + 7, 8 * low_bytes, intel,
                       low_bytes == 4, 1, ""});
  if (high_bytes > 0)
    signals.push_back(
        {identifier(object.variables[1]), intel ? 32U : 7U, 8 * high_bytes, intel, high_bytes == 4, 1, ""});
  if (signals.size() == 2 && signals[0].name == signals[1].name) signals[1].name = "DPointer_1";
  return signals;
}

void add_word(std::vector<Signal>& signals, const std::string& word, WordPlace place,
              const stdlib::UnitType* unit, bool input, uint8_t code) {
  if (unit != nullptr && !unit_word_bits(*unit, input, code).empty())
    return add_bits(signals, word, place, *unit, input, code);
  const ProcessWordScale scale = process_word_scale(input, code);
  const std::string_view name = unit == nullptr ? "" : process_word_name(*unit, input, code);
  const double factor = scale.denominator == 0
                            ? 1
                            : static_cast<double>(scale.numerator) / static_cast<double>(scale.denominator);
  signals.push_back({identifier(fmt::format("{}_{}", word, name)),
                     place.is_intel() ? 8 * place.low : 8 * place.high + 7, 16, place.is_intel(),
                     scale.is_signed && scale.denominator != 0, factor, std::string(scale.unit)});
}

// Of SBus: high byte first.
std::vector<Signal> process_signals(const UnitNames& unit, bool input) {
  std::vector<Signal> signals;
  for (uint32_t n = 0; n < 3; ++n)
    add_word(signals, fmt::format("{}{}", input ? "PI" : "PO", n + 1), {2 * n + 1, 2 * n}, unit.unit, input,
             (input ? unit.input : unit.output)[n]);
  return signals;
}

std::vector<Signal> parameter_signals(const UnitNames& unit) {
  std::vector<Signal> signals{{"Service", 3, 4}, {"Length", 5, 2},    {"Handshake", 6, 1},
                              {"Failed", 7, 1},  {"Subindex", 15, 8}, {"Index", 23, 16}};
  signals.back().multiplexor = true;
  signals[0].values = {
#define SERVICE(name, code, text) {code, text},
#include "stdlib/services.def"
  };
  if (unit.unit == nullptr) return signals;
  std::set<std::string> names;
  for (const stdlib::Parameter* row : stdlib::parameter_table(*unit.unit).by_index()) {
    std::string name = identifier(fmt::format(
        "{}{} {}", row->number.empty() ? "I" : "P",
        row->number.empty() ? fmt::format("{}", row->index) : std::string(row->number), row->name));
    if (!names.insert(name).second) name = fmt::format("I{}", row->index);
    Signal signal{name, 39, 32, false, !row->is_unsigned(), stdlib::display_scale(*row).factor};
    if (row->display != "hex") signal.unit = quotable(row->display);
    for (const stdlib::ValueText& text : row->texts)
      signal.values.emplace_back(text.value, quotable(text.text));
    signal.multiplexed = row->index;
    signals.push_back(std::move(signal));
  }
  return signals;
}

}  // namespace ipos::runtime::dbc
