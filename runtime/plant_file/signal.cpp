// Names of terminals and texts of analog signals.
#include "runtime/plant_file/signal.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace ipos::runtime {
namespace {

// "frequency" alone is the output frequency of the drive.
constexpr AnalogKind kAnalogKinds[] = {
    {"AI1", "AI1", "V", 1e3, -10, 10, AnalogLine::Ai1Voltage},
    {"AI1", "AI1_current", "mA", 1e3, 0, 20, AnalogLine::Ai1Current},
    {"AI2", "AI2", "V", 1e3, -10, 10, AnalogLine::Ai2Voltage},
    {"AI2", "AI2_current", "mA", 1e3, 0, 20, AnalogLine::Ai2Current},
    {"frequency", "frequency_input", "kHz", 1e3, 0, 65, AnalogLine::Frequency},
    {"potentiometer", "potentiometer", "%", 10, 0, 100, AnalogLine::Potentiometer},
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

// "03" with tens 0 or 1 and ones 0..7: bit 8 x tens + ones, or -1.
int terminal_bit(std::string_view digits) {
  if (digits.size() != 2 || (digits[0] != '0' && digits[0] != '1')) return -1;
  return digits[1] < '0' || digits[1] > '7' ? -1 : (digits[0] - '0') * 8 + (digits[1] - '0');
}

}  // namespace

std::span<const AnalogKind> analog_kinds() { return kAnalogKinds; }

int parse_input(std::string_view name) { return name.starts_with("DI") ? terminal_bit(name.substr(2)) : -1; }

int parse_output(std::string_view name) {
  if (name == "DB00") return 0;
  constexpr int kLastUnitOutput = 5;
  const int bit = name.starts_with("DO") ? terminal_bit(name.substr(2)) : -1;
  return bit == 0 || (bit > kLastUnitOutput && bit < 8) ? -1 : bit;
}

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
