// Commands that work on variables, for x86-64.
#include <bit>

#include "vm/context/arithmetic.hpp"
#include "vm/jit/reciprocal.hpp"
#include "vm/jit/x86_64/emitter.hpp"

namespace ipos::vm::jit {
namespace {

using asmjit::Imm;
using Id = x86::Inst::Id;

}  // namespace

bool EmitterX86::fused(const Instruction& first, const Instruction& second) {
  return set_and_operate(first, second) || accumulate(first, second);
}

// Two sums on the same variable, as a = a + b - c: they meet first, so that a, which waits for the round of
// the loop before, is added once.
bool EmitterX86::accumulate(const Instruction& first, const Instruction& second) {
  const auto adds = [](const Instruction& command) { return command.opcode == Opcode::AddHH; };
  const auto sums = [&](const Instruction& command) {
    return adds(command) || command.opcode == Opcode::SubHH;
  };
  const int32_t a = first.operands[0];
  if (!sums(first) || !sums(second) || second.operands[0] != a) return false;
  const auto b = pin(first.operands[1]), c = pin(second.operands[1]);
  if (!pin(a) || !b || !c || b == pin(a) || c == pin(a)) return false;
  if (adds(first) == adds(second)) {
    a_.lea(x86::eax, x86::ptr(b->r64(), c->r64()));
  } else {
    a_.mov(x86::eax, adds(first) ? *b : *c);
    a_.sub(x86::eax, adds(first) ? *c : *b);
  }
  a_.emit(adds(first) || adds(second) ? Id::kIdAdd : Id::kIdSub, *pin(a), x86::eax);
  flags_of_ = a;
  return true;
}

// SET a = b and what works on a then.
bool EmitterX86::set_and_operate(const Instruction& first, const Instruction& second) {
  if (first.opcode != Opcode::SetHH || second.operands[0] != first.operands[0]) return false;
  const auto to = pin(first.operands[0]);
  const auto from = pin(first.operands[1]);
  if (!to || first.operands[0] == first.operands[1]) return false;
  const int32_t operand = second.operands[1];
  switch (second.opcode) {
    case Opcode::MulHK: multiply_constant(*to, first.operands[1], operand); return true;
    case Opcode::AddHK:
      if (from) a_.lea(*to, x86::ptr(from->r64(), operand));
      return from.has_value();
    case Opcode::SubHK:
      if (from) a_.lea(*to, x86::ptr(from->r64(), subtract(0, operand)));
      return from.has_value();
    case Opcode::AddHH: {
      const auto other = pin(operand);
      if (!from || !other || operand == first.operands[0]) return false;
      a_.lea(*to, x86::ptr(from->r64(), other->r64()));
      return true;
    }
    default: return false;
  }
}

void EmitterX86::data(uint32_t n) {
  const Instruction& command = program_.commands[n].instruction;
  const int32_t a = command.operands[0];
  const int32_t b = command.operands[1];
  switch (command.opcode) {
    case Opcode::SetHH: set(a, b); break;
    case Opcode::SetHK: a_.emit(Id::kIdMov, place(a), Imm(b)); break;
    case Opcode::NotH:
      set(a, b);
      a_.emit(Id::kIdNot, place(a));
      break;
    case Opcode::AddHH: alu(Id::kIdAdd, a, command, false); break;
    case Opcode::SubHH: alu(Id::kIdSub, a, command, false); break;
    case Opcode::AndHH: alu(Id::kIdAnd, a, command, false); break;
    case Opcode::OrHH: alu(Id::kIdOr, a, command, false); break;
    case Opcode::XorHH: alu(Id::kIdXor, a, command, false); break;
    case Opcode::AddHK: alu(Id::kIdAdd, a, command, true); break;
    case Opcode::SubHK: alu(Id::kIdSub, a, command, true); break;
    case Opcode::AndHK: alu(Id::kIdAnd, a, command, true); break;
    case Opcode::OrHK: alu(Id::kIdOr, a, command, true); break;
    case Opcode::XorHK: alu(Id::kIdXor, a, command, true); break;
    case Opcode::MulHH: multiply(a, command, false); break;
    case Opcode::MulHK: multiply(a, command, true); break;
    case Opcode::ShlHH: shift(Id::kIdShl, a, command, false); break;
    case Opcode::ShrHH: shift(Id::kIdShr, a, command, false); break;
    case Opcode::AshrHH: shift(Id::kIdSar, a, command, false); break;
    case Opcode::ShlHK: shift(Id::kIdShl, a, command, true); break;
    case Opcode::ShrHK: shift(Id::kIdShr, a, command, true); break;
    case Opcode::AshrHK: shift(Id::kIdSar, a, command, true); break;
    case Opcode::DivHH: divide(n, true); break;
    case Opcode::ModHH: divide(n, false); break;
    case Opcode::DivHK: divide_constant(command, true); break;
    case Opcode::ModHK: divide_constant(command, false); break;
    case Opcode::Copy: copy(command); break;
    case Opcode::SetiLoad: load(n); break;
    case Opcode::SetiStore: store(n); break;
    case Opcode::BitSet: a_.emit(Id::kIdOr, place(a), Imm(wrap(1U << b))); break;
    case Opcode::BitClear: a_.emit(Id::kIdAnd, place(a), Imm(wrap(~(1U << b)))); break;
    case Opcode::BitMove: move_bit(command, false); break;
    case Opcode::BitMoveNeg: move_bit(command, true); break;
    default: break;  // NOP
  }
}

void EmitterX86::set(int32_t to, int32_t from) {
  if (to == from) return;
  if (pin(to) || pin(from)) {
    a_.emit(Id::kIdMov, place(to), place(from));
  } else {
    a_.mov(x86::eax, memory(from));
    a_.mov(memory(to), x86::eax);
  }
}

void EmitterX86::alu(asmjit::InstId id, int32_t to, const Instruction& command, bool constant) {
  const int32_t b = command.operands[1];
  if (constant) {
    a_.emit(id, place(to), Imm(b));
  } else if (pin(to) || pin(b)) {
    a_.emit(id, place(to), place(b));
  } else {
    a_.mov(x86::eax, memory(b));
    a_.emit(id, place(to), x86::eax);
  }
  flags_of_ = to;
}

void EmitterX86::multiply(int32_t to, const Instruction& command, bool constant) {
  const x86::Gp result = pin(to).value_or(x86::eax);
  if (constant) {
    multiply_constant(result, to, command.operands[1]);
  } else {
    if (!pin(to)) a_.mov(result, memory(to));
    a_.emit(Id::kIdImul, result, place(command.operands[1]));
  }
  if (!pin(to)) a_.mov(memory(to), result);
}

void EmitterX86::multiply_constant(x86::Gp to, int32_t from, int32_t factor) {
  const auto source = pin(from);
  const auto move = [&] {
    if (source != to) a_.emit(Id::kIdMov, to, place(from));
  };
  if (source && (factor == 3 || factor == 5 || factor == 9)) {
    const uint32_t shift = factor == 3 ? 1 : factor == 5 ? 2 : 3;
    a_.lea(to, x86::ptr(source->r64(), source->r64(), shift));
  } else if (factor == -1) {
    move();
    a_.neg(to);
  } else if (std::has_single_bit(bits(factor))) {
    move();
    if (factor != 1) a_.shl(to, std::countr_zero(bits(factor)));
  } else {
    a_.emit(Id::kIdImul, to, place(from), Imm(factor));
  }
}

void EmitterX86::shift(asmjit::InstId id, int32_t to, const Instruction& command, bool constant) {
  if (constant) {
    const int32_t count = command.operands[1] & 31;
    if (count != 0) a_.emit(id, place(to), Imm(count));
  } else {
    a_.emit(Id::kIdMov, x86::ecx, place(command.operands[1]));
    a_.emit(id, place(to), x86::cl);
  }
}

// The divisor 0 is left to the engines; by -1 it is a negation, as the processor has no answer for the
// smallest number. edx may be a variable's: it rests on the stack.
void EmitterX86::divide(uint32_t n, bool quotient) {
  const Command& command = program_.commands[n];
  const int32_t a = command.instruction.operands[0];
  const asmjit::Label usual = a_.newLabel(), done = a_.newLabel();
  a_.emit(Id::kIdMov, x86::ecx, place(command.instruction.operands[1]));
  a_.test(x86::ecx, x86::ecx);
  a_.jz(exit(n, command.credit));
  a_.cmp(x86::ecx, -1);
  a_.jne(usual);
  if (quotient)
    a_.emit(Id::kIdNeg, place(a));
  else
    a_.emit(Id::kIdMov, place(a), Imm(0));
  a_.jmp(done);
  a_.bind(usual);
  a_.emit(Id::kIdMov, x86::eax, place(a));
  const bool in_use = pinned().size() == kPins.size();
  if (in_use) a_.push(x86::rdx);
  a_.cdq();
  a_.idiv(x86::ecx);
  a_.mov(x86::ecx, quotient ? x86::eax : x86::edx);
  if (in_use) a_.pop(x86::rdx);
  a_.emit(Id::kIdMov, place(a), x86::ecx);
  a_.bind(done);
}

void EmitterX86::divide_constant(const Instruction& command, bool quotient) {
  const int32_t a = command.operands[0];
  const int32_t divisor = command.operands[1];
  const uint32_t size = divisor < 0 ? 0U - bits(divisor) : bits(divisor);
  if (size == 1) {
    if (!quotient)
      a_.emit(Id::kIdMov, place(a), Imm(0));
    else if (divisor == -1)
      a_.emit(Id::kIdNeg, place(a));
    return;
  }
  const Reciprocal by(size);
  a_.emit(Id::kIdMovsxd, x86::rax, place(a));
  a_.mov(x86::ecx, by.factor);
  a_.imul(x86::rax, x86::rcx);
  a_.sar(x86::rax, by.power);
  a_.emit(Id::kIdMov, x86::ecx, place(a));
  a_.shr(x86::ecx, 31);
  a_.add(x86::eax, x86::ecx);
  if (divisor < 0) a_.neg(x86::eax);
  if (quotient) {
    a_.emit(Id::kIdMov, place(a), x86::eax);
  } else {
    a_.imul(x86::eax, x86::eax, divisor);
    a_.emit(Id::kIdSub, place(a), x86::eax);
  }
}

void EmitterX86::move_bit(const Instruction& command, bool inverted) {
  const int32_t a = command.operands[0];
  const int32_t bit = command.operands[1];
  a_.emit(Id::kIdMov, x86::eax, place(command.operands[2]));
  if (inverted) a_.not_(x86::eax);
  if (command.operands[3] != 0) a_.shr(x86::eax, command.operands[3]);
  a_.and_(x86::eax, 1);
  if (bit != 0) a_.shl(x86::eax, bit);
  a_.emit(Id::kIdAnd, place(a), Imm(wrap(~(1U << bit))));
  a_.emit(Id::kIdOr, place(a), x86::eax);
}

// A register with the number of a variable in memory; ecx when it was not in one.
x86::Gp EmitterX86::checked_index(uint32_t n, int32_t variable, const asmjit::Label& slow) {
  const Range range = range_for(n);
  const x86::Gp index = pin(variable).value_or(x86::ecx);
  if (!pin(variable)) a_.mov(index, memory(variable));
  if (in_range_) return index;
  if (range.first == 0) {
    a_.cmp(index, range.count);
  } else {
    a_.lea(x86::eax, x86::ptr(index.r64(), -static_cast<int32_t>(range.first)));
    a_.cmp(x86::eax, range.count);
  }
  a_.jae(slow);
  return index;
}

void EmitterX86::load(uint32_t n) {
  const auto& operands = program_.commands[n].instruction.operands;
  const Slow slow{a_.newLabel(), a_.newLabel(), n};
  const x86::Gp index = checked_index(n, operands[1], slow.label);
  const x86::Gp result = pin(operands[0]).value_or(x86::eax);
  a_.mov(result, indexed(index));
  if (!pin(operands[0])) a_.mov(memory(operands[0]), result);
  finish_access(slow);
}

void EmitterX86::store(uint32_t n) {
  const auto& operands = program_.commands[n].instruction.operands;
  const Slow slow{a_.newLabel(), a_.newLabel(), n};
  const x86::Gp index = checked_index(n, operands[0], slow.label);
  const x86::Gp value = pin(operands[1]).value_or(x86::eax);
  if (!pin(operands[1])) a_.mov(value, memory(operands[1]));
  a_.mov(indexed(index), value);
  finish_access(slow);
}

void EmitterX86::slow_access(const Slow& slow) {
  const Command& command = program_.commands[slow.command];
  const auto& operands = command.instruction.operands;
  const bool loads = command.instruction.opcode == Opcode::SetiLoad;
  a_.emit(Id::kIdMov, x86::eax, place(operands[loads ? 1 : 0]));
  a_.cmp(x86::eax, uint32_t{program_.limits.variables});
  a_.jae(exit(slow.command, command.credit));
  if (loads) {
    a_.call(load_any_);
    a_.emit(Id::kIdMov, place(operands[0]), x86::eax);
  } else {
    a_.emit(Id::kIdMov, x86::ecx, place(operands[1]));
    a_.call(store_any_);
  }
}

// eax is the number of the variable, then its value; ecx the value to be stored.
void EmitterX86::any_variable(bool stores) {
  const auto move = [&](const asmjit::Operand& variable) {
    if (stores)
      a_.emit(Id::kIdMov, variable, x86::ecx);
    else
      a_.emit(Id::kIdMov, x86::eax, variable);
    a_.ret();
  };
  std::vector<asmjit::Label> found(pinned().size());
  for (size_t n = 0; n < found.size(); ++n) {
    found[n] = a_.newLabel();
    a_.cmp(x86::eax, uint32_t{pinned()[n]});
    a_.je(found[n]);
  }
  move(indexed(x86::eax));
  for (size_t n = 0; n < found.size(); ++n) {
    a_.bind(found[n]);
    move(kPins[n]);
  }
}

std::optional<x86::Gp> EmitterX86::pin(int32_t variable) const {
  const int number = pin_of(variable);
  if (number < 0) return std::nullopt;
  return kPins[static_cast<size_t>(number)];
}

x86::Mem EmitterX86::memory(int32_t variable) const { return x86::dword_ptr(h_, variable * 4); }

asmjit::Operand EmitterX86::place(int32_t variable) const {
  if (const auto reg = pin(variable)) return *reg;
  return memory(variable);
}

}  // namespace ipos::vm::jit
