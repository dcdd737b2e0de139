// The VM's host: carries the system commands of a program to the service that knows them. A command nothing
// here knows ends in F10 with a reason, never in silence (docs/reference/limits.md lists them).
#pragma once

#include <string>
#include <string_view>

#include "runtime/commands/command_call.hpp"
#include "runtime/journal/journal.hpp"
#include "vm/image/image.hpp"

namespace ipos::runtime {

class SystemCommands {
 public:
  // The image tells where in the source a command stands; null when the program is of another one. It and the
  // journal must outlive this.
  SystemCommands(const ProgramServices& services, Journal& journal, std::string_view station,
                 const vm::Image* image);

  vm::Host host();

 private:
  vm::HostReply execute(vm::Machine& machine, int context, const vm::Instruction& command);
  void cancel(vm::Machine& machine, int context);

  ProgramServices services_;
  Journal& journal_;
  std::string station_;
  const vm::Image* image_;
};

}  // namespace ipos::runtime
