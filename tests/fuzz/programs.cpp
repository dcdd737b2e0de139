// The host keeps to its contract (vm/host/host.hpp) and is otherwise as unpleasant as it may be: it waits,
// faults, starts and stops tasks, also its own, writes variables, and raises events and requests of
// interrupts.
#include "tests/fuzz/programs.hpp"

#include <algorithm>
#include <array>

#include "compiler/asm/assembler.hpp"
#include "compiler/asm/disassembler.hpp"
#include "stdlib/unit_types.hpp"
#include "tests/generated/pcg.hpp"
#include "vm/exec/machine.hpp"

namespace ipos::tests {
namespace {

using vm::Machine;
using vm::TaskState;

constexpr uint8_t kHostFault = 77;
constexpr int kRounds = 6;
constexpr uint32_t kCommandsARound = 120;

uint64_t begun = 0;  // interrupt routines

struct RandomHost {
  Pcg random;
  std::array<bool, vm::kContexts + 1> asked_to_wait{};

  static vm::HostReply execute(void* self, Machine& machine, int context,
                               const vm::Instruction& command) noexcept {
    auto& host = *static_cast<RandomHost*>(self);
    const vm::HostReply reply = host.answer(machine, context, command);
    // A context the command has stopped or started anew does not wait, whatever the answer is.
    const vm::TaskContext& t = machine.context(context);
    if (reply.answer == vm::Answer::Wait && t.state == TaskState::Ready && t.commands != 0)
      host.asked_to_wait[static_cast<size_t>(context)] = true;
    return reply;
  }
  static void cancel(void* self, Machine&, int context) noexcept {
    bool& waits = static_cast<RandomHost*>(self)->asked_to_wait[static_cast<size_t>(context)];
    require(waits, "only a wait for the host is cancelled");
    waits = false;
  }

  vm::HostReply answer(Machine& machine, int context, const vm::Instruction& command) {
    const int task = machine.context(context).task;
    const auto variables = machine.variables();
    if (random.one_in(4))
      variables[static_cast<size_t>(random.below(static_cast<int>(variables.size())))] =
          static_cast<int32_t>(random.next());
    if (random.one_in(40)) machine.stop_task(task);
    if (random.one_in(60)) machine.start_task(1 + random.below(vm::kTasks), 0);
    if (random.one_in(6)) machine.raise_event(static_cast<vm::Event>(random.below(vm::kEvents)));
    switch (random.below(10)) {
      case 0: return {vm::Answer::Wait, 0, nullptr};
      case 1:
      case 2:
        if (vm::info(command.opcode).flow == vm::Flow::SystemCall) return {vm::Answer::Taken, 0, nullptr};
        return {};
      case 3:
        if (random.one_in(10)) return {vm::Answer::Fault, kHostFault, "by chance"};
        return {};
      default: return {};
    }
  }
};

class Session {
 public:
  Session(const vm::VerifiedImage& program, uint64_t seed)
      : host_{Pcg(seed)},
        machine_(program, {&host_, RandomHost::execute, RandomHost::cancel}),
        limits_(program.limits()) {
    starts_.resize(program.code().size());
    for (uint32_t at = 0; at < program.code().size(); at += vm::decode(program.code(), at).words)
      starts_[at] = true;
  }

  uint64_t run(uint32_t piece) {
    // Small numbers, so that structures of interrupts make sense now and then.
    for (int32_t& h : machine_.variables()) h = host_.random.below(13) - 1;
    machine_.start();
    for (int round = 0; round < kRounds && machine_.fault().number == 0; ++round) {
      for (int task = 1; task <= vm::kTasks; ++task) run_task(task, piece);
      for (int context = 1; context <= vm::kContexts; ++context)
        if (host_.random.one_in(2) || machine_.context(context).state == TaskState::Waiting) resume(context);
      for (int n = host_.random.below(4); n > 0; --n)
        machine_.raise_event(static_cast<vm::Event>(host_.random.below(vm::kEvents)));
      if (limits_.variables > vm::kVarIntReq && host_.random.one_in(2))
        machine_.variables()[vm::kVarIntReq] = static_cast<int32_t>(host_.random.next());
      machine_.tick();
      check_tasks();
      for (int context = vm::kTasks + 1; context <= vm::kContexts; ++context)
        begun +=
            machine_.context(context).state == TaskState::Ready && machine_.context(context).commands == 0;
    }
    return digest();
  }

 private:
  // Also answers that nobody waits for: they must have no effect.
  void resume(int context) {
    const vm::TaskContext before = machine_.context(context);
    const bool waits = before.state == TaskState::Waiting && before.wait_ms == 0;
    require(waits == host_.asked_to_wait[static_cast<size_t>(context)],
            "who waits for the host has asked it");
    host_.asked_to_wait[static_cast<size_t>(context)] = false;
    machine_.resume(context);
    const vm::TaskContext& after = machine_.context(context);
    require(waits ? after.state == TaskState::Ready : after.state == before.state && after.pc == before.pc,
            "an answer ends the wait for the host, and nothing else");
  }

  void run_task(int task, uint32_t piece) {
    for (uint32_t done = 0; done < kCommandsARound;) {
      const uint32_t budget = std::min(piece, kCommandsARound - done);
      const vm::RunResult result = machine_.run(task, budget);
      require(result.commands <= budget, "run executes no more commands than its budget");
      done += result.commands;
      check_tasks();
      const TaskState state = machine_.context(machine_.active_context(task)).state;
      switch (result.stop) {
        case vm::Stop::Budget:
          require(result.commands == budget, "Budget means that the budget is used up");
          require(state == TaskState::Ready, "a task stopped by its budget can go on");
          continue;
        case vm::Stop::Waiting:
          require(state == TaskState::Waiting, "Waiting means that the task waits");
          return;
        case vm::Stop::Ended:
          require(state == TaskState::Stopped, "Ended means that the task has ended");
          return;
        case vm::Stop::Faulted: check_fault(); return;
      }
    }
  }

  void check_tasks() const {
    for (int context = 1; context <= vm::kContexts; ++context) {
      const vm::TaskContext& t = machine_.context(context);
      require(t.depth <= limits_.call_depth && t.depth <= vm::kMaxCallDepth,
              "calls stay within the depth of the unit");
      if (t.state == TaskState::Stopped) continue;
      require(starts(t.pc), "a context stands at the start of a command");
      for (size_t n = 0; n < t.depth; ++n)
        require(starts(t.calls[n]), "calls return to the start of a command");
      require(context <= vm::kTasks ? t.task == context && t.rank == 0 : t.rank > 0,
              "a routine stands above its task");
      require(machine_.task(t.task).state != TaskState::Stopped, "a stopped task has no routine");
    }
  }
  bool starts(uint32_t address) const { return address < starts_.size() && starts_[address]; }

  void check_fault() const {
    const vm::Fault& fault = machine_.fault();
    require(fault.number == 10 || fault.number == 32 || fault.number == kHostFault,
            "a fault has a known number");
    require(fault.reason != nullptr && starts(fault.address), "a fault has a reason and a command");
    for (int context = 1; context <= vm::kContexts; ++context)
      require(machine_.context(context).state == TaskState::Stopped, "a fault stops all tasks and routines");
  }

  uint64_t digest() const {
    uint64_t hash = 14695981039346656037U;
    const auto add = [&](uint64_t value) { hash = (hash ^ value) * 1099511628211U; };
    for (const int32_t value : machine_.variables()) add(static_cast<uint32_t>(value));
    for (int context = 1; context <= vm::kContexts; ++context) {
      const vm::TaskContext& t = machine_.context(context);
      add(static_cast<uint64_t>(t.state));
      add(t.depth);
      add(t.pc);
      add(t.wait_ms);
      add(t.commands);
    }
    add(machine_.fault().number);
    add(machine_.fault().address);
    return hash;
  }

  RandomHost host_;
  Machine machine_;
  vm::Limits limits_;
  std::vector<bool> starts_;
};

}  // namespace

std::optional<vm::Limits> limits_of(uint8_t unit) {
  const stdlib::UnitType* row = stdlib::find_unit(unit);
  if (row == nullptr) return std::nullopt;
  return vm::Limits{row->variables, row->program_words, row->tasks, row->call_depth};
}

void check_round_trips(const vm::Image& image) {
  const vm::ImageResult read = vm::read_image(vm::write_image(image));
  require(read.error == vm::ImageError::None && read.image == image,
          "a written image is read as the same image");
  compiler::SourceMap map;
  compiler::Diagnostics diagnostics;
  const auto again = compiler::assemble(map.add("image", "", compiler::disassemble(image)), diagnostics);
  require(again.has_value(), "a disassembled image can be assembled");
  require(*again == image, "the assembled image is the disassembled one");
}

uint64_t routines_begun() { return begun; }

uint64_t run_program(const vm::VerifiedImage& program, uint64_t seed, uint32_t piece) {
  return Session(program, seed).run(piece);
}

void check_execution(const vm::VerifiedImage& program, uint64_t seed) {
  require(run_program(program, seed, kCommandsARound) == run_program(program, seed, 1),
          "single steps lead to the same state");
}

}  // namespace ipos::tests
