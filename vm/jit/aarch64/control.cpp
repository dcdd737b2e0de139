// Budget, jumps and calls on AArch64.
#include "vm/context/arithmetic.hpp"
#include "vm/jit/aarch64/emitter.hpp"

namespace ipos::vm::jit {
namespace {

using a64::CondCode;
using asmjit::Label;

CondCode condition_of(Opcode opcode) {
  switch (opcode) {
    case Opcode::JmpEqHH:
    case Opcode::JmpEqHK: return CondCode::kEQ;
    case Opcode::JmpNeHH:
    case Opcode::JmpNeHK: return CondCode::kNE;
    case Opcode::JmpLtHH:
    case Opcode::JmpLtHK: return CondCode::kLT;
    case Opcode::JmpLeHH:
    case Opcode::JmpLeHK: return CondCode::kLE;
    case Opcode::JmpGtHH:
    case Opcode::JmpGtHK: return CondCode::kGT;
    default: return CondCode::kGE;
  }
}

}  // namespace

bool emit(const Program& program, asmjit::CodeHolder& code, Unwind unwind, Emitted& out) {
  a64::Assembler assembler(&code);
  return EmitterA64(program, assembler, unwind).run(out);
}

EmitterA64::EmitterA64(const Program& program, a64::Assembler& assembler, Unwind unwind)
    : Emitter(program, assembler, unwind, kPins.size()), a_(assembler) {}

void EmitterA64::correct(int32_t by) {
  if (by != 0) add_constant(number_, number_, by);
}

void EmitterA64::check(int32_t charge, const Label& exit) {
  if (charge >= 0 && charge < kImmediates) {
    a_.subs(number_, number_, charge);
  } else {
    correct(-charge);
    a_.cmp(number_, 0);
  }
  a_.b_mi(exit);
}

void EmitterA64::leave_at(uint32_t at) {
  a_.mov(a64::w0, at);
  a_.b(leave_);
}

void EmitterA64::jump_to(const Label& to) { a_.b(to); }

void EmitterA64::jump_if(const Instruction& branch, const Label& to) {
  const a64::Gp left = value(branch.operands[0], a64::w0);
  const bool constant = info(branch.opcode).operands[1].kind == OperandKind::Constant;
  if (branch.opcode == Opcode::JmpEqHK && branch.operands[1] == 0) {
    a_.cbz(left, to);
  } else if (branch.opcode == Opcode::JmpNeHK && branch.operands[1] == 0) {
    a_.cbnz(left, to);
  } else {
    if (constant)
      compare(left, branch.operands[1]);
    else
      a_.cmp(left, value(branch.operands[1], a64::w1));
    a_.b(condition_of(branch.opcode), to);
  }
}

void EmitterA64::compare(a64::Gp left, int32_t constant) {
  if (constant >= 0 && constant < kImmediates) {
    a_.cmp(left, constant);
  } else if (constant < 0 && constant > -kImmediates) {
    a_.cmn(left, -constant);
  } else {
    a_.mov(a64::w2, constant);
    a_.cmp(left, a64::w2);
  }
}

void EmitterA64::jump_by_table(int32_t variable, int32_t first, uint32_t count, const Label& table,
                               const Label& other) {
  a64::Gp number = value(variable, a64::w0);
  if (first != 0) {
    add_constant(a64::w0, number, subtract(0, first));
    number = a64::w0;
  }
  compare(number, wrap(count));
  a_.b_hs(other);
  a_.adr(a64::x1, table);
  a_.ldr(a64::x1, a64::ptr(a64::x1, number, asmjit::arm::uxtw(3)));
  a_.br(a64::x1);
}

void EmitterA64::check_calls(const Label& exit) {
  a_.tst(calls_, kBlock - 1);
  a_.b_eq(exit);
}

// The processor's own call, so that it foresees the return.
void EmitterA64::call_to(const Label& to) {
  const Label back = a_.newLabel();
  a_.adr(a64::x30, back);
  a_.str(a64::x30, a64::ptr_pre(calls_, -8));
  a_.bl(to);
  a_.bind(back);
}

void EmitterA64::return_from(uint32_t at) {
  a_.mov(a64::w0, at);
  a_.ldr(a64::x30, a64::ptr_post(calls_, 8));
  a_.ret(a64::x30);
}

}  // namespace ipos::vm::jit
