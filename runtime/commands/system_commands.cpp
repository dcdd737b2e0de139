// A system command goes to the function with its name.
#include "runtime/commands/system_commands.hpp"

#include <fmt/format.h>

#include <cassert>

#include "runtime/commands/source_places.hpp"

namespace ipos::runtime {
namespace {

vm::HostReply forward(CommandCall& call) {
  switch (call.command.opcode) {
#define COMMAND_Host(Name) \
  case vm::Opcode::Name: return commands::Name(call);
#define OPCODE(code, Name, text, flow, reads, writes, faults, meaning) COMMAND_##faults(Name)
#include "vm/isa/opcodes.def"
#undef COMMAND_Host
    default: break;
  }
  assert(false && "the machine executes the command itself");
  return illegal("the host does not execute this command");
}

}  // namespace

SystemCommands::SystemCommands(const ProgramServices& services, Journal& journal, std::string_view station,
                               const vm::Image* image)
    : services_(services), journal_(journal), station_(station), image_(image) {}

vm::Host SystemCommands::host() {
  return {this,
          [](void* self, vm::Machine& machine, int context, const vm::Instruction& command) noexcept {
            return static_cast<SystemCommands*>(self)->execute(machine, context, command);
          },
          [](void* self, vm::Machine& machine, int context) noexcept {
            static_cast<SystemCommands*>(self)->cancel(machine, context);
          }};
}

vm::HostReply SystemCommands::execute(vm::Machine& machine, int context, const vm::Instruction& command) {
  CommandCall call{services_, machine, context, command, {}, 0, {}};
  const vm::HostReply reply = forward(call);
  const Time now = services_.clock.now();
  if (!call.why.empty()) journal_.note(now, Weight::Warning, station_, std::move(call.why));
  if (call.caused_fault != 0) {
    const std::string place =
        image_ == nullptr ? std::string() : source_place(*image_, machine.context(context).pc);
    journal_.note(now, Weight::Warning, station_,
                  fmt::format("F{:02} caused by {}{}: {}", call.caused_fault, vm::context_name(context),
                              place.empty() ? "" : " at " + place, call.cause));
    services_.drive.raise_fault(call.caused_fault);
  }
  return reply;
}

void SystemCommands::cancel(vm::Machine& machine, int context) {
  services_.movilink.give_up(machine, context);
  if (services_.positioning != nullptr) services_.positioning->cancel(context);
}

}  // namespace ipos::runtime
