// The VM's host: carries the system commands of a program to the service that knows them. A command nothing
// here knows ends in F10 with a reason, never in silence (docs/limits.md lists them).
#pragma once

#include <array>

#include "runtime/services/journal.hpp"
#include "runtime/services/movilink_command.hpp"
#include "runtime/services/variable_objects.hpp"
#include "vm/exec/machine.hpp"

namespace ipos::runtime {

class SystemCommands {
 public:
  // The objects of SBus 1 and 2, null for a bus the unit is not on.
  SystemCommands(const EventQueue& clock, Journal& journal, std::string_view station,
                 std::array<VariableObjects*, 2> objects, MovilinkCommand& movilink);

  vm::Host host();

 private:
  vm::HostReply execute(vm::Machine& machine, int task, const vm::Instruction& command);
  vm::HostReply define_object(vm::Machine& machine, ObjectKind kind, uint32_t variable);
  vm::HostReply start_objects();
  vm::HostReply switch_objects(vm::Machine& machine, bool on, uint32_t state);
  vm::HostReply exchange(vm::Machine& machine, int task, uint32_t variable);
  void explain(std::string why);

  const EventQueue& clock_;
  Journal& journal_;
  std::string station_;
  std::array<VariableObjects*, 2> objects_;
  MovilinkCommand& movilink_;
};

}  // namespace ipos::runtime
