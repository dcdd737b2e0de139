// The signals of a DBC file: where they lie in a telegram, their scale, and what their values are called. Bit
// numbers: 8 * byte + bit, bit 7 the highest. A big-endian signal is named by its highest bit, a little-endian
// one by its lowest.
#pragma once

#include <cstdint>
#include <optional>
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

// Letters, digits and underscores, at most 32.
std::string identifier(std::string_view text);

std::vector<Signal> object_signals(const ObjectNames& object);
// Control and status words as their bits.
std::vector<Signal> process_signals(const UnitNames& unit, bool input);
// The parameter channel: management byte, index, and the value of each parameter of the unit where the index
// is its own.
std::vector<Signal> parameter_signals(const UnitNames& unit);

}  // namespace ipos::runtime::dbc
