// Reads the small pieces of assembler text: words, numbers in every notation, variables, names.
#include "compiler/asm/reader.hpp"

#include <algorithm>

#include "compiler/asm/text_forms.hpp"
#include "compiler/preprocess/number.hpp"
#include "stdlib/plain_text.hpp"
#include "stdlib/system_variables.hpp"

namespace ipos::compiler {
namespace {

constexpr int64_t kLimit = int64_t{1} << 32;  // beside the range of constants

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_word(char c) { return is_digit(c) || (lower(c) >= 'a' && lower(c) <= 'z') || c == '_'; }

// Value of all digits, or nothing when one of them is none of the base; grows no further than kLimit.
std::optional<int64_t> digits_value(std::string_view digits, uint32_t base) {
  if (digits.empty()) return std::nullopt;
  int64_t value = 0;
  for (const char c : digits) {
    if (digit_value(c) >= base) return std::nullopt;
    value = std::min(value * base + digit_value(c), kLimit);
  }
  return value;
}

}  // namespace

void LineReader::skip_space() {
  while (at_ < line_.size() && is_space(line_[at_])) ++at_;
}

bool LineReader::done() {
  skip_space();
  return at_ == line_.size();
}

std::string_view LineReader::word() {
  skip_space();
  const size_t begin = at_;
  while (at_ < line_.size() && is_word(line_[at_])) ++at_;
  return line_.substr(begin, at_ - begin);
}

bool LineReader::text(std::string_view text) {
  const size_t begin = at_;
  skip_space();
  for (const char c : text) {
    if (c == ' ') {
      if (at_ == line_.size() || !is_space(line_[at_])) return go(begin), false;
      skip_space();
    } else {
      if (at_ == line_.size() || lower(line_[at_]) != lower(c)) return go(begin), false;
      ++at_;
    }
  }
  return true;
}

bool LineReader::whole(std::string_view words) {
  const size_t begin = at_;
  if (!text(words)) return false;
  if (is_word(words.back()) && at_ < line_.size() && is_word(line_[at_])) return go(begin), false;
  return true;
}

std::optional<uint64_t> LineReader::decimal() {
  const size_t begin = at_;
  skip_space();
  const size_t first = at_;
  uint64_t value = 0;
  for (; at_ < line_.size() && is_digit(line_[at_]); ++at_) {
    const auto digit = static_cast<uint64_t>(line_[at_] - '0');
    value = value > (UINT64_MAX - digit) / 10 ? UINT64_MAX : value * 10 + digit;
  }
  if (at_ == first || (at_ < line_.size() && is_word(line_[at_]))) return go(begin), std::nullopt;
  return value;
}

std::optional<int64_t> LineReader::constant() {
  const size_t begin = at_;
  text("#");  // GOR NOWAIT #-8000 (IPOSplus p. 34)
  const bool negative = text("-");
  const std::string_view digits = word();
  const bool hex = !digits.empty() && whole("hex");
  const char prefix = digits.size() > 2 && digits[0] == '0' ? lower(digits[1]) : '0';
  std::optional<int64_t> value;
  if (hex) {
    value = digits_value(digits, 16);
  } else if (prefix == 'x' || prefix == 'b') {
    value = digits_value(digits.substr(2), prefix == 'x' ? 16 : 2);
  } else {
    value = digits_value(digits, 10);
  }
  // Only hexadecimal and binary constants use bit 31 as sign.
  const bool decimal = !hex && prefix != 'x' && prefix != 'b';
  const int64_t highest = negative ? kLimit / 2 : decimal ? kLimit / 2 - 1 : kLimit - 1;
  if (!value) return go(begin), std::nullopt;
  if (*value > highest) value = kLimit;
  return negative ? -*value : *value;
}

std::optional<uint64_t> LineReader::variable() {
  const size_t begin = at_;
  skip_space();
  if (at_ + 1 < line_.size() && lower(line_[at_]) == 'h' && is_digit(line_[at_ + 1])) {
    const size_t letter = at_++;
    if (const auto number = decimal()) return number;
    at_ = letter;
  }
  // The longest name that fits: some assembler names are the beginning of others, some end in a dot.
  const stdlib::SystemVariable* best = nullptr;
  size_t end = begin;
  for (const stdlib::SystemVariable& row : stdlib::system_variables())
    for (const std::string_view name : {row.compiler_name, row.assembler_name}) {
      go(begin);
      if (!name.empty() && whole(name) && at_ > end) {
        best = &row;
        end = at_;
      }
    }
  if (best == nullptr) return go(begin), std::nullopt;
  go(end);
  return best->number;
}

std::optional<std::string> LineReader::name() {
  const size_t begin = at_;
  skip_space();
  std::string out;
  if (at_ == line_.size() || line_[at_] != '"') {
    while (at_ < line_.size() && is_bare(line_[at_])) out += line_[at_++];
    if (out.empty()) return go(begin), std::nullopt;
    return out;
  }
  for (++at_; at_ < line_.size() && line_[at_] != '"'; ++at_) {
    if (line_[at_] != '\\') {
      out += line_[at_];
      continue;
    }
    if (++at_ == line_.size()) break;
    if (line_[at_] != 'x') {
      out += line_[at_];
      continue;
    }
    const auto value = digits_value(line_.substr(at_ + 1, 2), 16);
    if (!value || line_.size() - at_ < 3) return go(begin), std::nullopt;
    out += static_cast<char>(*value);
    at_ += 2;
  }
  if (at_ == line_.size() || !stdlib::is_plain(out)) return go(begin), std::nullopt;
  ++at_;
  return out;
}

}  // namespace ipos::compiler
