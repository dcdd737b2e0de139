// Follows every way through the code, for each task from where its contexts stand.
#include "vm/sched/outlook.hpp"

#include "vm/isa/effects.hpp"

namespace ipos::vm {
namespace {

// The machine does it alone, and nothing but the time of the task follows from it.
constexpr bool waits(Opcode opcode) { return opcode == Opcode::WaitH || opcode == Opcode::WaitK; }

}  // namespace

class Outlook::Walk {
 public:
  explicit Walk(const VerifiedImage& program) : program_(program) {}

  void begin(int task, uint32_t address) {
    Task& t = tasks_[static_cast<size_t>(task - 1)];
    if (t.seen[address]) return;
    t.seen[address] = true;
    waiting_[waiting_count_++] = {static_cast<uint16_t>(address), static_cast<uint8_t>(task)};
  }

  void finish(Outlook& outlook) {
    while (waiting_count_ != 0) {
      const Place place = waiting_[--waiting_count_];
      pass(place.task, place.address, outlook);
    }
    for (const Task& t : tasks_) {
      outlook.apart_ &= (outlook.written_ & t.used).none() && (outlook.used_ & t.written).none();
      outlook.used_ |= t.used;
      outlook.written_ |= t.written;
    }
  }

 private:
  struct Task {
    std::bitset<kMaxProgramWords> seen;
    Variables used, written;
  };
  struct Place {
    uint16_t address;
    uint8_t task;
  };

  void pass(int task, uint32_t address, Outlook& outlook) {
    const Decoded decoded = decode(program_.code(), address);
    const Instruction& command = decoded.instruction;
    const Coding& row = coding(command.opcode);
    outlook.commands_[static_cast<size_t>(command.opcode)] = true;
    if (can_fault(command)) outlook.faults_[static_cast<size_t>(command.opcode)] = true;
    outlook.stops_ |=
        can_fault(command) || (row.flow != Flow::Next && row.flow != Flow::Jump && row.flow != Flow::Branch);
    outlook.calls_ |= (row.flow == Flow::System || row.flow == Flow::SystemCall) && !waits(command.opcode);
    note_variables(tasks_[static_cast<size_t>(task - 1)], command, row);
    for (auto value = command.operands.begin(); const OperandKind kind : row.kinds) {
      const auto label = static_cast<uint32_t>(*value++);
      if (kind == OperandKind::Label) follow(task, command, label);
    }
    if (row.flow != Flow::Jump && row.flow != Flow::Return && row.flow != Flow::End)
      begin(task, address + decoded.words);
  }

  // Who begins at the label of a command.
  void follow(int task, const Instruction& command, uint32_t label) {
    const bool on = command.operands[0] != 0;
    switch (command.opcode) {
      case Opcode::Task2: return on ? begin(2, label) : void();
      case Opcode::Task: return on ? begin(3, label) : void();
      case Opcode::SetInt: return on ? begin(1, label) : void();
      case Opcode::VarInt:  // its structure says whose it is
        for (int other = 1; other <= kTasks; ++other) begin(other, label);
        return;
      default: begin(task, label);
    }
  }

  static void note_variables(Task& t, const Instruction& command, const Coding& row) {
    const auto note = [](Variables& variables, VariableRange range) {
      for (uint32_t n = range.first; n < range.end(); ++n) variables[n] = true;
    };
    each_named(command, [&](VariableRange range) { note(t.used, range); });
    note(t.written, named_target(command));
    if (row.writes == Writes::Indexed) t.written.set();
    if (row.writes == Writes::Indexed || row.reads == Reads::Indexed) t.used.set();
  }

  const VerifiedImage& program_;
  std::array<Task, kTasks> tasks_{};
  std::array<Place, kTasks * kMaxProgramWords> waiting_;  // each address once for each task
  size_t waiting_count_ = 0;
};

Outlook::Outlook(const Machine& machine) {
  Walk walk(machine.program());
  for (int number = 1; number <= kContexts; ++number) {
    const TaskContext& t = machine.context(number);
    if (t.state == TaskState::Stopped) continue;
    walk.begin(t.task, t.pc);
    for (size_t n = 0; n < t.depth; ++n) walk.begin(t.task, t.calls[n]);
  }
  for (const EventInterrupt& interrupt : machine.interrupts().events)
    if (interrupt.installed) walk.begin(1, interrupt.address);
  for (const VariableInterrupt& interrupt : machine.interrupts().variables)
    if (interrupt.installed) walk.begin(interrupt.task, interrupt.address);
  walk.finish(*this);
}

}  // namespace ipos::vm
