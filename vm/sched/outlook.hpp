// What the program of a machine can still do from where its tasks are. The commands a task can reach are
// closed: whatever happens it executes no other ones, until the program is restarted. So what is missing
// here stays missing.
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <span>

#include "vm/exec/machine.hpp"

namespace ipos::vm {

class Outlook {
 public:
  using Variables = std::bitset<kMaxVariables>;

  explicit Outlook(const Machine& machine);

  bool reaches(Opcode opcode) const { return commands_[static_cast<size_t>(opcode)]; }

  // False: no command can cause a fault, whatever the variables are.
  bool may_fault() const { return faults_.any(); }
  // The same where these commands cannot, as the host never answers them with one.
  bool may_fault_beside(std::span<const Opcode> harmless) const {
    std::bitset<256> left = faults_;
    for (const Opcode opcode : harmless) left.reset(static_cast<size_t>(opcode));
    return left.any();
  }

  // False: the tasks go round for ever, and all they do is to change variables.
  bool may_stop() const { return stops_; }

  // False: no command asks the host for anything.
  bool calls() const { return calls_; }

  // Of all tasks, without what the host does for system commands. One of the two has all variables where a
  // command computes which one it means.
  const Variables& used() const { return used_; }  // read or written
  const Variables& written() const { return written_; }

  // No task writes what another one uses: with system commands left aside, it does not matter how their
  // commands alternate.
  bool apart() const { return apart_; }

 private:
  class Walk;

  std::bitset<256> commands_;
  std::bitset<256> faults_;  // of these, those that can
  Variables used_, written_;
  bool stops_ = false;
  bool calls_ = false;
  bool apart_ = true;
};

}  // namespace ipos::vm
