// Dispatch of system commands.
#include "runtime/services/system_commands.hpp"

namespace ipos::runtime {
namespace {

constexpr vm::HostReply fail(const char* reason) { return {vm::Answer::Fault, vm::kFaultIllop, reason}; }

}  // namespace

SystemCommands::SystemCommands(const EventQueue& clock, Journal& journal, std::string_view station,
                               VariableObjects* objects, MovilinkCommand& movilink)
    : clock_(clock), journal_(journal), station_(station), objects_(objects), movilink_(movilink) {}

vm::Host SystemCommands::host() {
  return {this, [](void* self, vm::Machine& machine, int task, const vm::Instruction& command) noexcept {
            return static_cast<SystemCommands*>(self)->execute(machine, task, command);
          }};
}

vm::HostReply SystemCommands::execute(vm::Machine& machine, int task, const vm::Instruction& command) {
  using vm::Opcode;
  std::string why;
  switch (command.opcode) {
    case Opcode::Scom: {
      if (objects_ == nullptr) return fail("SCOM: the station is on no SBus");
      const auto kind = static_cast<ObjectKind>(command.operands[0]);
      const auto variable = static_cast<uint32_t>(command.operands[1]);
      const bool data_exist = objects_->define(kind, variable, machine.variables(), why);
      explain(std::move(why));
      return data_exist ? vm::HostReply{} : fail("DPointer of SCOM does not lead to variables of the unit");
    }
    case Opcode::ScomOn:
      if (objects_ == nullptr) return fail("SCOMON: the station is on no SBus");
      if (!objects_->started()) objects_->start(clock_.now() / kMillisecond);
      return {};
    case Opcode::Movlnk: {
      const auto variable = static_cast<uint32_t>(command.operands[0]);
      const vm::HostReply reply = movilink_.start(clock_.now(), machine, task, variable, why);
      explain(std::move(why));
      return reply;
    }
    case Opcode::Task2:
    case Opcode::Task: {
      const int other = command.opcode == Opcode::Task2 ? 2 : 3;
      if (command.operands[0] == 0)
        machine.stop_task(other);
      else
        machine.start_task(other, static_cast<uint32_t>(command.operands[1]));
      return {};
    }
    default: return fail("this command is not simulated yet, see docs/limits.md");
  }
}

void SystemCommands::explain(std::string why) {
  if (!why.empty()) journal_.note(clock_.now(), Weight::Warning, station_, std::move(why));
}

}  // namespace ipos::runtime
