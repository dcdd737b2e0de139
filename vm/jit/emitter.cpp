// The order of the code, see emitter.hpp.
#include "vm/jit/emitter.hpp"

#include <algorithm>
#include <cassert>

#include "vm/context/arithmetic.hpp"
#include "vm/isa/effects.hpp"

namespace ipos::vm::jit {
namespace {

using asmjit::Label;

constexpr uint32_t kLoopAlignment = 32;
constexpr uint32_t kShortestSwitch = 4;

// Whether a comparison with a constant jumps; nothing for other commands.
std::optional<bool> holds(Opcode opcode, int32_t value, int32_t constant) {
  switch (opcode) {
    case Opcode::JmpEqHK: return value == constant;
    case Opcode::JmpNeHK: return value != constant;
    case Opcode::JmpLtHK: return value < constant;
    case Opcode::JmpLeHK: return value <= constant;
    case Opcode::JmpGtHK: return value > constant;
    case Opcode::JmpGeHK: return value >= constant;
    default: return std::nullopt;
  }
}

bool sets(const Instruction& command, int32_t variable) {
  return named_target(command).has(static_cast<uint32_t>(variable));
}

}  // namespace

Emitter::Emitter(const Program& program, asmjit::BaseAssembler& assembler, Unwind unwind, size_t registers)
    : program_(program),
      unwind_(unwind),
      leave_(assembler.newLabel()),
      load_any_(assembler.newLabel()),
      store_any_(assembler.newLabel()),
      returned_(assembler.newLabel()),
      a_(assembler),
      pinned_(hottest_variables(program, registers)),
      pin_of_(program.limits.variables, -1) {
  out_.entries.resize(program.index.size());
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

bool Emitter::run(Emitted& out) {
  assert(labels_.empty());  // once
  asmjit::Error error = asmjit::kErrorOk;
  struct Handler : asmjit::ErrorHandler {
    void handleError(asmjit::Error code, const char*, asmjit::BaseEmitter*) override { *first = code; }
    asmjit::Error* first;
  } handler;
  handler.first = &error;
  a_.setErrorHandler(&handler);

  const auto size = static_cast<uint32_t>(program_.commands.size());
  labels_.resize(size);
  for (uint32_t n = 0; n < size; ++n)
    if (program_.commands[n].joins) labels_[n] = a_.newLabel();
  enter();
  for (uint32_t n = 0; n < size;) n += command(n);
  slow_paths();
  unchecked_loops();
  exit_paths();
  leave();
  for (const bool stores : {true, false}) {
    a_.bind(stores ? store_any_ : load_any_);
    any_variable(stores);
  }
  returns_to_context();
  tables();
  a_.setErrorHandler(nullptr);
  out = std::move(out_);
  return error == asmjit::kErrorOk;
}

Label Emitter::exit(uint32_t n, int32_t credit) {
  const Label label = a_.newLabel();
  exits_.push_back({label, program_.commands[n].at, credit});
  return label;
}

// In front of a command: its label, the check of the budget, the entry.
void Emitter::begin(uint32_t n) {
  assert(n < program_.commands.size());
  const Command& command = program_.commands[n];
  if (command.joins) {
    if (command.checks && !command.called) a_.align(asmjit::AlignMode::kCode, kLoopAlignment);
    flags_of_ = -1;
  }
  if (labels_[n].isValid()) a_.bind(labels_[n]);
  leave_checks_out(n);
  if (command.checks && command.native) check(command.need - command.arrival, exit(n, command.need));
}

// At the beginning of a loop: a way to the same without checks, taken when all its indexes will be good.
void Emitter::leave_checks_out(uint32_t first) {
  const auto loop = counted_loop(program_, first);
  if (!loop || std::any_of(loop->fixed.begin(), loop->fixed.end(), [&](int32_t v) { return pin_of(v) < 0; }))
    return;
  const Range range = range_for(*loop->access);
  const auto doubts = loop->doubts(range.first, range.count);
  if (!doubts) return;
  const Label checked = a_.newLabel();
  for (const Instruction& doubt : *doubts) jump_if(doubt, checked);
  unchecked_.push_back({a_.newLabel(), *loop});
  label_of(loop->last + 1);
  jump_to(unchecked_.back().label);
  a_.align(asmjit::AlignMode::kCode, kLoopAlignment);
  a_.bind(checked);
}

void Emitter::unchecked_loops() {
  in_range_ = true;
  for (const auto& [label, loop] : unchecked_) {
    const Command& first = program_.commands[loop.first];
    a_.align(asmjit::AlignMode::kCode, kLoopAlignment);
    a_.bind(label);
    check(first.need - first.arrival, exit(loop.first, first.need));
    for (uint32_t n = loop.first; n < loop.last;) n += next(n);
    branch(program_.commands[loop.last], loop.last, label);
    jump_to(labels_[loop.last + 1]);
  }
  in_range_ = false;
}

// A command on variables, with the one after it where two make one. Returns how many.
uint32_t Emitter::next(uint32_t n) {
  const Command& behind = program_.commands[n + 1];
  flags_of_ = -1;
  if (behind.native && !behind.joins && fused(program_.commands[n].instruction, behind.instruction)) return 2;
  data(n);
  return 1;
}

// Returns how many commands it has taken.
uint32_t Emitter::command(uint32_t n) {
  const Command& command = program_.commands[n];
  begin(n);
  if (!command.native) {
    jump_to(exit(n, command.credit_of_arrival()));
    return 1;
  }
  const bool test_only = command.flow == Flow::Branch && flags_of_ == command.instruction.operands[0] &&
                         tests_flags(command.instruction);
  if (!test_only)
    out_.entries[command.at] = {static_cast<uint32_t>(a_.offset()), static_cast<uint16_t>(command.credit)};
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
      branch(command, n, labels_[command.target]);
      return 1;
    default: taken = next(n);
  }
  correct(program_.correction(program_.commands[n + taken - 1], program_.commands[n + taken]));
  return taken;
}

void Emitter::jump(uint32_t n) {
  const Command& command = program_.commands[n];
  const uint32_t last = command.target > n + 1 ? end_of_short_line(command.target) : kNowhere;
  if (last != kNowhere) {
    repeat(n, last);
  } else if (const auto decided = decide(known_at(n), command.target)) {
    jump_decided(n, command, *decided);
  } else {
    correct(program_.correction(command, program_.commands[command.target]));
    if (command.target != n + 1) jump_to(labels_[command.target]);
  }
}

// The last command of a line so short that it is better repeated than jumped to: the end of a loop, or a RET.
uint32_t Emitter::end_of_short_line(uint32_t first) const {
  constexpr uint32_t kShort = 4;
  for (uint32_t n = first; n < first + kShort; ++n) {
    const Command& command = program_.commands[n];
    if (!command.native || command.checks || (n != first && command.joins)) break;
    if (command.flow == Flow::Return || (command.flow == Flow::Branch && command.target <= n)) return n;
    if (command.flow != Flow::Next || can_fault(command.instruction)) break;
  }
  return kNowhere;
}

// What the line a jump leads to does, up to its last command.
void Emitter::repeat(uint32_t jump, uint32_t last) {
  const Command& from = program_.commands[jump];
  std::optional<Known> known = known_at(jump);
  flags_of_ = -1;
  for (uint32_t n = from.target; n < last; ++n) {
    data(n);
    if (known && sets(program_.commands[n].instruction, known->variable)) known.reset();
  }
  Command end = program_.commands[last];
  end.credit = from.credit - 1 - static_cast<int32_t>(last - from.target);
  if (end.flow == Flow::Return) return ret(end);
  if (const auto decided = decide(known, end.target)) {
    const int32_t straight = program_.correction(end, program_.commands[last + 1]);
    Label out = label_of(last + 1);
    if (straight != 0) out = detours_.emplace_back(Detour{a_.newLabel(), out, straight}).label;
    Instruction leaves = end.instruction;
    leaves.opcode = inverse(leaves.opcode);
    jump_if(leaves, out);
    jump_decided(jump, end, *decided);
  } else {
    branch(end, last, labels_[end.target]);
    jump_to(label_of(last + 1));
  }
}

// A variable whose value is known when control reaches a command.
std::optional<Emitter::Known> Emitter::known_at(uint32_t n) const {
  if (n == 0 || program_.commands[n].joins) return std::nullopt;
  const Instruction& before = program_.commands[n - 1].instruction;
  if (before.opcode != Opcode::SetHK) return std::nullopt;
  return Known{before.operands[0], before.operands[1]};
}

// Where control gets to from a command on through tests of that variable, as in a loop around a switch whose
// case has just been set.
std::optional<Emitter::Decided> Emitter::decide(const std::optional<Known>& known, uint32_t to) const {
  constexpr uint32_t kMost = 64;
  if (!known) return std::nullopt;
  Decided out{to, 0, {}};
  std::vector<int32_t> same{known->variable};
  const auto is_same = [&](int32_t v) { return std::find(same.begin(), same.end(), v) != same.end(); };
  bool tested = false;
  for (; out.commands < kMost; ++out.commands) {
    const Command& command = program_.commands[out.end];
    const auto& operands = command.instruction.operands;
    if (!command.native || (out.commands != 0 && command.checks)) break;
    if (command.instruction.opcode == Opcode::SetHH && is_same(operands[1])) {
      out.sets.push_back(out.end++);
      same.push_back(operands[0]);
      continue;
    }
    if (command.flow == Flow::Jump && tested) {
      out.end = command.target;
      continue;
    }
    const std::optional<bool> jumps = holds(command.instruction.opcode, known->value, operands[1]);
    if (!jumps || !is_same(operands[0])) break;
    tested = true;
    out.end = *jumps ? command.target : out.end + 1;
  }
  if (!tested || !program_.commands[out.end].joins) return std::nullopt;
  return out;
}

// After the command `jump`, which nobody may enter by itself: who did not come through the SET before it may
// find another value.
void Emitter::jump_decided(uint32_t jump, const Command& from, const Decided& decided) {
  out_.entries[program_.commands[jump].at] = {};
  Command last = program_.commands[from.target];
  correct(program_.correction(from, last));
  if (last.checks) check(last.need - last.arrival, exit(from.target, last.need));
  for (const uint32_t n : decided.sets) data(n);
  last.credit -= static_cast<int32_t>(decided.commands) - 1;
  correct(program_.correction(last, program_.commands[decided.end]));
  jump_to(labels_[decided.end]);
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
  jump_by_table(operands[0], operands[1], count, table.label, other);
  for (uint32_t at = n; at < n + count; ++at) {
    const Command& command = program_.commands[at];
    const int32_t by = program_.correction(command, program_.commands[command.target]);
    table.cases.push_back(by == 0 ? labels_[command.target] : a_.newLabel());
    if (by == 0) continue;
    a_.bind(table.cases.back());
    correct(by);
    jump_to(labels_[command.target]);
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
void Emitter::branch(const Command& command, uint32_t n, const Label& to) {
  const int32_t taken = program_.correction(command, program_.commands[command.target]);
  const int32_t straight = program_.correction(command, program_.commands[n + 1]);
  const bool leaves = program_.commands[command.target].depth < command.depth;
  if (taken != 0 && leaves) {
    detours_.push_back({a_.newLabel(), to, taken});
    jump_if(command.instruction, detours_.back().label);
    correct(straight);
  } else {
    correct_with_result(taken);
    jump_if(command.instruction, to);
    correct(straight - taken);
  }
  flags_of_ = -1;
}

void Emitter::call(uint32_t n) {
  const Command& command = program_.commands[n];
  check_calls(exit(n, command.credit));
  correct(program_.correction(command, program_.commands[command.target]));
  call_to(labels_[command.target]);
  out_.returns.push_back({static_cast<uint32_t>(a_.offset()), program_.commands[n + 1].at});
}

void Emitter::ret(const Command& command) {
  correct(command.credit - 1);
  return_from(command.at);
}

Label Emitter::label_of(uint32_t n) {
  if (!labels_[n].isValid()) labels_[n] = a_.newLabel();
  return labels_[n];
}

void Emitter::exit_paths() {
  for (const Detour& detour : detours_) {
    a_.bind(detour.label);
    correct(detour.by);
    jump_to(detour.target);
  }
  for (const Exit& exit : exits_) {
    a_.bind(exit.label);
    correct(exit.credit);
    leave_at(exit.at);
  }
}

// An index that leads beside the expected range, which may be a variable in a register, or to none.
void Emitter::slow_paths() {
  for (const Slow& slow : slow_) {
    a_.bind(slow.label);
    slow_access(slow);
    jump_to(slow.back);
  }
}

void Emitter::finish_access(const Slow& slow) {
  if (in_range_) return;
  a_.bind(slow.back);
  slow_.push_back(slow);
}

// Where both blocks overlap, from the end that is not overwritten before it is read.
void Emitter::copy(const Instruction& command) {
  const int32_t to = command.operands[0], from = command.operands[1], count = command.operands[2];
  for (int32_t n = 0; n < count; ++n) {
    const int32_t at = to < from ? n : count - 1 - n;
    set(to + at, from + at);
  }
}

// The range of variables in memory an index most likely leads to: the one that has the table, or begins behind variables of
// the table that have a register; where nothing tells, the longest.
Emitter::Range Emitter::range_for(uint32_t n) const {
  const int32_t table = program_.commands[n].table;
  Range longest{0, 0};
  for (const Range& range : ranges_) {
    if (table >= 0 && bits(table) < range.first + range.count) return range;
    if (range.count > longest.count) longest = range;
  }
  return longest;
}

void Emitter::table_of_returns(const Label& table, const Label& none) {
  a_.align(asmjit::AlignMode::kData, 4);
  a_.bind(table);
  for (const uint32_t n : program_.index)
    a_.embedLabelDelta(
        n != kNowhere && program_.commands[n].called && labels_[n].isValid() ? labels_[n] : none, table, 4);
}

}  // namespace ipos::vm::jit
