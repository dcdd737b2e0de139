// The messages and signals of a DBC file: where they lie in a telegram, their scale, and what their values are called. Bit
// numbers: 8 * byte + bit, bit 7 the highest. A big-endian signal is named by its highest bit, a little-endian
// one by its lowest.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/bus/movilink/describe.hpp"

namespace ipos::runtime::dbc {

struct Signal {
  std::string name;
  uint32_t start = 0;
  uint32_t bits = 0;
  bool intel = false;
  bool is_signed = false;
  double factor = 1;
  std::string unit{};
  std::vector<std::pair<int32_t, std::string>> values{};  // what they are called
  bool multiplexor = false;                               // it says which signal the others are
  std::optional<uint16_t> multiplexed{};                  // there only with this value of the multiplexor
};

inline constexpr const char* kNobody = "Vector__XXX";

struct Message {
  uint32_t id = 0;
  std::string name;
  uint32_t bytes = 0;
  std::string sender = kNobody;       // station
  std::set<std::string> receivers{};  // stations
  std::vector<Signal> signals{};
  int32_t cycle = 0;
  std::string comment{};
};

// Letters, digits and underscores, at most kLongestName.
inline constexpr size_t kLongestName = 32;
std::string identifier(std::string_view text);

// A process data word in a telegram: the numbers of its two bytes.
struct WordPlace {
  uint32_t low = 0, high = 0;
  bool is_intel() const { return low < high; }
};
// Its bits where it is a control or status word, else the word with its scale; `word` is "PO1".
void add_word(std::vector<Signal>& signals, const std::string& word, WordPlace place,
              const stdlib::UnitType* unit, bool input, uint8_t code);

std::vector<Signal> object_signals(const ObjectNames& object);
// Control and status words as their bits.
std::vector<Signal> process_signals(const UnitNames& unit, bool input);
// The parameter channel: management byte, index, and the value of each parameter of the unit where the index
// is its own.
std::vector<Signal> parameter_signals(const UnitNames& unit);

}  // namespace ipos::runtime::dbc
