// Parameter values as people read and write them: units, decimals, names of codes (1053 1610 p. 84-86).
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>

#include "stdlib/index_areas.hpp"
#include "stdlib/parameters.hpp"
#include "stdlib/services.hpp"
#include "stdlib/units.hpp"

namespace ipos::stdlib {
namespace {

constexpr int kMaxDecimals = 9;

// Ways to show a value that are no unit.
constexpr std::string_view kHex = "hex", kFirmware = "firmware", kAscii = "ascii";

std::string with_decimals(int64_t digits, int decimals) {
  const bool negative = digits < 0;
  std::string text = std::to_string(negative ? -digits : digits);
  if (decimals > 0) {
    const size_t wanted = static_cast<size_t>(decimals) + 1;
    if (text.size() < wanted) text.insert(0, wanted - text.size(), '0');
    text.insert(text.size() - static_cast<size_t>(decimals), ".");
  }
  return negative ? "-" + text : text;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

std::optional<int32_t> to_bits(const Parameter& parameter, double number) {
  const double rounded = std::round(number);
  const bool fits = parameter.is_unsigned() ? rounded >= 0 && rounded <= UINT32_MAX
                                            : rounded >= INT32_MIN && rounded <= INT32_MAX;
  // A value between two digits of the transferred number cannot be written.
  if (!fits || std::abs(rounded - number) > 1e-6 * std::max(1.0, std::abs(number))) return std::nullopt;
  return static_cast<int32_t>(static_cast<uint32_t>(static_cast<int64_t>(rounded)));
}

std::string choices(const Parameter& parameter) {
  std::string text;
  for (size_t i = 0; i < parameter.texts.size(); ++i) {
    if (i > 0) text += i + 1 == parameter.texts.size() ? " or " : ", ";
    text += std::to_string(parameter.texts[i].value) + " = " + std::string(parameter.texts[i].text);
  }
  return text;
}

std::string accepted(const Parameter& parameter) {
  if (!parameter.texts.empty()) return "expected " + choices(parameter);
  if (parameter.display == kAscii) return "expected up to four characters, or their code as 0x...";
  const DisplayScale scale = display_scale(parameter);
  std::string text = "expected a number";
  if (scale.decimals > 0) text += " with up to " + std::to_string(scale.decimals) + " decimals";
  if (parameter.display == kFirmware) return text + " such as 822 609 7.11";
  if (!parameter.display.empty()) text += " in " + std::string(parameter.display);
  return text;
}

bool same_word(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](char x, char y) { return lower(x) == lower(y); });
}

// Part number and version: 822609711 is 822 609 7.11. A leading 1 of ten digits marks the check character X
// (1053 1610 p. 69, MOVITRAC 07 chapter 10.3). Anything else is a plain number.
std::string firmware_text(int64_t number) {
  std::string digits = std::to_string(number);
  char check = 0;
  if (digits.size() == 10 && digits[0] == '1' && digits[7] == '0') {
    digits.erase(0, 1);
    check = 'X';
  }
  if (digits.size() != 9 || number < 0) return std::to_string(number);
  if (check == 0) check = digits[6];
  return digits.substr(0, 3) + " " + digits.substr(3, 3) + " " + check + "." + digits.substr(7);
}

std::optional<int32_t> parse_firmware(std::string_view text) {
  std::string digits;
  for (const char c : text) {
    if (c == ' ' || c == '.') continue;
    const bool other = (c == 'X' && digits.size() == 6) || (c == '-' && digits.empty());
    if ((c < '0' || c > '9') && !other) return std::nullopt;
    digits += c;
  }
  if (digits.size() > 6 && digits[6] == 'X') {
    if (digits.size() != 9) return std::nullopt;
    digits[6] = '0';
    digits.insert(0, "1");
  }
  int32_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc{} || end != digits.data() + digits.size()) return std::nullopt;
  return value;
}

// Four characters, the first in the low byte; 0 ends the text (P852, 1053 1610 p. 81).
std::optional<std::string> ascii_text(int32_t value) {
  std::string text;
  uint32_t rest = static_cast<uint32_t>(value);
  for (; rest != 0; rest >>= 8) {
    const auto c = static_cast<char>(rest & 0xFF);
    if (c < 0x20 || c > 0x7E) return std::nullopt;
    text += c;
  }
  if (text.starts_with(' ') || text.ends_with(' ') || text.starts_with("0x")) return std::nullopt;
  return text;
}

std::optional<int32_t> parse_ascii(std::string_view text) {
  if (text.size() > 4) return std::nullopt;
  uint32_t bits = 0;
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] < 0x20 || text[i] > 0x7E) return std::nullopt;
    bits |= static_cast<uint32_t>(static_cast<unsigned char>(text[i])) << (8 * i);
  }
  return static_cast<int32_t>(bits);
}

// Shown value = number x factor, where the text names a unit: the one shown, or another of the quantity.
std::optional<double> factor_of(const Parameter& parameter, std::string_view unit) {
  if (unit.empty() || unit == parameter.display) return display_scale(parameter).factor;
  const auto named = find_unit_conversion(parameter.quantity, unit);
  if (!named) return std::nullopt;
  const Conversion wanted = find_conversion(*named).value_or(Conversion{1, 0});
  const Conversion transferred = find_conversion(parameter.conversion).value_or(Conversion{1, 0});
  if (wanted.b != transferred.b) return std::nullopt;  // another scale of temperature
  return transferred.a / wanted.a;
}

std::string range_text(const Parameter& parameter, int64_t minimum, int64_t maximum) {
  const auto text = [&](int64_t number) {
    return parameter_text(parameter, static_cast<int32_t>(static_cast<uint32_t>(number)));
  };
  return text(minimum) + ".." + text(maximum);
}

// What would have been accepted instead of a refused value.
std::string allowed(const Parameter& parameter, int32_t value, ReturnCode code) {
  if (parameter.ranges.empty()) return choices(parameter);
  const int64_t number = parameter.number_of(value);
  for (const ValueRange& range : parameter.ranges)
    if (code == return_codes::kIncorrectValue && number >= range.minimum && number <= range.maximum)
      return range_text(parameter, range.minimum, range.maximum) + " in steps of " +
             parameter_text(parameter, static_cast<int32_t>(range.step));
  if (code != return_codes::kIncorrectValue)
    return range_text(parameter, parameter.minimum(), parameter.maximum());
  return parameter_range(parameter);
}

// A number without unit whose least step is a whole one, as an identifier that is coded in thousandths.
bool is_whole(const Parameter& parameter, double factor) {
  return parameter.display.empty() && !parameter.ranges.empty() &&
         std::all_of(parameter.ranges.begin(), parameter.ranges.end(), [factor](const ValueRange& range) {
           const auto whole = [factor](int64_t number) {
             const double shown = static_cast<double>(number) * factor;
             return std::abs(shown - std::round(shown)) < 1e-9;
           };
           return range.step > 0 && whole(range.step) && whole(range.minimum);
         });
}

}  // namespace

DisplayScale display_scale(const Parameter& parameter) {
  const Conversion transferred = find_conversion(parameter.conversion).value_or(Conversion{1, 0});
  const int shown = find_unit_conversion(parameter.quantity, parameter.display).value_or(0);
  const double factor = transferred.a / find_conversion(shown).value_or(Conversion{1, 0}).a;
  if (is_whole(parameter, factor)) return {factor, 0};
  // A power of ten is shown exactly; other factors (minutes as hours) with three decimals, ours.
  for (int decimals = 0; decimals <= kMaxDecimals; ++decimals)
    if (std::abs(factor * std::pow(10, decimals) - 1) < 1e-9) return {factor, decimals};
  return {factor, 3};
}

std::string parameter_text(const Parameter& parameter, int32_t value) {
  if (parameter.display == kFirmware) return firmware_text(parameter.number_of(value));
  if (parameter.display == kAscii)
    if (const auto text = ascii_text(value)) return *text;
  const std::string unit = parameter.display.empty() ? "" : " " + std::string(parameter.display);
  for (const ValueText& row : parameter.texts)
    if (row.value == value) return std::string(row.text) + unit;
  if (!parameter.texts.empty()) return std::to_string(value);  // a code that the list does not have
  if (parameter.display == kHex || parameter.display == kAscii) {
    char text[16];
    std::snprintf(text, sizeof text, "0x%04X", static_cast<unsigned>(value));
    return text;
  }
  const DisplayScale scale = display_scale(parameter);
  const double digits =
      static_cast<double>(parameter.number_of(value)) * scale.factor * std::pow(10, scale.decimals);
  return with_decimals(std::llround(digits), scale.decimals) + unit;
}

std::string parameter_range(const Parameter& parameter) {
  if (parameter.ranges.empty()) return choices(parameter);
  std::string text;
  for (size_t n = 0; n < parameter.ranges.size();) {
    const ValueRange& first = parameter.ranges[n];
    int64_t maximum = first.maximum;
    // Those that differ in their steps only are one.
    while (++n < parameter.ranges.size() && parameter.ranges[n].minimum == maximum)
      maximum = parameter.ranges[n].maximum;
    text += (text.empty() ? "" : " or ") + range_text(parameter, first.minimum, maximum);
  }
  return text;
}

tl::expected<int32_t, std::string> parse_parameter_text(const Parameter& parameter, std::string_view text) {
  text = trimmed(text);
  std::string_view word = text;
  const size_t unit_size = parameter.display.size();
  if (word.size() >= unit_size && same_word(word.substr(word.size() - unit_size), parameter.display))
    word = trimmed(word.substr(0, word.size() - unit_size));
  for (const ValueText& row : parameter.texts)
    if (same_word(row.text, word)) return row.value;

  if (text.starts_with("0x")) {
    uint32_t bits = 0;
    const auto [end, error] = std::from_chars(text.data() + 2, text.data() + text.size(), bits, 16);
    if (error == std::errc{} && end == text.data() + text.size()) return static_cast<int32_t>(bits);
    return tl::unexpected(accepted(parameter));
  }
  if (parameter.display == kFirmware || parameter.display == kAscii) {
    const auto bits = parameter.display == kFirmware ? parse_firmware(text) : parse_ascii(text);
    if (bits) return *bits;
    return tl::unexpected(accepted(parameter));
  }
  double number = 0;
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, number, std::chars_format::fixed);
  if (error != std::errc{}) return tl::unexpected(accepted(parameter));
  const std::string_view unit = trimmed({end, static_cast<size_t>(last - end)});
  // The code of a list is a plain number; anything else is in the unit shown.
  const auto factor = parameter.texts.empty() ? factor_of(parameter, unit)
                      : unit.empty()          ? std::optional<double>(1)
                                              : std::nullopt;
  if (factor)
    if (const auto bits = to_bits(parameter, number / *factor)) return *bits;
  return tl::unexpected(accepted(parameter));
}

std::string index_name(const ParameterTable& table, uint16_t index) {
  static constexpr struct {
    uint16_t first, count;
    std::string_view before;
  } kAreas[] = {{kFirstErrorResponses, 100, "error response "}, {kFirstMotorCurrent, 40, "motor current "},
                {kFirstMotorFlux, 40, "motor flux "},           {kFirstVariables, 1024, "H"},
                {kFirstProgram, 2048, "program word "},         {kFirstCurvePoints, 513, "curve point "}};
  if (const Parameter* parameter = table.find(index)) {
    const std::string number =
        parameter->number.empty() ? "index " + std::to_string(index) : "P" + std::string(parameter->number);
    return number + " " + std::string(parameter->name);
  }
  for (const auto& area : kAreas)
    if (index >= area.first && index - area.first < area.count)
      return std::string(area.before) + std::to_string(index - area.first);
  return "index " + std::to_string(index);
}

std::string explain_refusal(const ParameterTable& table, uint8_t service, uint16_t index, int32_t value,
                            ReturnCode code) {
  const Parameter* parameter = table.find(index);
  std::string text = index_name(table, index);
  if (is_write(static_cast<Service>(service)))
    text += " := " + (parameter ? parameter_text(*parameter, value) : std::to_string(value));
  text += ": ";
  if (const std::string_view meaning = return_code_meaning(code); !meaning.empty()) {
    text += meaning;
  } else {
    char bytes[32];
    std::snprintf(bytes, sizeof bytes, "return code %02X %02X %02X %02X", code.error_class, code.code,
                  code.additional >> 8, code.additional & 0xFF);
    text += bytes;
  }
  const bool about_value = code == return_codes::kTooLarge || code == return_codes::kTooSmall ||
                           code == return_codes::kIncorrectValue;
  if (parameter && about_value && !(parameter->ranges.empty() && parameter->texts.empty()))
    text += " (" + allowed(*parameter, value, code) + ")";
  if (code == return_codes::kParameterLock) text += " (P803 = ON)";
  if (code == return_codes::kNotImplemented && parameter == nullptr)
    text += " (this area of the unit is not simulated, docs/reference/limits.md)";
  return text;
}

}  // namespace ipos::stdlib
