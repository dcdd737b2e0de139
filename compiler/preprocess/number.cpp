// Numbers of the language.
#include "compiler/preprocess/number.hpp"

namespace ipos::compiler {
namespace {

// `1.5`, `.5`, `1.`, `1e6`: what C reads as a floating constant.
bool is_fraction(std::string_view text) {
  size_t digits = 0;
  while (digits < text.size() && digit_value(text[digits]) < 10) ++digits;
  if (digits == text.size()) return false;
  return text[digits] == '.' || (digits > 0 && (text[digits] == 'e' || text[digits] == 'E'));
}

}  // namespace

uint32_t digit_value(char c) {
  if (c >= '0' && c <= '9') return static_cast<uint32_t>(c - '0');
  if (c >= 'a' && c <= 'f') return static_cast<uint32_t>(c - 'a' + 10);
  if (c >= 'A' && c <= 'F') return static_cast<uint32_t>(c - 'A' + 10);
  return 99;
}

ParsedNumber parse_number(std::string_view text, bool behind_minus) {
  uint32_t base = 10;
  std::string_view digits = text;
  if (text.size() > 2 && text[0] == '0' && (text[1] == 'x' || text[1] == 'X')) base = 16;
  if (text.size() > 2 && text[0] == '0' && (text[1] == 'b' || text[1] == 'B')) base = 2;
  if (base != 10) digits.remove_prefix(2);
  if (base == 10 && is_fraction(text)) return {NumberForm::Fraction, 0, false};

  const uint64_t limit = base != 10 ? 0xFFFF'FFFFU : behind_minus ? 0x8000'0000U : 0x7FFF'FFFFU;
  uint64_t value = 0;
  bool too_large = false;
  for (char c : digits) {
    const uint32_t digit = digit_value(c);
    if (digit >= base) return {};
    value = value * base + digit;
    too_large = too_large || value > limit;
    if (too_large) value = 0;  // keeps the 64 bits from overflowing while the rest is checked
  }
  if (too_large) return {NumberForm::TooLarge, 0, base != 10};
  return {NumberForm::Good, static_cast<uint32_t>(value), base != 10};
}

}  // namespace ipos::compiler
