// What is known of a program before machine code is made of it: where control comes together, how many
// commands can follow until the budget is looked at again, which variables are used most.
#pragma once

#include <cstdint>
#include <vector>

#include "vm/verify/verify.hpp"

namespace ipos::vm::jit {

inline constexpr uint32_t kNowhere = UINT32_MAX;

// The budget is looked at where cycles close: at targets of backward jumps, at subroutines and where they
// return to. There it must suffice for `need` commands, the most that can follow until the next such place.
//
// Machine code keeps one number: commands left less the `credit` of the command it stands at. Each command
// has a credit one below that of the command in front of it, so that a line of commands costs nothing; where
// ways with different credits meet, some of them correct the number. It is negative after a check exactly
// when less than `need` are left.
struct Command {
  Instruction instruction;
  Flow flow = Flow::Next;
  uint32_t at = 0;             // word address
  uint32_t target = kNowhere;  // the command its label leads to, for jumps and calls
  bool native = false;         // machine code is made of it
  bool joins = false;          // control comes from elsewhere than from the command in front
  bool checks = false;         // the budget is looked at
  bool called = false;         // begins a subroutine or stands after a call
  int depth = 0;               // of loops around it; calls count
  int32_t table = -1;          // SETI: where the index most likely leads, if that is known
  int32_t need = 0;
  int32_t credit = 0;   // after the check
  int32_t arrival = 0;  // credit in front of the check, for who comes here

  int32_t credit_of_arrival() const { return checks ? arrival : credit; }
};

struct Program {
  explicit Program(const VerifiedImage& image);

  // What the number must be corrected by on the way from one command to another.
  int32_t correction(const Command& from, const Command& to) const {
    return from.credit - 1 - to.credit_of_arrival();
  }

  std::vector<Command> commands;
  std::vector<uint32_t> index;  // of the command at a word address
  Limits limits;

 private:
  void decode_all(const VerifiedImage& image);
  void mark();
  void nest();
  void count();
  void find_tables();
};

// The variables used most, loops weighing more, at most `most` of them; none that is used outside of loops
// only, and none behind the beginning of a table that is used a loop deeper, as it may be an element.
std::vector<uint16_t> hottest_variables(const Program& program, size_t most);

}  // namespace ipos::vm::jit
