// Dispatch of system commands: which family has which command.
#include "runtime/commands/system_commands.hpp"

#include <fmt/format.h>

#include "runtime/commands/source_places.hpp"

namespace ipos::runtime {
namespace {

vm::HostReply forward(CommandCall& call) {
  using vm::Opcode;
  if (PositioningCommands* positioning = call.services.positioning)
    if (const auto reply = positioning->execute(call.machine, call.context, call.command)) return *reply;
  switch (call.command.opcode) {
    case Opcode::Scom:
    case Opcode::ScomOn:
    case Opcode::ScomState:
    case Opcode::Movlnk: return communication_command(call);
    case Opcode::InputCall:
    case Opcode::SystemCall: return call_command(call);
    case Opcode::SetFault:
    case Opcode::Reset:
    case Opcode::Memorize:
    case Opcode::WdOnH:
    case Opcode::WdOnK:
    case Opcode::WdOff: return unit_command(call);
    case Opcode::GetSys: return get_system_value(call);
    case Opcode::SetSys: return set_system_value(call);
    default: return illegal("this command is not simulated yet, see docs/reference/limits.md");
  }
}

}  // namespace

SystemCommands::SystemCommands(const StationServices& services, Journal& journal, std::string_view station,
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
