// Control: order of the code, budget, jumps, calls and exits.
#include "vm/jit/emitter.hpp"

#include "vm/exec/arithmetic.hpp"

namespace ipos::vm::jit {
namespace {

using asmjit::Label;

constexpr uint32_t kLoopAlignment = 32;
constexpr uint32_t kShortestSwitch = 4;

x86::CondCode condition_of(Opcode opcode) {
  switch (opcode) {
    case Opcode::JmpEqHH:
    case Opcode::JmpEqHK: return x86::CondCode::kE;
    case Opcode::JmpNeHH:
    case Opcode::JmpNeHK: return x86::CondCode::kNE;
    case Opcode::JmpLtHH:
    case Opcode::JmpLtHK: return x86::CondCode::kL;
    case Opcode::JmpLeHH:
    case Opcode::JmpLeHK: return x86::CondCode::kLE;
    case Opcode::JmpGtHH:
    case Opcode::JmpGtHK: return x86::CondCode::kG;
    default: return x86::CondCode::kGE;
  }
}

// The condition after an operation with this result instead of a comparison with 0; none where the flags do
// not tell it.
std::optional<x86::CondCode> condition_of_result(const Instruction& command) {
  if (command.operands[1] != 0) return std::nullopt;
  switch (command.opcode) {
    case Opcode::JmpEqHK: return x86::CondCode::kZ;
    case Opcode::JmpNeHK: return x86::CondCode::kNZ;
    case Opcode::JmpLtHK: return x86::CondCode::kS;
    case Opcode::JmpGeHK: return x86::CondCode::kNS;
    default: return std::nullopt;
  }
}

bool has_constant(const Instruction& command) {
  return info(command.opcode).operands[1].kind == OperandKind::Constant;
}

bool has_exit(Opcode opcode) {
  return opcode == Opcode::SetiLoad || opcode == Opcode::SetiStore || opcode == Opcode::DivHH ||
         opcode == Opcode::ModHH;
}

}  // namespace

Emitter::Emitter(const Program& program, asmjit::CodeHolder& code, Unwind unwind)
    : entries(program.index.size()),
      program_(program),
      a_(&code),
      unwind_(unwind),
      pinned_(hottest_variables(program, kPins.size())),
      pin_of_(program.limits.variables, -1),
      leave_(a_.newLabel()),
      store_pins_(a_.newLabel()),
      load_pins_(a_.newLabel()),
      returned_(a_.newLabel()) {
  for (size_t n = 0; n < pinned_.size(); ++n) pin_of_[pinned_[n]] = static_cast<int8_t>(n);
  choose_ranges();
}

void Emitter::choose_ranges() {
  uint32_t first = 0;
  for (uint32_t n = 0; n <= program_.limits.variables; ++n) {
    if (n != program_.limits.variables && pin_of_[n] < 0) continue;
    if (n != first) ranges_.push_back({first, n - first});
    first = n + 1;
  }
}

bool Emitter::run() {
  asmjit::Error error = asmjit::kErrorOk;
  struct Handler : asmjit::ErrorHandler {
    void handleError(asmjit::Error code, const char*, asmjit::BaseEmitter*) override { *first = code; }
    asmjit::Error* first;
  } handler;
  handler.first = &error;
  a_.setErrorHandler(&handler);
  a_.addEncodingOptions(asmjit::EncodingOptions::kOptimizedAlign);  // one long NOP instead of many

  const auto size = static_cast<uint32_t>(program_.commands.size());
  labels_.resize(size);
  for (uint32_t n = 0; n < size; ++n)
    if (program_.commands[n].joins) labels_[n] = a_.newLabel();
  enter();
  for (uint32_t n = 0; n < size;) n += command(n);
  slow_paths();
  exit_paths();
  leave();
  for (const bool stores : {true, false}) {
    a_.bind(stores ? store_pins_ : load_pins_);
    move_pins(stores);
    a_.ret();
  }
  returns_to_context();
  tables();
  a_.setErrorHandler(nullptr);
  return error == asmjit::kErrorOk;
}

void Emitter::correct(int32_t by) {
  if (by != 0) a_.add(number_, by);
}

Label Emitter::exit(uint32_t n, int32_t credit) {
  const Label label = a_.newLabel();
  exits_.push_back({label, program_.commands[n].at, credit});
  return label;
}

// In front of a command: its label, the check of the budget, the entry.
void Emitter::begin(uint32_t n) {
  const Command& command = program_.commands[n];
  if (command.joins) {
    if (command.checks && !command.called) a_.align(asmjit::AlignMode::kCode, kLoopAlignment);
    flags_of_ = -1;
  }
  if (labels_[n].isValid()) a_.bind(labels_[n]);
  if (command.checks && command.native) {
    const int32_t charge = command.need - command.arrival;
    if (charge != 0)
      a_.sub(number_, charge);
    else
      a_.test(number_, number_);
    a_.js(exit(n, command.need));
  }
}

// Returns how many commands it has taken.
uint32_t Emitter::command(uint32_t n) {
  const Command& command = program_.commands[n];
  begin(n);
  if (!command.native) {
    a_.jmp(exit(n, command.credit_of_arrival()));
    return 1;
  }
  const bool test_only = command.flow == Flow::Branch && flags_of_ == command.instruction.operands[0] &&
                         condition_of_result(command.instruction);
  if (!test_only)
    entries[command.at] = {static_cast<uint32_t>(a_.offset()), static_cast<uint16_t>(command.credit)};
  uint32_t taken = 1;
  switch (command.flow) {
    case Flow::Jump: jump(n); return 1;
    case Flow::Call: call(n); return 1;
    case Flow::Return: ret(command); return 1;
    case Flow::Branch:
      taken = cases(n);
      if (taken >= kShortestSwitch) {
        jump_to_case(n, taken);
        break;
      }
      branch(command, n);
      return 1;
    default:
      flags_of_ = -1;
      if (!program_.commands[n + 1].joins && fused(command.instruction, program_.commands[n + 1].instruction))
        taken = 2;
      else
        data(n);
  }
  correct(program_.correction(program_.commands[n + taken - 1], program_.commands[n + taken]));
  return taken;
}

void Emitter::jump(uint32_t n) {
  const Command& command = program_.commands[n];
  const uint32_t last = command.target > n + 1 ? end_of_short_line(command.target) : kNowhere;
  if (last != kNowhere) {
    repeat(command.target, last, command.credit - 1);
  } else {
    correct(program_.correction(command, program_.commands[command.target]));
    if (command.target != n + 1) a_.jmp(labels_[command.target]);
  }
}

// The last command of a line so short that it is better repeated than jumped to: the end of a loop, or a RET.
uint32_t Emitter::end_of_short_line(uint32_t first) const {
  constexpr uint32_t kShort = 4;
  for (uint32_t n = first; n < first + kShort; ++n) {
    const Command& command = program_.commands[n];
    if (!command.native || command.checks || (n != first && command.joins)) break;
    if (command.flow == Flow::Return || (command.flow == Flow::Branch && command.target <= n)) return n;
    if (command.flow != Flow::Next || has_exit(command.instruction.opcode)) break;
  }
  return kNowhere;
}

void Emitter::repeat(uint32_t first, uint32_t last, int32_t credit) {
  flags_of_ = -1;
  for (uint32_t n = first; n < last; ++n) data(n);
  Command end = program_.commands[last];
  end.credit = credit - static_cast<int32_t>(last - first);
  if (end.flow == Flow::Return) {
    ret(end);
  } else {
    branch(end, last);
    a_.jmp(label_of(last + 1));
  }
}

// Comparisons of one variable with constants that follow each other.
uint32_t Emitter::cases(uint32_t n) const {
  const auto& first = program_.commands[n].instruction;
  uint32_t count = 0;
  for (uint32_t at = n; at < program_.commands.size(); ++at, ++count) {
    const Command& command = program_.commands[at];
    const auto& operands = command.instruction.operands;
    if (command.instruction.opcode != Opcode::JmpEqHK || operands[0] != first.operands[0] ||
        bits(operands[1]) != bits(first.operands[1]) + count || (at != n && labels_[at].isValid()))
      break;
  }
  return count;
}

void Emitter::jump_to_case(uint32_t n, uint32_t count) {
  const auto& operands = program_.commands[n].instruction.operands;
  const Label other = a_.newLabel();
  Table table{a_.newLabel(), {}};
  a_.emit(x86::Inst::kIdMov, x86::eax, place(operands[0]));
  if (operands[1] != 0) a_.sub(x86::eax, operands[1]);
  a_.cmp(x86::eax, count);
  a_.jae(other);
  a_.lea(x86::rcx, x86::ptr(table.label));
  a_.jmp(x86::qword_ptr(x86::rcx, x86::rax, 3));
  for (uint32_t at = n; at < n + count; ++at) {
    const Command& command = program_.commands[at];
    const int32_t by = program_.correction(command, program_.commands[command.target]);
    table.cases.push_back(by == 0 ? labels_[command.target] : a_.newLabel());
    if (by == 0) continue;
    a_.bind(table.cases.back());
    correct(by);
    a_.jmp(labels_[command.target]);
  }
  a_.bind(other);
  tables_.push_back(std::move(table));
}

void Emitter::tables() {
  a_.align(asmjit::AlignMode::kData, 8);
  for (const Table& table : tables_) {
    a_.bind(table.label);
    for (const Label& label : table.cases) a_.embedLabel(label, 8);
  }
}

// Either way may need a correction. The one of the jump comes first and does not touch the flags, and the
// other takes it back; or it stands apart where the jump leaves a loop, which it does once.
void Emitter::branch(const Command& command, uint32_t n) {
  const int32_t taken = program_.correction(command, program_.commands[command.target]);
  const int32_t straight = program_.correction(command, program_.commands[n + 1]);
  const bool leaves = program_.commands[command.target].depth < command.depth;
  if (taken != 0 && !leaves) a_.lea(number_.r64(), x86::ptr(number_.r64(), taken));
  x86::CondCode condition = condition_of(command.instruction.opcode);
  const auto of_result = condition_of_result(command.instruction);
  if (flags_of_ == command.instruction.operands[0] && of_result)
    condition = *of_result;
  else
    compare(command.instruction, has_constant(command.instruction));
  if (taken != 0 && leaves) {
    detours_.push_back({a_.newLabel(), labels_[command.target], taken});
    a_.j(condition, detours_.back().label);
    correct(straight);
  } else {
    a_.j(condition, labels_[command.target]);
    correct(straight - taken);
  }
  flags_of_ = -1;
}

void Emitter::call(uint32_t n) {
  const Command& command = program_.commands[n];
  a_.test(x86::esp, kBlock - 1);
  a_.jz(exit(n, command.credit));
  correct(program_.correction(command, program_.commands[command.target]));
  a_.call(labels_[command.target]);
  returns.push_back({static_cast<uint32_t>(a_.offset()), program_.commands[n + 1].at});
}

void Emitter::ret(const Command& command) {
  correct(command.credit - 1);
  a_.mov(x86::eax, command.at);
  a_.ret();
}

Label Emitter::label_of(uint32_t n) {
  if (!labels_[n].isValid()) labels_[n] = a_.newLabel();
  return labels_[n];
}

void Emitter::exit_paths() {
  for (const Detour& detour : detours_) {
    a_.bind(detour.label);
    correct(detour.by);
    a_.jmp(detour.target);
  }
  for (const Exit& exit : exits_) {
    a_.bind(exit.label);
    correct(exit.credit);
    a_.mov(x86::eax, exit.at);
    a_.jmp(leave_);
  }
}

// An index that leads to a variable in a register, or to none.
void Emitter::slow_paths() {
  for (const Slow& slow : slow_) {
    const Command& command = program_.commands[slow.command];
    const auto& operands = command.instruction.operands;
    const bool loads = command.instruction.opcode == Opcode::SetiLoad;
    a_.bind(slow.label);
    a_.call(store_pins_);
    a_.mov(x86::eax, memory(operands[loads ? 1 : 0]));
    a_.cmp(x86::eax, uint32_t{program_.limits.variables});
    a_.jae(exit(slow.command, command.credit));
    if (loads) {
      a_.mov(x86::ecx, indexed(x86::eax));
      a_.mov(memory(operands[0]), x86::ecx);
    } else {
      a_.mov(x86::ecx, memory(operands[1]));
      a_.mov(indexed(x86::eax), x86::ecx);
    }
    a_.call(load_pins_);
    a_.jmp(slow.back);
  }
}

std::optional<x86::Gp> Emitter::pin(int32_t variable) const {
  const int8_t number = pin_of_[static_cast<size_t>(variable)];
  if (number < 0) return std::nullopt;
  return kPins[static_cast<size_t>(number)];
}

x86::Mem Emitter::memory(int32_t variable) const { return x86::dword_ptr(h_, variable * 4); }

asmjit::Operand Emitter::place(int32_t variable) const {
  if (const auto reg = pin(variable)) return *reg;
  return memory(variable);
}

}  // namespace ipos::vm::jit
