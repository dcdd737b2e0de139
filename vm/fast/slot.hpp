// The predecoded form of a program: one slot of 8 bytes for each code word, so that a word address is the
// index of a slot and nothing has to be translated at calls, returns and faults. A fused operation begins in
// the slot of its first command and reads the others where they stand; so each command can be entered.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace ipos::vm::fast {

union Slot {
  struct Command {     // the first slot of every command
    uint16_t handler;  // what the engine does here: an offset or a number, see engine.hpp
    uint16_t a;        // variable
    uint16_t b;        // variable, bit number, comparisons of a switch
    uint16_t number;   // commands in front of it in the program
  };
  struct Constant {  // the second slot of commands with a constant
    int32_t value;
    uint32_t unused;
  };
  // The last slot of commands with a label. The engine keeps `left`: commands of its budget not yet used,
  // plus the number of the command it stands at. In a line of commands `left` stays the same; a jump changes
  // it by what is known beforehand.
  struct Route {
    int16_t delta;    // number of the command + 1 - number of the target
    uint16_t bound;   // number of the target + what stands in a line from there on: `left` must reach it
    int16_t offset;   // slots from here to the target
    uint16_t behind;  // word address after the command, where a CALL returns to
  };
  Command command;
  Constant constant;
  Route route;
  std::array<uint16_t, 4> lines;  // after the slots of the words, see Predecoded
};
static_assert(sizeof(Slot) == 8);

}  // namespace ipos::vm::fast
