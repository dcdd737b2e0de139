// Dispatch of system commands.
#include "runtime/services/system_commands.hpp"

namespace ipos::runtime {
namespace {

constexpr vm::HostReply fail(const char* reason) { return {vm::Answer::Fault, vm::kFaultIllop, reason}; }

}  // namespace

SystemCommands::SystemCommands(const EventQueue& clock, Journal& journal, std::string_view station,
                               std::array<VariableObjects*, 2> objects, MovilinkCommand& movilink)
    : clock_(clock), journal_(journal), station_(station), objects_(objects), movilink_(movilink) {}

vm::Host SystemCommands::host() {
  return {this, [](void* self, vm::Machine& machine, int task, const vm::Instruction& command) noexcept {
            return static_cast<SystemCommands*>(self)->execute(machine, task, command);
          }};
}

vm::HostReply SystemCommands::execute(vm::Machine& machine, int task, const vm::Instruction& command) {
  using vm::Opcode;
  const auto operand = [&](size_t n) { return static_cast<uint32_t>(command.operands[n]); };
  switch (command.opcode) {
    case Opcode::Scom:
      return define_object(machine, static_cast<ObjectKind>(command.operands[0]), operand(1));
    case Opcode::ScomOn: return start_objects();
    case Opcode::ScomState: return switch_objects(machine, command.operands[0] != 0, operand(1));
    case Opcode::Movlnk: return exchange(machine, task, operand(0));
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

vm::HostReply SystemCommands::define_object(vm::Machine& machine, ObjectKind kind, uint32_t variable) {
  const int32_t object = machine.variables()[variable];
  const bool second = object >= 0 && (object & kSbus2Object) != 0 && objects_[1] != nullptr;
  VariableObjects* objects = objects_[second ? 1 : 0];
  if (objects == nullptr) return fail("SCOM: the station is not on this SBus");
  std::string why;
  const bool data_exist = objects->define(kind, variable, machine.variables(), why);
  explain(std::move(why));
  return data_exist ? vm::HostReply{} : fail("DPointer of SCOM does not lead to variables of the unit");
}

vm::HostReply SystemCommands::start_objects() {
  if (objects_[0] == nullptr && objects_[1] == nullptr) return fail("SCOMON: the station is on no SBus");
  for (VariableObjects* objects : objects_)
    if (objects != nullptr) objects->start(clock_.now() / kMillisecond);
  return {};
}

// The variable takes the state: 1 sending and receiving, 0 not (ours: no manual read prints the arguments).
vm::HostReply SystemCommands::switch_objects(vm::Machine& machine, bool on, uint32_t state) {
  if (on) {
    if (const vm::HostReply reply = start_objects(); reply.answer != vm::Answer::Done) return reply;
  } else {
    for (VariableObjects* objects : objects_)
      if (objects != nullptr) objects->pause();
  }
  machine.variables()[state] = on ? 1 : 0;
  return {};
}

vm::HostReply SystemCommands::exchange(vm::Machine& machine, int task, uint32_t variable) {
  std::string why;
  const vm::HostReply reply = movilink_.start(clock_.now(), machine, task, variable, why);
  explain(std::move(why));
  return reply;
}

void SystemCommands::explain(std::string why) {
  if (!why.empty()) journal_.note(clock_.now(), Weight::Warning, station_, std::move(why));
}

}  // namespace ipos::runtime
