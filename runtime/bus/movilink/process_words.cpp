// Names from the parameter lists, scales from the table.
#include "runtime/bus/movilink/process_words.hpp"

#include <fmt/format.h>

#include <cstdlib>

#include "stdlib/parameters.hpp"

namespace ipos::runtime {
namespace {

constexpr ProcessWordScale kScales[] = {
#define PROCESS_WORD(input, code, is_signed, numerator, denominator, unit) \
  {input, code, is_signed, numerator, denominator, unit},
#include "runtime/bus/movilink/process_words.def"
};

}  // namespace

ProcessWordScale process_word_scale(bool input, uint8_t code) {
  for (const ProcessWordScale& scale : kScales)
    if (scale.input == input && scale.code == code) return scale;
  return {input, code, true, 1, 1, ""};
}

std::string_view process_word_name(const stdlib::UnitType& unit, bool input, uint8_t code) {
  const char* const number = input ? "873" : "870";
  const stdlib::Parameter* row = stdlib::parameter_table(unit).find(number);
  // The words of a MOVITRAC 31 are fixed; it has no list of them. Nobody has said what the others of such a unit are.
  if (row == nullptr && code == 0) return {};
  if (row == nullptr) row = stdlib::parameter_table(stdlib::usual_unit()).find(number);
  for (const stdlib::ValueText& text : row->texts)
    if (text.value == code) return text.text;
  return {};
}

std::string process_word_text(bool input, uint8_t code, uint16_t word) {
  const ProcessWordScale scale = process_word_scale(input, code);
  if (scale.denominator == 0) return fmt::format("{:04X}h", word);
  const int64_t value = scale.is_signed ? static_cast<int16_t>(word) : word;
  const std::string unit = scale.unit.empty() ? "" : fmt::format(" {}", scale.unit);
  if (scale.denominator == 1) return fmt::format("{}{}", value * scale.numerator, unit);
  // One decimal where that is exact, else two.
  const int64_t tens = scale.denominator <= 10 ? 10 : 100;
  const int64_t scaled = std::llabs(value) * scale.numerator * tens * 2 / scale.denominator;
  const int64_t rounded = (scaled + 1) / 2;
  return fmt::format("{}{}.{:0{}}{}", value < 0 ? "-" : "", rounded / tens, rounded % tens,
                     tens == 10 ? 1 : 2, unit);
}

}  // namespace ipos::runtime
