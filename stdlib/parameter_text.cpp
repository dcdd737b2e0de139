// Parameter values as people read and write them: units, decimals, names of codes (1053 1610 p. 84-86).
#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>

#include "stdlib/parameters.hpp"
#include "stdlib/units.hpp"

namespace ipos::stdlib {
namespace {

constexpr int kMaxDecimals = 9;

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

std::string accepted(const Parameter& parameter) {
  std::string text = "expected ";
  if (!parameter.texts.empty()) {
    for (size_t i = 0; i < parameter.texts.size(); ++i) {
      if (i > 0) text += i + 1 == parameter.texts.size() ? " or " : ", ";
      text += std::to_string(parameter.texts[i].value) + " = " + std::string(parameter.texts[i].text);
    }
    return text;
  }
  const DisplayScale scale = display_scale(parameter);
  text += "a number";
  if (scale.decimals > 0) text += " with up to " + std::to_string(scale.decimals) + " decimals";
  if (!parameter.display.empty()) text += " in " + std::string(parameter.display);
  return text;
}

}  // namespace

DisplayScale display_scale(const Parameter& parameter) {
  const Conversion transferred = find_conversion(parameter.conversion).value_or(Conversion{1, 0});
  const int shown = find_unit_conversion(parameter.quantity, parameter.display).value_or(0);
  const double factor = transferred.a / find_conversion(shown).value_or(Conversion{1, 0}).a;
  // A power of ten is shown exactly; other factors (minutes as hours) with three decimals, ours.
  for (int decimals = 0; decimals <= kMaxDecimals; ++decimals)
    if (std::abs(factor * std::pow(10, decimals) - 1) < 1e-9) return {factor, decimals};
  return {factor, 3};
}

std::string parameter_text(const Parameter& parameter, int32_t value) {
  const std::string unit = parameter.display.empty() ? "" : " " + std::string(parameter.display);
  for (const ValueText& row : parameter.texts)
    if (row.value == value) return std::string(row.text) + unit;
  if (parameter.display == "hex") {
    char text[16];
    std::snprintf(text, sizeof text, "0x%04X", static_cast<unsigned>(value));
    return text;
  }
  const DisplayScale scale = display_scale(parameter);
  const double digits =
      static_cast<double>(parameter.number_of(value)) * scale.factor * std::pow(10, scale.decimals);
  return with_decimals(std::llround(digits), scale.decimals) + unit;
}

tl::expected<int32_t, std::string> parse_parameter_text(const Parameter& parameter, std::string_view text) {
  text = trimmed(text);
  if (!parameter.display.empty() && text.ends_with(parameter.display))
    text = trimmed(text.substr(0, text.size() - parameter.display.size()));
  for (const ValueText& row : parameter.texts)
    if (row.text == text) return row.value;

  if (text.starts_with("0x")) {
    uint32_t bits = 0;
    const auto [end, error] = std::from_chars(text.data() + 2, text.data() + text.size(), bits, 16);
    if (error == std::errc{} && end == text.data() + text.size()) return static_cast<int32_t>(bits);
    return tl::unexpected(accepted(parameter));
  }
  double number = 0;
  const auto [end, error] =
      std::from_chars(text.data(), text.data() + text.size(), number, std::chars_format::fixed);
  if (error != std::errc{} || end != text.data() + text.size()) return tl::unexpected(accepted(parameter));
  // The code of a list is a plain number; anything else is in the unit shown.
  const double factor = parameter.texts.empty() ? display_scale(parameter).factor : 1;
  if (const auto bits = to_bits(parameter, number / factor)) return *bits;
  return tl::unexpected(accepted(parameter));
}

}  // namespace ipos::stdlib
