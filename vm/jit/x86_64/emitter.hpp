// The x86-64 part of machine code, for the calling conventions of System V and of Windows (frame.cpp).
//
// Registers: r15 the variables, r14d the number of flow.hpp, eax and ecx for the moment, the others for
// variables. CALL and RET are the processor's own: the stack of return addresses is its stack.
#pragma once

#include <asmjit/x86.h>

#include <array>
#include <optional>

#include "vm/jit/emitter.hpp"

namespace ipos::vm::jit {

namespace x86 = asmjit::x86;

class EmitterX86 final : public Emitter {
 public:
  EmitterX86(const Program& program, x86::Assembler& assembler, Unwind unwind);

 private:
  // frame.cpp
  void enter() override;
  void leave() override;
  void returns_to_context() override;
  void move_pins(bool store);
  void block_base(x86::Gp to);

  // control.cpp
  void correct(int32_t by) override;
  void correct_with_result(int32_t by) override;
  void check(int32_t charge, const asmjit::Label& exit) override;
  void leave_at(uint32_t at) override;
  void jump_to(const asmjit::Label& to) override;
  void jump_if(const Instruction& branch, const asmjit::Label& to) override;
  bool tests_flags(const Instruction& branch) const override;
  void jump_by_table(int32_t variable, int32_t first, uint32_t count, const asmjit::Label& table,
                     const asmjit::Label& other) override;
  void check_calls(const asmjit::Label& exit) override;
  void call_to(const asmjit::Label& to) override;
  void return_from(uint32_t at) override;

  // templates.cpp
  void data(uint32_t n) override;
  bool fused(const Instruction& first, const Instruction& second) override;
  void slow_access(const Slow& slow) override;
  void any_variable(bool stores) override;
  void set(int32_t to, int32_t from) override;
  bool set_and_operate(const Instruction& first, const Instruction& second);
  bool accumulate(const Instruction& first, const Instruction& second);
  void alu(asmjit::InstId id, int32_t to, const Instruction& command, bool constant);
  void multiply(int32_t to, const Instruction& command, bool constant);
  void multiply_constant(x86::Gp to, int32_t from, int32_t factor);
  void shift(asmjit::InstId id, int32_t to, const Instruction& command, bool constant);
  void divide(uint32_t n, bool quotient);
  void divide_constant(const Instruction& command, bool quotient);
  void move_bit(const Instruction& command, bool inverted);
  void load(uint32_t n);
  void store(uint32_t n);
  x86::Gp checked_index(uint32_t n, int32_t variable, const asmjit::Label& slow);
  void compare(const Instruction& command);

  std::optional<x86::Gp> pin(int32_t variable) const;
  x86::Mem memory(int32_t variable) const;
  x86::Mem indexed(x86::Gp number) const { return x86::dword_ptr(h_, number.r64(), 2); }
  asmjit::Operand place(int32_t variable) const;

  x86::Assembler& a_;
  const x86::Gp h_ = x86::r15;
  const x86::Gp number_ = x86::r14d;
};

// Registers for variables, the one first that is least in the way.
inline constexpr std::array<x86::Gp, 11> kPins = {x86::ebx,  x86::ebp,  x86::esi,  x86::edi,
                                                  x86::r8d,  x86::r9d,  x86::r10d, x86::r11d,
                                                  x86::r12d, x86::r13d, x86::edx};

}  // namespace ipos::vm::jit
