// Ranges of variable numbers that the compiler hands out, and advice where there is room for more. Defaults
// as in docs/guide/language.md: globals from H420 (1053 1610 p. 49, watch window), up to the system variables.
#pragma once

#include <bitset>
#include <cstdint>
#include <string>

#include "stdlib/system_variables.hpp"
#include "stdlib/unit_types.hpp"

namespace ipos::compiler {

inline constexpr uint32_t kMaxNumbers = 1024;
// The last number that a program cannot claim (IPOSplus p. 39). Those of the simulated ISYNC of a MOVIDRIVE B above it,
// up to stdlib::kLastSystemVariable, are ours: a program may claim them, and is told.
inline constexpr uint32_t kLastReservedVariable = 560;
inline constexpr uint32_t kLastNonVolatile = 127;     // IPOSplus p. 320

struct NumberRange {
  uint32_t low = 0;
  uint32_t high = 0;
  uint32_t size() const { return high - low + 1; }
  bool contains(uint32_t number) const { return number >= low && number <= high; }
  bool overlaps(const NumberRange& other) const { return low <= other.high && other.low <= high; }
};

enum class RangeKind : uint8_t { Globals, Initials, Temporaries };

// "globals" and the like, as in #pragma; temporaries are "var" there.
const char* pragma_name(RangeKind kind);

struct Ranges {
  NumberRange globals{420, 452};
  NumberRange initials{0, kLastNonVolatile};
  NumberRange temporaries{400, 419};

  NumberRange& of(RangeKind kind);
  const NumberRange& of(RangeKind kind) const;
};

// "'#pragma var 380 419' makes room", or why no pragma can help. `named`: numbers that must stay free.
std::string range_advice(RangeKind kind, uint32_t count, const Ranges& ranges,
                         const std::bitset<kMaxNumbers>& named, const stdlib::UnitType& unit);

}  // namespace ipos::compiler
