// The way into machine code, out of it, and back from subroutines it has not called itself, on x86-64.
//
// The block of emitter.hpp is on the caller's stack, and the stack pointer points into it. Above the return
// addresses are the caller's stack pointer and the frame.
#include <algorithm>
#include <cstddef>

#include "vm/jit/x86_64/emitter.hpp"

namespace ipos::vm::jit {
namespace {

constexpr int32_t kCaller = kBlock - 16;
constexpr int32_t kFrame = kBlock - 8;
static_assert(kReturnsEnd <= kCaller && kCaller + 8 <= kFrame && kFrame + 8 <= kBlock && kCaller % 8 == 0 &&
              kFrame % 8 == 0);

// What the two calling conventions differ in: where the first two arguments are, what a function leaves as it was, and the
// room it finds for its arguments above where it returns to. Machine code has no vectors, so theirs stay. Nothing throws
// through it (unwind_ does not), so Windows has no table of how to unwind it.
#ifdef _WIN32
constexpr x86::Gp kFirst = x86::rcx, kSecond = x86::rdx;
constexpr x86::Gp kSaved[] = {x86::rbx, x86::rbp, x86::rsi, x86::rdi, x86::r12, x86::r13, x86::r14, x86::r15};
constexpr int32_t kRoomOfArguments = 32;
#else
constexpr x86::Gp kFirst = x86::rdi, kSecond = x86::rsi;
constexpr x86::Gp kSaved[] = {x86::rbx, x86::rbp, x86::r12, x86::r13, x86::r14, x86::r15};
constexpr int32_t kRoomOfArguments = 0;
#endif

x86::Mem field(x86::Gp frame, size_t offset) { return x86::ptr(frame, static_cast<int32_t>(offset)); }

}  // namespace

void EmitterX86::block_base(x86::Gp to) {
  a_.mov(to, x86::rsp);
  a_.and_(to, -kBlock);
}

void EmitterX86::move_pins(bool stores) {
  for (size_t n = 0; n < pinned().size(); ++n) {
    if (stores)
      a_.mov(memory(pinned()[n]), kPins[n]);
    else
      a_.mov(kPins[n], memory(pinned()[n]));
  }
}

void EmitterX86::enter() {
  for (const x86::Gp& saved : kSaved) a_.push(saved);
  a_.mov(x86::rax, x86::rsp);
  a_.sub(x86::rsp, 2 * kBlock);
  a_.and_(x86::rsp, -kBlock);
  a_.mov(x86::ptr(x86::rsp, kCaller), x86::rax);
  a_.mov(x86::ptr(x86::rsp, kFrame), kFirst);
  if (kFirst != x86::rdi) a_.mov(x86::rdi, kFirst);
  a_.mov(x86::rcx, field(x86::rdi, offsetof(Frame, free_calls)));
  a_.lea(x86::rsi, x86::ptr(x86::rsp, x86::rcx, 3));
  a_.mov(x86::rdx, field(x86::rdi, offsetof(Frame, context)));
  a_.movzx(x86::ecx, x86::byte_ptr(x86::rdx, offsetof(TaskContext, depth)));
  a_.lea(x86::rax, x86::ptr(returned_));
  const asmjit::Label again = a_.newLabel();
  a_.bind(again);
  a_.mov(x86::ptr(x86::rsi, x86::rcx, 3), x86::rax);
  a_.sub(x86::ecx, 1);
  a_.jns(again);
  a_.mov(x86::rsp, x86::rsi);
  a_.mov(h_, field(x86::rdi, offsetof(Frame, h)));
  a_.mov(number_, field(x86::rdi, offsetof(Frame, number)));
  a_.mov(x86::rax, field(x86::rdi, offsetof(Frame, target)));
  move_pins(false);
  a_.jmp(x86::rax);
}

// eax is the word address, the number is that of the commands left.
void EmitterX86::leave() {
  a_.bind(leave_);
  move_pins(true);
  block_base(x86::rbx);
  a_.mov(x86::rdi, x86::ptr(x86::rbx, kFrame));
  a_.mov(field(x86::rdi, offsetof(Frame, pc)), x86::eax);
  a_.mov(field(x86::rdi, offsetof(Frame, number)), number_);
  // Where no call of machine code is open there is nothing to unwind.
  const asmjit::Label unwound = a_.newLabel();
  const auto most_calls = static_cast<int32_t>(std::min<uint32_t>(program_.limits.call_depth, kMaxCallDepth));
  a_.mov(x86::rcx, field(x86::rdi, offsetof(Frame, context)));
  a_.movzx(x86::ecx, x86::byte_ptr(x86::rcx, offsetof(TaskContext, depth)));
  a_.lea(x86::rcx, x86::ptr(x86::rsp, x86::rcx, 3, -8 * most_calls));
  a_.cmp(x86::rcx, x86::rbx);
  a_.je(unwound);
  if (kFirst != x86::rdi) a_.mov(kFirst, x86::rdi);
  a_.mov(kSecond, x86::rsp);
  a_.and_(x86::rsp, -16);
  if (kRoomOfArguments != 0) a_.sub(x86::rsp, kRoomOfArguments);
  a_.mov(x86::rax, asmjit::Imm(reinterpret_cast<uintptr_t>(unwind_)));
  a_.call(x86::rax);
  a_.bind(unwound);
  a_.mov(x86::rsp, x86::ptr(x86::rbx, kCaller));
  for (size_t n = std::size(kSaved); n-- > 0;) a_.pop(kSaved[n]);
  a_.ret();
}

// A RET has found no call of machine code. eax is its word address.
void EmitterX86::returns_to_context() {
  static_assert(sizeof(TaskContext{}.calls[0]) == 2, "the loads of `calls` below are of words");
  const asmjit::Label ends = a_.newLabel(), unknown = a_.newLabel(), table = a_.newLabel();
  const auto context = [&] {
    block_base(x86::rcx);
    a_.mov(x86::rcx, x86::ptr(x86::rcx, kFrame));
    a_.mov(x86::rcx, field(x86::rcx, offsetof(Frame, context)));
  };
  const x86::Mem depth = x86::byte_ptr(x86::rcx, offsetof(TaskContext, depth));
  a_.bind(returned_);
  context();
  a_.cmp(depth, 0);
  a_.je(ends);
  a_.dec(depth);
  a_.movzx(x86::eax, depth);
  a_.movzx(x86::eax, x86::word_ptr(x86::rcx, x86::rax, 1, offsetof(TaskContext, calls)));
  a_.lea(x86::rcx, x86::ptr(table));
  a_.movsxd(x86::rax, x86::dword_ptr(x86::rcx, x86::rax, 2));
  a_.add(x86::rax, x86::rcx);
  a_.jmp(x86::rax);
  // Where no machine code is: the engines go on there.
  a_.bind(unknown);
  context();
  a_.movzx(x86::eax, depth);
  a_.movzx(x86::eax, x86::word_ptr(x86::rcx, x86::rax, 1, offsetof(TaskContext, calls)));
  a_.jmp(leave_);
  // Nothing was called: the RET is not for machine code.
  a_.bind(ends);
  a_.sub(x86::rsp, 8);
  a_.add(number_, 1);
  a_.jmp(leave_);
  table_of_returns(table, unknown);
}

}  // namespace ipos::vm::jit
