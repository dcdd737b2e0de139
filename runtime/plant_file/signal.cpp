// Names of terminals and texts of analog signals.
#include "runtime/plant_file/signal.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace ipos::runtime {
namespace {

constexpr BinaryTerminal kInputs[] = {
#define BINARY_INPUT(name, bit, parameter) {name, bit, parameter},
#include "runtime/plant_file/terminals.def"
};

constexpr BinaryTerminal kOutputs[] = {
#define BINARY_OUTPUT(name, bit, parameter) {name, bit, parameter},
#include "runtime/plant_file/terminals.def"
};

constexpr AnalogKind kAnalogKinds[] = {
#define ANALOG_INPUT(name, signal, unit, factor, least, most, line, units) \
  {name, signal, unit, factor, least, most, AnalogLine::line, AnalogKind::Units::units},
#include "runtime/plant_file/terminals.def"
};

std::optional<int32_t> parse_amount(std::string_view text, const AnalogKind& kind) {
  if (!text.ends_with(kind.unit)) return std::nullopt;
  text.remove_suffix(kind.unit.size());
  while (text.ends_with(' ')) text.remove_suffix(1);
  double value = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (status != std::errc() || end != text.data() + text.size() ||
      !(value >= kind.minimum && value <= kind.maximum))
    return std::nullopt;
  return static_cast<int32_t>(std::lround(value * kind.factor));
}

int bit_of(std::span<const BinaryTerminal> all, std::string_view name) {
  const auto found = std::find_if(all.begin(), all.end(), [name](const BinaryTerminal& row) { return row.name == name; });
  return found == all.end() ? -1 : found->bit;
}

}  // namespace

std::string decimal_text(int64_t value, int decimals) {
  std::string digits = std::to_string(value < 0 ? -value : value);
  if (decimals > 0) {
    const auto least = static_cast<size_t>(decimals) + 1;
    if (digits.size() < least) digits.insert(0, least - digits.size(), '0');
    digits.insert(digits.size() - least + 1, 1, '.');
  }
  return (value < 0 ? "-" : "") + digits;
}

std::span<const AnalogKind> analog_kinds() { return kAnalogKinds; }

bool AnalogKind::is_of(const stdlib::UnitType& of) const {
  if (units == Units::All) return true;
  return of.has(units == Units::Movitrac07 ? stdlib::Trait::BuiltInPotentiometer : stdlib::Trait::SecondAnalogInput);
}

std::span<const BinaryTerminal> binary_inputs() { return kInputs; }
std::span<const BinaryTerminal> binary_outputs() { return kOutputs; }

std::string_view input_name(size_t line) {
  return line < kBinaryLines ? kInputs[line].name : kAnalogKinds[line - kBinaryLines].name;
}

int parse_input(std::string_view name) { return bit_of(kInputs, name); }
int parse_output(std::string_view name) { return bit_of(kOutputs, name); }

int parse_analog_input(std::string_view name) {
  for (const AnalogKind& kind : kAnalogKinds)
    if (kind.name == name) return static_cast<int>(line_of(kind));
  return -1;
}

bool same_terminal(size_t line, size_t other) {
  if (line < kBinaryLines || other < kBinaryLines) return line == other;
  return kAnalogKinds[line - kBinaryLines].name == kAnalogKinds[other - kBinaryLines].name;
}

std::optional<AnalogSetting> parse_analog(std::string_view name, std::string_view text) {
  for (const AnalogKind& kind : kAnalogKinds) {
    if (kind.name != name) continue;
    if (const auto value = parse_amount(text, kind)) return AnalogSetting{line_of(kind), *value};
  }
  return std::nullopt;
}

}  // namespace ipos::runtime
