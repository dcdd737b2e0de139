// Commands that work on variables, for AArch64. Operations have two sources and a result, so that a SET and
// an operation on what it sets are always one.
#include <bit>

#include "vm/context/arithmetic.hpp"
#include "vm/jit/aarch64/emitter.hpp"
#include "vm/jit/reciprocal.hpp"

namespace ipos::vm::jit {

using a64::w0;
using a64::w1;
using a64::w2;
using asmjit::arm::lsl;
using asmjit::arm::lsr;

bool EmitterA64::fused(const Instruction& first, const Instruction& second) {
  return first.opcode == Opcode::SetHH && second.operands[0] == first.operands[0] &&
         operation(second, first.operands[1]);
}

void EmitterA64::data(uint32_t n) {
  const Instruction& command = program_.commands[n].instruction;
  const int32_t a = command.operands[0];
  const int32_t b = command.operands[1];
  if (operation(command, a)) return;
  switch (command.opcode) {
    case Opcode::SetHH: set(a, b); break;
    case Opcode::SetHK: {
      const a64::Gp to = result(a, w0);
      a_.mov(to, b);
      finish(a, to);
      break;
    }
    case Opcode::NotH: {
      const a64::Gp to = result(a, w0);
      a_.mvn(to, value(b, w0));
      finish(a, to);
      break;
    }
    case Opcode::DivHH: divide(n, true); break;
    case Opcode::ModHH: divide(n, false); break;
    case Opcode::Copy: copy(command); break;
    case Opcode::SetiLoad: load(n); break;
    case Opcode::SetiStore: store(n); break;
    case Opcode::BitMove: move_bit(command, false); break;
    case Opcode::BitMoveNeg: move_bit(command, true); break;
    default: break;  // NOP
  }
}

bool EmitterA64::operation(const Instruction& command, int32_t from) {
  const int32_t a = command.operands[0];
  const int32_t b = command.operands[1];
  // What it works on, its constant or, in a register, its second variable.
  const auto with_constant = [&](auto&& emit) {
    const a64::Gp to = result(a, w0);
    emit(to, value(from, w0));
    finish(a, to);
    return true;
  };
  const auto with_variable = [&](auto&& emit) {
    const a64::Gp to = result(a, w0);
    const a64::Gp left = value(from, w0);
    emit(to, left, b == a || b == from ? left : value(b, w1));
    finish(a, to);
    return true;
  };
  const int32_t count = b & 31;
  switch (command.opcode) {
    case Opcode::AddHH: return with_variable([&](auto to, auto x, auto y) { a_.add(to, x, y); });
    case Opcode::SubHH: return with_variable([&](auto to, auto x, auto y) { a_.sub(to, x, y); });
    case Opcode::MulHH: return with_variable([&](auto to, auto x, auto y) { a_.mul(to, x, y); });
    case Opcode::AndHH: return with_variable([&](auto to, auto x, auto y) { a_.and_(to, x, y); });
    case Opcode::OrHH: return with_variable([&](auto to, auto x, auto y) { a_.orr(to, x, y); });
    case Opcode::XorHH: return with_variable([&](auto to, auto x, auto y) { a_.eor(to, x, y); });
    case Opcode::ShlHH: return with_variable([&](auto to, auto x, auto y) { a_.lsl(to, x, y); });
    case Opcode::ShrHH: return with_variable([&](auto to, auto x, auto y) { a_.lsr(to, x, y); });
    case Opcode::AshrHH: return with_variable([&](auto to, auto x, auto y) { a_.asr(to, x, y); });
    case Opcode::AddHK: return with_constant([&](auto to, auto x) { add_constant(to, x, b); });
    case Opcode::SubHK: return with_constant([&](auto to, auto x) { add_constant(to, x, subtract(0, b)); });
    case Opcode::MulHK: return with_constant([&](auto to, auto x) { multiply_constant(to, x, b); });
    case Opcode::DivHK: return with_constant([&](auto to, auto x) { divide_constant(to, x, b, true); });
    case Opcode::ModHK: return with_constant([&](auto to, auto x) { divide_constant(to, x, b, false); });
    case Opcode::ShlHK: return with_constant([&](auto to, auto x) { a_.lsl(to, x, count); });
    case Opcode::ShrHK: return with_constant([&](auto to, auto x) { a_.lsr(to, x, count); });
    case Opcode::AshrHK: return with_constant([&](auto to, auto x) { a_.asr(to, x, count); });
    case Opcode::AndHK:
    case Opcode::OrHK:
    case Opcode::XorHK:
      return with_constant([&](auto to, auto x) { logical_constant(command.opcode, to, x, b); });
    case Opcode::BitSet: return with_constant([&](auto to, auto x) { a_.orr(to, x, 1U << b); });
    case Opcode::BitClear: return with_constant([&](auto to, auto x) { a_.and_(to, x, ~(1U << b)); });
    default: return false;
  }
}

void EmitterA64::set(int32_t to, int32_t from) {
  if (to == from) return;
  if (!pin(to)) {
    a_.str(value(from, w0), memory(to));
  } else if (pin(from)) {
    a_.mov(*pin(to), *pin(from));
  } else {
    a_.ldr(*pin(to), memory(from));
  }
}

void EmitterA64::add_constant(a64::Gp to, a64::Gp from, int32_t constant) {
  const uint32_t up = bits(constant);
  const uint32_t down = 0U - up;
  const auto fits = [](uint32_t number) {
    return number < bits(kImmediates) || (number % bits(kImmediates) == 0 && number >> 24 == 0);
  };
  if (fits(up)) {
    a_.add(to, from, up);
  } else if (fits(down)) {
    a_.sub(to, from, down);
  } else {
    a_.mov(w1, constant);
    a_.add(to, from, w1);
  }
}

void EmitterA64::logical_constant(Opcode opcode, a64::Gp to, a64::Gp from, int32_t constant) {
  const auto emit = [&](const auto& operand) {
    if (opcode == Opcode::AndHK)
      a_.and_(to, from, operand);
    else if (opcode == Opcode::OrHK)
      a_.orr(to, from, operand);
    else
      a_.eor(to, from, operand);
  };
  if (a64::Utils::isLogicalImm(bits(constant), 32)) {
    emit(asmjit::Imm(bits(constant)));
  } else {
    a_.mov(w1, constant);
    emit(w1);
  }
}

void EmitterA64::multiply_constant(a64::Gp to, a64::Gp from, int32_t factor) {
  const uint32_t size = bits(factor);
  if (factor == -1) {
    a_.neg(to, from);
  } else if (std::has_single_bit(size)) {
    a_.lsl(to, from, std::countr_zero(size));
  } else if (std::has_single_bit(size - 1)) {  // 3, 5, 9, ...
    a_.add(to, from, from, lsl(static_cast<uint32_t>(std::countr_zero(size - 1))));
  } else {
    a_.mov(w1, factor);
    a_.mul(to, from, w1);
  }
}

void EmitterA64::divide_constant(a64::Gp to, a64::Gp from, int32_t divisor, bool quotient) {
  const uint32_t size = divisor < 0 ? 0U - bits(divisor) : bits(divisor);
  if (size == 1) {
    if (!quotient)
      a_.mov(to, 0);
    else if (divisor == -1)
      a_.neg(to, from);
    else
      a_.mov(to, from);
    return;
  }
  const Reciprocal by(size);
  a_.mov(w2, by.factor);
  a_.sxtw(a64::x3, from);
  a_.mul(a64::x2, a64::x3, a64::x2);
  a_.asr(a64::x2, a64::x2, by.power);
  a_.add(w2, w2, from, lsr(31));
  if (!quotient) {
    a_.mov(a64::w3, size);
    a_.msub(to, w2, a64::w3, from);
  } else if (divisor < 0) {
    a_.neg(to, w2);
  } else {
    a_.mov(to, w2);
  }
}

// The processor's division has the answers of the commands; the divisor 0 is left to the engines.
void EmitterA64::divide(uint32_t n, bool quotient) {
  const Command& command = program_.commands[n];
  const int32_t a = command.instruction.operands[0];
  const a64::Gp divisor = value(command.instruction.operands[1], w1);
  a_.cbz(divisor, exit(n, command.credit));
  const a64::Gp dividend = value(a, w0);
  const a64::Gp to = result(a, w0);
  if (quotient) {
    a_.sdiv(to, dividend, divisor);
  } else {
    a_.sdiv(w2, dividend, divisor);
    a_.msub(to, w2, divisor, dividend);
  }
  finish(a, to);
}

void EmitterA64::move_bit(const Instruction& command, bool inverted) {
  const int32_t a = command.operands[0];
  a64::Gp bit = value(command.operands[2], w1);
  if (inverted) a_.mvn(w1, bit), bit = w1;
  if (command.operands[3] != 0) a_.lsr(w1, bit, command.operands[3]), bit = w1;
  const a64::Gp to = value(a, w0);
  a_.bfi(to, bit, command.operands[1], 1);
  finish(a, to);
}

// A register with the number of a variable in memory.
a64::Gp EmitterA64::checked_index(uint32_t n, int32_t variable, const asmjit::Label& slow) {
  const Range range = range_for(n);
  const a64::Gp index = value(variable, w0);
  if (in_range_) return index;
  if (range.first == 0) {
    compare(index, wrap(range.count));
  } else {
    add_constant(w1, index, -wrap(range.first));
    compare(w1, wrap(range.count));
  }
  a_.b_hs(slow);
  return index;
}

void EmitterA64::load(uint32_t n) {
  const auto& operands = program_.commands[n].instruction.operands;
  const Slow slow{a_.newLabel(), a_.newLabel(), n};
  const a64::Gp index = checked_index(n, operands[1], slow.label);
  const a64::Gp to = result(operands[0], w0);
  a_.ldr(to, indexed(index));
  finish(operands[0], to);
  finish_access(slow);
}

void EmitterA64::store(uint32_t n) {
  const auto& operands = program_.commands[n].instruction.operands;
  const Slow slow{a_.newLabel(), a_.newLabel(), n};
  const a64::Gp index = checked_index(n, operands[0], slow.label);
  a_.str(value(operands[1], w1), indexed(index));
  finish_access(slow);
}

void EmitterA64::slow_access(const Slow& slow) {
  const Command& command = program_.commands[slow.command];
  const auto& operands = command.instruction.operands;
  const bool loads = command.instruction.opcode == Opcode::SetiLoad;
  const a64::Gp index = value(operands[loads ? 1 : 0], w0);
  compare(index, program_.limits.variables);
  a_.b_hs(exit(slow.command, command.credit));
  if (index != w0) a_.mov(w0, index);
  if (loads) {
    a_.bl(load_any_);
    const a64::Gp to = result(operands[0], w0);
    if (to != w0) a_.mov(to, w0);
    finish(operands[0], to);
  } else {
    const a64::Gp from = value(operands[1], w1);
    if (from != w1) a_.mov(w1, from);
    a_.bl(store_any_);
  }
}

// w0 is the number of the variable, then its value; w1 the value to be stored.
void EmitterA64::any_variable(bool stores) {
  std::vector<asmjit::Label> found(pinned().size());
  for (size_t n = 0; n < found.size(); ++n) {
    found[n] = a_.newLabel();
    compare(w0, pinned()[n]);
    a_.b_eq(found[n]);
  }
  if (stores)
    a_.str(w1, indexed(w0));
  else
    a_.ldr(w0, indexed(w0));
  a_.ret(a64::x30);
  for (size_t n = 0; n < found.size(); ++n) {
    a_.bind(found[n]);
    if (stores)
      a_.mov(kPins[n], w1);
    else
      a_.mov(w0, kPins[n]);
    a_.ret(a64::x30);
  }
}

std::optional<a64::Gp> EmitterA64::pin(int32_t variable) const {
  const int number = pin_of(variable);
  if (number < 0) return std::nullopt;
  return kPins[static_cast<size_t>(number)];
}

a64::Gp EmitterA64::value(int32_t variable, a64::Gp moment) {
  if (const auto reg = pin(variable)) return *reg;
  a_.ldr(moment, memory(variable));
  return moment;
}

void EmitterA64::finish(int32_t variable, a64::Gp result) {
  if (!pin(variable)) a_.str(result, memory(variable));
}

}  // namespace ipos::vm::jit
