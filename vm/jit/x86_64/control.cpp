// Budget, jumps and calls on x86-64.
#include "vm/context/arithmetic.hpp"
#include "vm/jit/x86_64/emitter.hpp"

namespace ipos::vm::jit {
namespace {

using asmjit::Label;

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

}  // namespace

bool emit(const Program& program, asmjit::CodeHolder& code, Unwind unwind, Emitted& out) {
  x86::Assembler assembler(&code);
  return EmitterX86(program, assembler, unwind).run(out);
}

EmitterX86::EmitterX86(const Program& program, x86::Assembler& assembler, Unwind unwind)
    : Emitter(program, assembler, unwind, kPins.size()), a_(assembler) {
  a_.addEncodingOptions(asmjit::EncodingOptions::kOptimizedAlign);  // one long NOP instead of many
}

void EmitterX86::correct(int32_t by) {
  if (by != 0) a_.add(number_, by);
}

void EmitterX86::correct_with_result(int32_t by) {
  if (by != 0) a_.lea(number_.r64(), x86::ptr(number_.r64(), by));
}

void EmitterX86::check(int32_t charge, const Label& exit) {
  if (charge != 0)
    a_.sub(number_, charge);
  else
    a_.test(number_, number_);
  a_.js(exit);
}

void EmitterX86::leave_at(uint32_t at) {
  a_.mov(x86::eax, at);
  a_.jmp(leave_);
}

void EmitterX86::jump_to(const Label& to) { a_.jmp(to); }

bool EmitterX86::tests_flags(const Instruction& branch) const {
  return condition_of_result(branch).has_value();
}

void EmitterX86::jump_if(const Instruction& branch, const Label& to) {
  x86::CondCode condition = condition_of(branch.opcode);
  const auto of_result = condition_of_result(branch);
  if (flags_of_ == branch.operands[0] && of_result)
    condition = *of_result;
  else
    compare(branch);
  a_.j(condition, to);
}

void EmitterX86::compare(const Instruction& command) {
  const bool constant = info(command.opcode).operands[1].kind == OperandKind::Constant;
  const int32_t a = command.operands[0];
  const int32_t b = command.operands[1];
  if (constant && b == 0 && pin(a)) {
    a_.test(*pin(a), *pin(a));
  } else if (constant) {
    a_.emit(x86::Inst::kIdCmp, place(a), asmjit::Imm(b));
  } else if (pin(a) || pin(b)) {
    a_.emit(x86::Inst::kIdCmp, place(a), place(b));
  } else {
    a_.mov(x86::eax, memory(a));
    a_.cmp(x86::eax, memory(b));
  }
}

void EmitterX86::jump_by_table(int32_t variable, int32_t first, uint32_t count, const Label& table,
                               const Label& other) {
  a_.emit(x86::Inst::kIdMov, x86::eax, place(variable));
  if (first != 0) a_.sub(x86::eax, first);
  a_.cmp(x86::eax, count);
  a_.jae(other);
  a_.lea(x86::rcx, x86::ptr(table));
  a_.jmp(x86::qword_ptr(x86::rcx, x86::rax, 3));
}

void EmitterX86::check_calls(const Label& exit) {
  a_.test(x86::esp, kBlock - 1);
  a_.jz(exit);
}

void EmitterX86::call_to(const Label& to) { a_.call(to); }

void EmitterX86::return_from(uint32_t at) {
  a_.mov(x86::eax, at);
  a_.ret();
}

}  // namespace ipos::vm::jit
