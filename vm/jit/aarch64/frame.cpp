// The way into machine code, out of it, and back from subroutines it has not called itself, on AArch64.
//
// The block of emitter.hpp begins at the stack pointer. At its end is the caller's stack pointer.
#include <cstddef>

#include "vm/jit/aarch64/emitter.hpp"

namespace ipos::vm::jit {
namespace {

constexpr int32_t kCaller = kBlock - 8;
static_assert(kReturnsEnd <= kCaller && kCaller + 8 <= kBlock && kCaller % 8 == 0);

// What AAPCS64 has the callee save: x19 to x28; and where it returns to.
constexpr uint32_t kFirstSaved = 19, kLastSaved = 30;

a64::Mem field(a64::Gp of, size_t offset) { return a64::ptr(of, static_cast<int32_t>(offset)); }

}  // namespace

void EmitterA64::move_pins(bool stores) {
  for (size_t n = 0; n < pinned().size(); ++n) {
    if (stores)
      a_.str(kPins[n], memory(pinned()[n]));
    else
      a_.ldr(kPins[n], memory(pinned()[n]));
  }
}

void EmitterA64::enter() {
  for (uint32_t n = kFirstSaved; n < kLastSaved; n += 2)
    a_.stp(a64::x(n), a64::x(n + 1), a64::ptr_pre(a64::sp, -16));
  a_.mov(a64::x1, a64::sp);
  a_.sub(a64::x2, a64::x1, 2 * kBlock);
  a_.and_(a64::sp, a64::x2, -kBlock);
  a_.str(a64::x1, a64::ptr(a64::sp, kCaller));
  a_.mov(frame_, a64::x0);
  a_.mov(a64::x1, a64::sp);
  a_.ldr(a64::x2, field(frame_, offsetof(Frame, free_calls)));
  a_.add(calls_, a64::x1, a64::x2, asmjit::arm::lsl(3));
  a_.ldr(a64::x1, field(frame_, offsetof(Frame, context)));
  a_.ldrb(a64::w1, field(a64::x1, offsetof(TaskContext, depth)));
  const asmjit::Label again = a_.newLabel(), returned = a_.newLabel();
  a_.adr(a64::x2, returned);  // to what reaches farther
  a_.bind(again);
  a_.str(a64::x2, a64::ptr(calls_, a64::x1, asmjit::arm::lsl(3)));
  a_.subs(a64::x1, a64::x1, 1);
  a_.b_pl(again);
  a_.ldr(h_, field(frame_, offsetof(Frame, h)));
  a_.ldr(number_, field(frame_, offsetof(Frame, number)));
  a_.ldr(a64::x0, field(frame_, offsetof(Frame, target)));
  move_pins(false);
  a_.br(a64::x0);
  a_.bind(returned);
  a_.b(returned_);
}

// w0 is the word address, the number is that of the commands left.
void EmitterA64::leave() {
  a_.bind(leave_);
  move_pins(true);
  a_.str(a64::w0, field(frame_, offsetof(Frame, pc)));
  a_.str(number_, field(frame_, offsetof(Frame, number)));
  a_.mov(a64::x0, frame_);
  a_.mov(a64::x1, calls_);
  a_.mov(a64::x2, reinterpret_cast<uintptr_t>(unwind_));
  a_.blr(a64::x2);
  a_.ldr(a64::x0, a64::ptr(a64::sp, kCaller));
  a_.mov(a64::sp, a64::x0);
  for (uint32_t n = kLastSaved + 1; n > kFirstSaved; n -= 2)
    a_.ldp(a64::x(n - 2), a64::x(n - 1), a64::ptr_post(a64::sp, 16));
  a_.ret(a64::x30);
}

// A RET has found no call of machine code. w0 is its word address.
void EmitterA64::returns_to_context() {
  static_assert(sizeof(TaskContext{}.depth) == 1 && sizeof(TaskContext{}.calls[0]) == 2,
                "what is loaded below");
  const asmjit::Label ends = a_.newLabel(), table = a_.newLabel();
  a_.bind(returned_);
  a_.ldr(a64::x1, field(frame_, offsetof(Frame, context)));
  a_.ldrb(a64::w2, field(a64::x1, offsetof(TaskContext, depth)));
  a_.cbz(a64::w2, ends);
  a_.sub(a64::w2, a64::w2, 1);
  a_.strb(a64::w2, field(a64::x1, offsetof(TaskContext, depth)));
  a_.add(a64::x1, a64::x1, offsetof(TaskContext, calls));
  a_.ldrh(a64::w0, a64::ptr(a64::x1, a64::w2, asmjit::arm::uxtw(1)));
  a_.adr(a64::x1, table);
  a_.ldrsw(a64::x2, a64::ptr(a64::x1, a64::w0, asmjit::arm::uxtw(2)));
  a_.add(a64::x1, a64::x1, a64::x2);
  a_.br(a64::x1);  // to leave_ where no machine code is: the engines go on there
  // Nothing was called: the RET is not for machine code.
  a_.bind(ends);
  a_.sub(calls_, calls_, 8);
  a_.add(number_, number_, 1);
  a_.b(leave_);
  table_of_returns(table, leave_);
}

}  // namespace ipos::vm::jit
