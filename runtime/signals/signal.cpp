// How a signal is shown, parsed and written.
#include "runtime/signals/signal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>

#include "runtime/plant_file/signal.hpp"
#include "stdlib/parameters.hpp"

namespace ipos::signals {

using namespace runtime;

namespace {

constexpr size_t kVariableBits = 32;

struct GroupWords {
  std::string_view many;
  std::string_view one;  // for messages
};
constexpr GroupWords kGroups[] = {{"drive", "a value of the drive"},
                                  {"states", "a state"},
                                  {"inputs", "an input"},
                                  {"outputs", "an output"},
                                  {"analog inputs", "an analog input"},
                                  {"process data", "a process word"},
                                  {"tasks", "a task"},
                                  {"variables", "a variable"},
                                  {"system variables", "a variable"},
                                  {"parameters", "a parameter"},
                                  {"bus", "a value of a bus"}};

// Decimal or 0x...; of 32 bits the highest hexadecimal digit may be the sign.
std::optional<int64_t> number_of(std::string_view text) {
  const bool negative = text.starts_with('-');
  if (negative) text.remove_prefix(1);
  const bool hex = text.starts_with("0x") || text.starts_with("0X");
  if (hex) text.remove_prefix(2);
  uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, hex ? 16 : 10);
  if (error != std::errc() || end != text.data() + text.size() || text.empty() || value > INT64_MAX) return std::nullopt;
  if (hex && !negative && value > INT32_MAX && value <= UINT32_MAX) return static_cast<int32_t>(value);
  return negative ? -static_cast<int64_t>(value) : static_cast<int64_t>(value);
}

// "2.5 Nm"
std::optional<double> amount_of(std::string_view text, std::string_view unit) {
  if (unit.empty() || !text.ends_with(unit)) return std::nullopt;
  text.remove_suffix(unit.size());
  while (text.ends_with(' ')) text.remove_suffix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

}  // namespace

std::string_view group_text(Group group) { return kGroups[static_cast<size_t>(group)].many; }

std::string Signal::text(int64_t sample) const {
  std::string text;
  append_text(text, sample);
  return text;
}

// A power of ten only sets the point: the digits are those of the sample, without the way over a double.
void Signal::append_text(std::string& out, int64_t sample) const {
  constexpr double kPowers[] = {1, 10, 100, 1000, 10'000, 100'000, 1'000'000};
  constexpr int64_t kExact = int64_t{1} << 40;
  const auto places = static_cast<size_t>(decimals);
  const bool digits = places < std::size(kPowers) && std::abs(factor * kPowers[places] - 1) < 1e-15 &&
                      sample > -kExact && sample < kExact;
  if (!digits) {
    out += fmt::format("{:.{}f}", static_cast<double>(sample) * factor, decimals);
    return;
  }
  std::array<char, 24> text;
  char* begin = text.data() + text.size();
  uint64_t rest = static_cast<uint64_t>(sample < 0 ? -sample : sample);
  for (size_t n = 0; n < places; ++n, rest /= 10) *--begin = static_cast<char>('0' + rest % 10);
  if (places != 0) *--begin = '.';
  do {
    *--begin = static_cast<char>('0' + rest % 10);
    rest /= 10;
  } while (rest != 0);
  if (sample < 0) *--begin = '-';
  out.append(begin, text.data() + text.size());
}

std::string Signal::words(int64_t sample) const {
  if (parameter != nullptr) return stdlib::parameter_text(*parameter, static_cast<int32_t>(sample));
  return text(sample) + (unit.empty() ? "" : " " + unit);
}

int64_t Signal::rounded(int digits) const {
  const int64_t sample = read();
  double scale = factor;
  for (; digits > 0; --digits) scale *= 10;
  return scale == 1 ? sample : std::llround(static_cast<double>(sample) * scale);
}

std::string_view Signal::own_name() const {
  return std::string_view(name).substr(station.empty() ? 0 : station.size() + 1);
}

Refusal Signal::check(int64_t sample) const {
  if (sample >= limits.least && sample <= limits.most) return std::nullopt;
  return fmt::format("{} is out of range for {}: {}..{}", sample, kGroups[static_cast<size_t>(group)].one, limits.least,
                     limits.most);
}

Refusal Signal::write(int64_t sample) const {
  if (put == nullptr || owner == nullptr) return fmt::format("{} can only be read", own_name());
  if (auto wrong = check(sample)) return wrong;
  return put(*owner, number, static_cast<int32_t>(sample));
}

tl::expected<Signal::Parsed, std::string> Signal::parse(std::string_view text) const {
  if (parameter != nullptr) {
    const auto value = stdlib::parse_parameter_text(*parameter, text);
    if (!value) return tl::unexpected(fmt::format("P{} {}: {}", parameter->number, parameter->name, value.error()));
    return Parsed{number, parameter->number_of(*value)};
  }
  if (group == Group::Analog) {
    const std::string_view terminal = analog_kinds()[number - kBinaryLines].name;
    if (const auto setting = parse_analog(terminal, text)) return Parsed{setting->line, setting->value};
    return tl::unexpected(fmt::format(
        "'{}' is nothing for {}; write a text such as \"5 V\" (-10..10), \"12 mA\" (0..20), for frequency "
        "\"5 kHz\" (0..65), for potentiometer \"50 %\" (0..100)",
        text, terminal));
  }
  if (group == Group::Input && (text == "on" || text == "off")) return Parsed{number, text == "on" ? 1 : 0};
  if (const auto value = number_of(text)) return Parsed{number, *value};
  if (const auto value = group == Group::Drive ? amount_of(text, unit) : std::nullopt)
    return Parsed{number, std::llround(std::clamp(*value / factor, -1e15, 1e15))};
  return tl::unexpected(fmt::format("'{}' is no number", text));
}

bool Signal::shares_terminal(const Signal& other) const {
  return put == other.put && owner == other.owner &&
         (number == other.number || (is_input() && same_terminal(number, other.number)));
}

size_t bit_count(const Signal& signal) {
  return signal.is_variable() ? kVariableBits : signal.bits > 1 ? signal.bits : 0;
}

Signal bit_of(const Signal& whole, size_t bit) {
  Signal signal = whole;
  signal.name += fmt::format(".{}", bit);
  signal.meaning = fmt::format("bit {} of {}", bit, whole.name);
  signal.bits = 1;
  signal.is_status = false;
  signal.decided = nullptr;
  signal.put = nullptr;
  signal.parameter = nullptr;
  signal.read = [read = whole.read, bit]() -> int64_t { return read() >> bit & 1; };
  return signal;
}

}  // namespace ipos::signals
