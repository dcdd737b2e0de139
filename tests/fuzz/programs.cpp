// The host keeps to its contract (vm/host/host.hpp) and is otherwise as unpleasant as it may be: it waits,
// faults, starts and stops tasks, also its own, and writes variables.
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

struct RandomHost {
  Pcg random;

  static vm::HostReply execute(void* self, Machine& machine, int task,
                               const vm::Instruction& command) noexcept {
    return static_cast<RandomHost*>(self)->answer(machine, task, command);
  }

  vm::HostReply answer(Machine& machine, int task, const vm::Instruction& command) {
    if (command.opcode == vm::Opcode::Task || command.opcode == vm::Opcode::Task2) {
      const int other = command.opcode == vm::Opcode::Task ? 3 : 2;
      if (command.operands[0] != 0)
        machine.start_task(other, static_cast<uint32_t>(command.operands[1]));
      else
        machine.stop_task(other);
      return {};
    }
    const auto variables = machine.variables();
    if (random.one_in(4))
      variables[static_cast<size_t>(random.below(static_cast<int>(variables.size())))] =
          static_cast<int32_t>(random.next());
    if (random.one_in(40)) machine.stop_task(task);
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
      : host_{Pcg(seed)}, machine_(program, {&host_, RandomHost::execute}), limits_(program.limits()) {
    starts_.resize(program.code().size());
    for (uint32_t at = 0; at < program.code().size(); at += vm::decode(program.code(), at).words)
      starts_[at] = true;
  }

  uint64_t run(uint32_t piece) {
    machine_.start();
    for (int round = 0; round < kRounds && machine_.fault().number == 0; ++round) {
      for (int task = 1; task <= vm::kTasks; ++task) run_task(task, piece);
      for (int task = 1; task <= vm::kTasks; ++task) {
        const vm::TaskContext& t = machine_.task(task);
        if (t.state == TaskState::Waiting && (t.wait_ms == 0 || host_.random.one_in(8)))
          machine_.resume(task);
      }
      machine_.tick();
      check_tasks();
    }
    return digest();
  }

 private:
  void run_task(int task, uint32_t piece) {
    for (uint32_t done = 0; done < kCommandsARound;) {
      const uint32_t budget = std::min(piece, kCommandsARound - done);
      const vm::RunResult result = machine_.run(task, budget);
      require(result.commands <= budget, "run executes no more commands than its budget");
      done += result.commands;
      check_tasks();
      const TaskState state = machine_.task(task).state;
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
    for (int task = 1; task <= vm::kTasks; ++task) {
      const vm::TaskContext& t = machine_.task(task);
      require(t.depth <= limits_.call_depth && t.depth <= vm::kMaxCallDepth,
              "calls stay within the depth of the unit");
      if (t.state != TaskState::Stopped) require(starts(t.pc), "a task stands at the start of a command");
      for (size_t n = 0; n < t.depth; ++n)
        require(starts(t.calls[n]), "calls return to the start of a command");
    }
  }
  bool starts(uint32_t address) const { return address < starts_.size() && starts_[address]; }

  void check_fault() const {
    const vm::Fault& fault = machine_.fault();
    require(fault.number == 10 || fault.number == 32 || fault.number == kHostFault,
            "a fault has a known number");
    require(fault.reason != nullptr && starts(fault.address), "a fault has a reason and a command");
    for (int task = 1; task <= vm::kTasks; ++task)
      require(machine_.task(task).state == TaskState::Stopped, "a fault stops all tasks");
  }

  uint64_t digest() const {
    uint64_t hash = 14695981039346656037U;
    const auto add = [&](uint64_t value) { hash = (hash ^ value) * 1099511628211U; };
    for (const int32_t value : machine_.variables()) add(static_cast<uint32_t>(value));
    for (int task = 1; task <= vm::kTasks; ++task) {
      const vm::TaskContext& t = machine_.task(task);
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

// An operand that the verifier accepts; labels are numbers of commands at first.
int32_t operand(Input& input, const vm::OperandInfo& row, uint32_t commands) {
  switch (row.kind) {
    case vm::OperandKind::Variable: return static_cast<int32_t>(input.below(960));
    case vm::OperandKind::Bit: return input.u8() % 32;
    case vm::OperandKind::Count: return 1 + input.u8() % 64;
    case vm::OperandKind::Constant: return input.u8() % 2 == 0 ? input.i32() : input.u8() - 20;
    case vm::OperandKind::Label: return static_cast<int32_t>(input.below(commands + 1));
    case vm::OperandKind::Keyword: {
      std::vector<int32_t> values;
      for (const vm::KeywordInfo& keyword : vm::keyword_table())
        if (keyword.set == row.keyword_set) values.push_back(keyword.value);
      return values[input.u8() % values.size()];
    }
    case vm::OperandKind::None: break;
  }
  return 0;
}

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

uint64_t run_program(const vm::VerifiedImage& program, uint64_t seed, uint32_t piece) {
  return Session(program, seed).run(piece);
}

void check_execution(const vm::VerifiedImage& program, uint64_t seed) {
  require(run_program(program, seed, kCommandsARound) == run_program(program, seed, 1),
          "single steps lead to the same state");
}

std::vector<uint32_t> valid_code(Input& input) {
  std::vector<vm::Instruction> commands;
  const uint32_t count = 1 + input.u8() % 64;
  for (uint32_t n = 0; n < count; ++n) {
    vm::Instruction command;
    const vm::OpcodeInfo& row = vm::opcode_table()[input.u8() % vm::opcode_table().size()];
    command.opcode = row.opcode;
    for (size_t k = 0; k < static_cast<size_t>(row.operand_count); ++k)
      command.operands[k] = operand(input, row.operands[k], count);
    commands.push_back(command);
  }
  commands.push_back({vm::Opcode::End, {}});

  std::vector<int32_t> addresses;
  int32_t next = 0;
  for (const vm::Instruction& command : commands) {
    addresses.push_back(next);
    next += vm::info(command.opcode).words;
  }
  std::vector<uint32_t> code;
  for (vm::Instruction& command : commands) {
    const vm::OpcodeInfo& row = vm::info(command.opcode);
    for (size_t k = 0; k < static_cast<size_t>(row.operand_count); ++k)
      if (row.operands[k].kind == vm::OperandKind::Label)
        command.operands[k] = addresses[static_cast<size_t>(command.operands[k])];
    std::array<uint32_t, vm::kMaxWords> words{};
    const uint32_t length = vm::encode(command, words);
    code.insert(code.end(), words.begin(), words.begin() + length);
  }
  return code;
}

}  // namespace ipos::tests
