// How many commands a program needs at most, read from its code: of each function one call, of what never ends one turn.
// A figure is never too small; where none can be given, it says because of what. What no analysis of one program knows is left
// aside: interrupt routines that come in between, and values that others write over the parameter channel.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "vm/image/image.hpp"

namespace ipos::compiler {

struct LoopTiming {
  uint32_t line = 0;                 // where it begins; 0: the image does not know it
  std::optional<uint64_t> turns;     // of its body, at most; none: nothing tells, or it is endless
  std::optional<uint64_t> commands;  // of its longest turn
};

struct FunctionTiming {
  enum class Kind : uint8_t {
    Call,      // from its first command to its return
    Turn,      // it never returns: the longest turn of its endless loop
    Interrupt  // a call of an interrupt routine
  };
  std::string name;
  uint32_t line = 0;  // of its first command; 0: the image does not know it
  uint8_t task = 1;   // whose commands it uses; the slowest one where several do
  Kind kind = Kind::Call;
  std::optional<uint64_t> commands;  // at most
  std::optional<uint64_t> ms;        // at most, with the waits that are constant; whole ticks
  std::string because;               // why there is no figure, or how often its loops go round at most
  std::vector<uint32_t> longest;     // lines of the longest way, in rising order
  std::vector<LoopTiming> loops;     // inner ones before those around them
};

// `commands_a_ms`: of tasks 1, 2 and 3. `variables`: how many the unit has. The image has been verified.
std::vector<FunctionTiming> function_timings(const vm::Image& image, uint32_t variables,
                                             const std::array<uint32_t, 3>& commands_a_ms);

}  // namespace ipos::compiler
