// Bits by table; what several bits say together by rule.
#include "runtime/bus/movilink/unit_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "stdlib/faults.hpp"

namespace ipos::runtime {
namespace {

// Units with a trait, or those without.
struct Units {
  std::optional<stdlib::Trait> trait;
  bool with = true;
  bool have(const stdlib::UnitType& unit) const { return !trait || unit.has(*trait) == with; }
};
constexpr Units all{};
constexpr Units with(stdlib::Trait trait) { return {trait}; }
constexpr Units without(stdlib::Trait trait) { return {trait, false}; }

struct ControlBit {
  int word;
  Units units;
  unsigned bit;
  const char* text;
};
constexpr auto kControlBits = [] {
  using enum stdlib::Trait;
  return std::to_array<ControlBit>({
#define CONTROL_BIT(word, units, bit, text) {word, units, bit, text},
#include "runtime/bus/movilink/unit_words.def"
  });
}();

struct StatusBit {
  Units units;
  unsigned bit;
  const char* text;
};
constexpr auto kStatusBits = [] {
  using enum stdlib::Trait;
  return std::to_array<StatusBit>({
#define STATUS_BIT(units, bit, text) {units, bit, text},
#include "runtime/bus/movilink/unit_words.def"
  });
}();

struct Condition {
  int code;
  const char* text;
};
constexpr Condition kConditions[] = {
#define UNIT_CONDITION(code, name, text) {code, text},
#include "stdlib/unit_conditions.def"
};

constexpr bool bit(uint16_t word, unsigned number) { return (word >> number & 1) != 0; }

// Bits 2..0: the most restrictive counts (MOVITRAC 07 chapter 6.3).
const char* command_text(uint16_t word) {
  if (bit(word, 0)) return "controller inhibit";
  if (!bit(word, 1)) return "rapid stop";
  return bit(word, 2) ? "enable" : "stop";
}

// Bits 1 and 5 (MOVITRAC 07 chapter 6.5).
const char* readiness_text(uint16_t word) {
  if (bit(word, 5)) return bit(word, 1) ? "warning" : "fault";
  return bit(word, 1) ? "ready" : "not ready";
}

std::string condition_of(const stdlib::UnitType& unit, int code) {
  constexpr int kFactorySetting = 8;
  const int shown = code == 5 && unit.has(stdlib::Trait::FactorySettingIs5) ? kFactorySetting : code;
  for (const Condition& row : kConditions)
    if (row.code == shown) return fmt::format("; state {} {}", code, row.text);
  return fmt::format("; state {}", code);
}

}  // namespace

std::string control_word_text(const stdlib::UnitType& unit, int number, uint16_t word) {
  std::string text = command_text(word);
  for (unsigned n = 3; n < 16; ++n) {
    if (!bit(word, n)) continue;
    std::string name = fmt::format("reserved bit {}", n);
    for (const ControlBit& row : kControlBits)
      if (row.bit == n && row.units.have(unit) && (row.word == 0 || row.word == number))
        name = row.text;
    text += ", " + name;
  }
  return text;
}

std::string status_word_text(const stdlib::UnitType& unit, int number, uint16_t word) {
  std::string text = readiness_text(word);
  for (const StatusBit& row : kStatusBits)
    if (bit(word, row.bit) && row.units.have(unit)) text += fmt::format(", {}", row.text);
  const int high = word >> 8;
  if (number == 1 && bit(word, 5)) {
    const stdlib::FaultRow* fault = stdlib::find_fault(static_cast<uint8_t>(high));
    if (high != 0)
      text += fmt::format("; F{:02}{}", high, fault == nullptr ? "" : fmt::format(" {}", fault->name));
  } else if (number == 1) {
    text += condition_of(unit, high);
  } else if (number == 2) {
    for (unsigned n = 8; n < 16; ++n)
      if (bit(word, n)) text += fmt::format(", DO1{}", n - 8);
  }
  return text;
}

namespace {

struct Word {
  bool input;
  uint8_t code;
  int number;
};
constexpr Word kWords[] = {{false, 9, 1}, {false, 10, 2}, {true, 6, 1}, {true, 7, 2}, {true, 11, 3}};

const Word* find_word(bool input, uint8_t code) {
  for (const Word& row : kWords)
    if (row.input == input && row.code == code) return &row;
  return nullptr;
}

}  // namespace

std::string unit_word_text(const stdlib::UnitType& unit, bool input, uint8_t code, uint16_t word) {
  const Word* row = find_word(input, code);
  if (row == nullptr) return {};
  return input ? status_word_text(unit, row->number, word) : control_word_text(unit, row->number, word);
}

std::vector<WordBit> unit_word_bits(const stdlib::UnitType& unit, bool input, uint8_t code) {
  const Word* word = find_word(input, code);
  if (word == nullptr) return {};
  std::vector<WordBit> bits;
  if (input) {
    bits = {{1, "ready", "not ready", "ready"}, {5, "fault or warning"}};
    for (const StatusBit& row : kStatusBits)
      if (row.units.have(unit)) bits.push_back({row.bit, row.text});
  } else {
    bits = {{0, "controller inhibit"},
            {1, "no rapid stop", "rapid stop", "enable"},
            {2, "no stop", "stop", "enable"}};
    for (const ControlBit& row : kControlBits)
      if (row.units.have(unit) && (row.word == 0 || row.word == word->number))
        bits.push_back({row.bit, row.text});
  }
  std::sort(bits.begin(), bits.end(), [](const WordBit& a, const WordBit& b) { return a.bit < b.bit; });
  return bits;
}

std::vector<std::pair<int, std::string>> unit_state_texts(uint8_t code) {
  std::vector<std::pair<int, std::string>> texts;
  const Word* word = find_word(true, code);
  if (word != nullptr && word->number == 1)
    for (const Condition& row : kConditions) texts.emplace_back(row.code, row.text);
  return texts;
}

}  // namespace ipos::runtime
