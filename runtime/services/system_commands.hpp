// The VM's host: carries the system commands of a program to the service that knows them. A command nothing
// here knows ends in F10 with a reason, never in silence (docs/limits.md lists them).
#pragma once

#include "runtime/services/journal.hpp"
#include "runtime/services/movilink_command.hpp"
#include "runtime/services/variable_objects.hpp"
#include "vm/exec/machine.hpp"

namespace ipos::runtime {

class SystemCommands {
 public:
  // `objects` is null for a unit that is on no SBus.
  SystemCommands(const EventQueue& clock, Journal& journal, std::string_view station,
                 VariableObjects* objects, MovilinkCommand& movilink);

  vm::Host host();

 private:
  vm::HostReply execute(vm::Machine& machine, int task, const vm::Instruction& command);
  void explain(std::string why);

  const EventQueue& clock_;
  Journal& journal_;
  std::string station_;
  VariableObjects* objects_;
  MovilinkCommand& movilink_;
};

}  // namespace ipos::runtime
