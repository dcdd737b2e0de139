// The AArch64 part of machine code, for the calling convention AAPCS64.
//
// Registers: x19 the variables, w20 the number of flow.hpp, x21 the top of the return addresses, x22 the
// frame, x0 to x3 for the moment, x30 the processor's, the others for variables; x18 and x29 belong to the
// platform.
#pragma once

#include <asmjit/arm/a64assembler.h>
#include <asmjit/arm/a64utils.h>

#include <array>
#include <optional>

#include "vm/jit/emitter.hpp"

namespace ipos::vm::jit {

namespace a64 = asmjit::a64;

class EmitterA64 final : public Emitter {
 public:
  EmitterA64(const Program& program, a64::Assembler& assembler, Unwind unwind);

 private:
  // frame.cpp
  void enter() override;
  void leave() override;
  void returns_to_context() override;
  void move_pins(bool stores);

  // control.cpp
  void correct(int32_t by) override;
  void correct_with_result(int32_t by) override { correct(by); }
  void check(int32_t charge, const asmjit::Label& exit) override;
  void leave_at(uint32_t at) override;
  void jump_to(const asmjit::Label& to) override;
  void jump_if(const Instruction& branch, const asmjit::Label& to) override;
  bool tests_flags(const Instruction&) const override { return false; }
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
  // The command with `from` instead of its first variable to work on; false when it is none that works on
  // one.
  bool operation(const Instruction& command, int32_t from);
  void add_constant(a64::Gp to, a64::Gp from, int32_t constant);
  void logical_constant(Opcode opcode, a64::Gp to, a64::Gp from, int32_t constant);
  void multiply_constant(a64::Gp to, a64::Gp from, int32_t factor);
  void divide_constant(a64::Gp to, a64::Gp from, int32_t divisor, bool quotient);
  void divide(uint32_t n, bool quotient);
  void compare(a64::Gp left, int32_t constant);
  void move_bit(const Instruction& command, bool inverted);
  void load(uint32_t n);
  void store(uint32_t n);
  a64::Gp checked_index(uint32_t n, int32_t variable, const asmjit::Label& slow);

  // Where a variable is: its register; else `moment`, which value() loads and finish() stores.
  std::optional<a64::Gp> pin(int32_t variable) const;
  a64::Gp value(int32_t variable, a64::Gp moment);
  a64::Gp result(int32_t variable, a64::Gp moment) const { return pin(variable).value_or(moment); }
  void finish(int32_t variable, a64::Gp result);
  a64::Mem memory(int32_t variable) const { return a64::ptr(h_, variable * 4); }
  a64::Mem indexed(a64::Gp number) const { return a64::ptr(h_, number, asmjit::arm::uxtw(2)); }

  a64::Assembler& a_;
  const a64::Gp h_ = a64::x19;
  const a64::Gp number_ = a64::w20;
  const a64::Gp calls_ = a64::x21;
  const a64::Gp frame_ = a64::x22;
};

// Registers for variables. More of them make programs with many hot loops faster, and the ways in and out
// slower.
inline constexpr std::array<a64::Gp, 20> kPins = {
    a64::w4,  a64::w5,  a64::w6,  a64::w7,  a64::w8,  a64::w9,  a64::w10, a64::w11, a64::w12, a64::w13,
    a64::w14, a64::w15, a64::w16, a64::w17, a64::w23, a64::w24, a64::w25, a64::w26, a64::w27, a64::w28};

// Constants below this can stand in additions and comparisons.
inline constexpr int32_t kImmediates = 4096;

}  // namespace ipos::vm::jit
