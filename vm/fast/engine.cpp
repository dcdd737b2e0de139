// Handlers of all operations. Each one jumps to the next: with g++ by an offset that stands in the slot, in
// units of the alignment of labels; with clang, which does not align them, by a table; else by a switch. The
// budget is looked at where a jump leads, for the line of commands after it; when it may not suffice, step()
// does what is left of it command by command.
#include "vm/fast/engine.hpp"

#include <algorithm>
#include <functional>
#include <type_traits>

#include "vm/fast/fill_loop.hpp"

namespace ipos::vm::fast {
namespace {

struct State {
  const Slot* ip;
  int32_t left;  // see slot.hpp
};

enum class Exit : uint8_t { Left, Spent };

// So many commands are done sooner one by one than by the ways into execute() and into machine code.
constexpr uint32_t kFew = 8;
constexpr uint32_t kFewForNative = 16;

constexpr uint32_t kMaxBudget = 1U << 30;
static_assert(kMaxBudget <= uint32_t{INT32_MAX} - UINT16_MAX, "State::left holds it and a command's number");

uint32_t call_depth(const Predecoded& program) {
  return std::min<uint32_t>(program.program().limits().call_depth, kMaxCallDepth);
}

// Whatever its options say, g++ aligns labels only in code it optimises for speed.
#if !defined(__OPTIMIZE__) || defined(__OPTIMIZE_SIZE__)
#undef IPOS_LABEL_ALIGNMENT
#define IPOS_LABEL_ALIGNMENT 0
#endif
#if IPOS_LABEL_ALIGNMENT
#define DISPATCH() goto*(base + size_t{ip->command.handler} * IPOS_LABEL_ALIGNMENT)
#elif IPOS_THREADED
#define DISPATCH() goto* kLabels[ip->command.handler]
#endif
#if IPOS_THREADED
#define BEGIN(name) L_##name:
#define LABEL(name) &&L_##name,
#else
#define BEGIN(name) case static_cast<uint16_t>(Operation::name):
#define DISPATCH() goto next
#endif

#define FALL(words) \
  do {              \
    ip += (words);  \
    DISPATCH();     \
  } while (false)

// A jump by the route at `at`.
#define TAKE(at)                               \
  do {                                         \
    const Slot* const route = (at);            \
    left -= route->route.delta;                \
    ip = route + route->route.offset;          \
    if (left < route->route.bound) goto spent; \
    DISPATCH();                                \
  } while (false)

// The same for jumps that mostly lead where the one before them led, as from the end of a loop or of a case:
// the processor goes on from there without waiting for the route, which it only has to find equal. HIDE keeps
// the compiler from seeing that the two are the same. Not with clang, which takes minutes for this file
// without it.
#if IPOS_LABEL_ALIGNMENT
#define HIDE(pointer) asm("" : "+r"(pointer))
#define TAKE_AGAIN(at, before)                              \
  do {                                                      \
    const Slot* const route = (at);                         \
    const Slot* const target = route + route->route.offset; \
    const Slot* guess = before;                             \
    HIDE(guess);                                            \
    left -= route->route.delta;                             \
    if (left < route->route.bound) {                        \
      ip = target;                                          \
      goto spent;                                           \
    }                                                       \
    if (target == before) [[likely]] {                      \
      ip = guess;                                           \
      DISPATCH();                                           \
    }                                                       \
    ip = before = target;                                   \
    DISPATCH();                                             \
  } while (false)
#else
#define TAKE_AGAIN(at, before) TAKE(at)
#endif

#define CALL()                               \
  do {                                       \
    if (t.depth == depth_limit) goto leave;  \
    t.calls[t.depth++] = ip[1].route.behind; \
    TAKE(ip + 1);                            \
  } while (false)

#define RETURN()                                                                   \
  do {                                                                             \
    if (t.depth == 0) goto leave;                                                  \
    const uint32_t back = t.calls[--t.depth];                                      \
    left -= ip->command.number + 1;                                                \
    ip = slots + back;                                                             \
    left += ip->command.number;                                                    \
    if (left < static_cast<int32_t>(ip->command.number + lines[back])) goto spent; \
    DISPATCH();                                                                    \
  } while (false)

// Does the parts of an operation and leaves the handler if that ends it.
#define PARTS(...)                                    \
  using F = Fused<__VA_ARGS__>;                       \
  const int end = F::run(ip, h, variables);           \
  if constexpr (F::kExits[0] != 0)                    \
    if (end == F::kExits[0]) {                        \
      if constexpr (F::kEndsLoop)                     \
        TAKE_AGAIN(ip + F::kExits[0], loop);          \
      else if constexpr (F::kJumps)                   \
        TAKE_AGAIN(ip + F::kExits[0], join);          \
      else                                            \
        TAKE(ip + F::kExits[0]);                      \
    }                                                 \
  if constexpr (F::kExits[1] != 0)                    \
    if (end == F::kExits[1]) TAKE(ip + F::kExits[1]); \
  if constexpr (F::kFaults)                           \
    if (end < 0) [[unlikely]] {                       \
      ip += ~end;                                     \
      goto leave;                                     \
    }

// Without a program it gives the table of labels instead.
Exit execute(const Predecoded* program, TaskContext* context, int32_t* h, State& state,
             [[maybe_unused]] const void* const** labels) {
#if IPOS_THREADED
  static const void* const kLabels[] = {
#define SPECIAL(name) LABEL(name)
#define PLAIN(name) LABEL(name)
#define FUSED(name, ...) LABEL(name)
#define FUSED_CALL(name, ...) LABEL(name)
#define FUSED_RET(name, ...) LABEL(name)
#define FILL(name, ...) LABEL(name)
#include "vm/fast/operations.def"
  };
  if (program == nullptr) {
    *labels = kLabels;
    return Exit::Left;
  }
  [[maybe_unused]] const char* const base = static_cast<const char*>(program->base());
#endif
  TaskContext& t = *context;
  const Slot* const slots = program->slots();
  const uint16_t* const lines = program->lines();
  const uint32_t variables = program->program().limits().variables;
  const uint32_t depth_limit = call_depth(*program);
  const Slot* ip = state.ip;
  [[maybe_unused]] const Slot* loop = nullptr;  // where the last end of a loop led
  [[maybe_unused]] const Slot* join = nullptr;  // where the last JMP led
  int32_t left = state.left;

#if IPOS_THREADED
  DISPATCH();
#else
next:
  switch (ip->command.handler) {
#endif

#define SPECIAL(name)
#define PLAIN(name) FUSED(name, O<name>)
#define FUSED(name, ...)                             \
  BEGIN(name) {                                      \
    PARTS(__VA_ARGS__)                               \
    if constexpr (!F::kAlwaysJumps) FALL(F::kWords); \
  }
#define FUSED_CALL(name, ...) \
  BEGIN(name) {               \
    PARTS(__VA_ARGS__)        \
    ip += F::kWords;          \
    CALL();                   \
  }
#define FUSED_RET(name, ...) \
  BEGIN(name) {              \
    PARTS(__VA_ARGS__)       \
    ip += F::kWords;         \
    RETURN();                \
  }
#define FILL(name, ...)                                                  \
  BEGIN(name) {                                                          \
    using L = FillLoop<__VA_ARGS__>;                                     \
    switch (L::run(ip, h, variables, left, ip[L::kRoute].route.bound)) { \
      case L::End::Done: FALL(L::kWords);                                \
      case L::End::Spent: goto spent;                                    \
      case L::End::Fault: ip += L::kStore; goto leave;                   \
    }                                                                    \
  }
#include "vm/fast/operations.def"

  BEGIN(Call) { CALL(); }
  BEGIN(Ret) { RETURN(); }

  BEGIN(SetSwitchDense) {
    h[ip->command.a] = h[ip->command.b];
    ip += 1;
    goto dense;
  }
  BEGIN(SwitchDense) {
  dense:
    const uint32_t which = bits(h[ip->command.a]) - bits(ip[1].constant.value);
    const uint32_t count = ip->command.b;
    if (which < count) TAKE(ip + 3 * which + 2);
    FALL(3 * count);
  }
  BEGIN(SetSwitchSparse) {
    h[ip->command.a] = h[ip->command.b];
    ip += 1;
    goto sparse;
  }
  BEGIN(SwitchSparse) {
  sparse:
    const int32_t value = h[ip->command.a];
    const Slot* const end = ip + 3 * ip->command.b;
    for (; ip != end; ip += 3)
      if (ip[1].constant.value == value) TAKE(ip + 2);
    DISPATCH();
  }
  BEGIN(Leave) {
  leave:
    state = {ip, left};
    return Exit::Left;
  }
#if !IPOS_THREADED
  default: goto leave;
}
#endif
spent : state = {ip, left};
return Exit::Spent;
}

// Exactly `budget` commands, at least one, or those in front of one that is left to the reference
// interpreter. Ends early after a jump, too, where many are left and would do for the line there. Returns
// what is left.
uint32_t step(const Predecoded& program, TaskContext& t, int32_t* h, uint32_t budget) {
  const Slot* const slots = program.slots();
  const uint32_t* const code = program.program().code().data();
  uint32_t at = t.pc;
  uint32_t left = budget;
  do {
    const Slot* const ip = slots + at;
    switch (static_cast<Opcode>(code[at] & 0xFF)) {
#define SPECIAL(name)
#define FUSED(name, ...)
#define FUSED_CALL(name, ...)
#define FUSED_RET(name, ...)
#define FILL(name, ...)
#define PLAIN(name)                                                      \
  case Opcode::name: {                                                   \
    using F = Fused<O<name>>;                                            \
    /* It calls a function: all others would pay for that. */            \
    if (std::is_same_v<name, Copy>) goto leave;                          \
    const int end = F::run(ip, h, program.program().limits().variables); \
    if (F::kFaults && end < 0) goto leave;                               \
    --left;                                                              \
    if (!F::kTests || end == 0) {                                        \
      at += F::kWords;                                                   \
      continue;                                                          \
    }                                                                    \
    at += static_cast<uint32_t>(end + ip[end].route.offset);             \
    break;                                                               \
  }
#include "vm/fast/operations.def"
      case Opcode::Call:
        if (t.depth == call_depth(program)) goto leave;
        t.calls[t.depth++] = ip[1].route.behind;
        at += static_cast<uint32_t>(1 + ip[1].route.offset);
        --left;
        break;
      case Opcode::Ret:
        if (t.depth == 0) goto leave;
        at = t.calls[--t.depth];
        --left;
        break;
      default: goto leave;
    }
    if (left > kFew && left >= program.line(at)) break;
  } while (left != 0);
leave:
  t.pc = at;
  t.commands += budget - left;
  return left;
}

#undef BEGIN
#undef DISPATCH
#undef LABEL
#undef FALL
#undef TAKE
#undef TAKE_AGAIN
#undef HIDE
#undef CALL
#undef RETURN
#undef PARTS

// As run(), for budgets that may be worth the way into what is faster.
[[gnu::noinline]] uint32_t run_many(const Predecoded& program, TaskContext& t, int32_t* h, uint32_t budget,
                                    const Native* native) {
  if (budget > kMaxBudget) [[unlikely]]
    return budget - kMaxBudget + run_many(program, t, h, kMaxBudget, native);
  uint32_t left = budget;
  const auto done_but = [&](uint32_t rest) {
    t.commands += left - rest;
    left = rest;
  };
  while (left != 0) {
    if (native != nullptr && left > kFewForNative) {
      const uint32_t need = native->needs[t.pc];
      if (need == 0) {  // no way in: one command is done here, so that it is found after it
        if (step(program, t, h, 1) != 0) break;
        --left;
        continue;
      }
      if (left >= need) {
        done_but(native->run(*native, t, h, left));
        if (left == 0 || native->needs[t.pc] == 0) continue;
      }
    }
    if (left >= program.line(t.pc)) {
      const Slot* const ip = program.slots() + t.pc;
      State state{ip, static_cast<int32_t>(left + ip->command.number)};
      const Exit exit = execute(&program, &t, h, state, nullptr);
      t.pc = static_cast<uint32_t>(state.ip - program.slots());
      done_but(static_cast<uint32_t>(state.left) - state.ip->command.number);
      if (exit == Exit::Left || left == 0) break;
    }
    const uint32_t before = left;
    left = step(program, t, h, left);
    if (left == before) break;
  }
  return left;
}

}  // namespace

#if IPOS_LABEL_ALIGNMENT
namespace {

const void* const* labels() {
  const void* const* out = nullptr;
  State none{};
  execute(nullptr, nullptr, nullptr, none, &out);
  return out;
}

}  // namespace

const void* handler_base() {
  const void* const* const all = labels();
  return *std::min_element(all, all + static_cast<size_t>(Operation::kCount), std::less<>());
}

uint16_t handler_of(Operation operation, const void* base) {
  const auto distance =
      static_cast<const char*>(labels()[static_cast<size_t>(operation)]) - static_cast<const char*>(base);
  return static_cast<uint16_t>(distance / IPOS_LABEL_ALIGNMENT);
}
#else
const void* handler_base() { return nullptr; }
uint16_t handler_of(Operation operation, const void*) { return static_cast<uint16_t>(operation); }
#endif

uint32_t run(const Predecoded& program, TaskContext& t, int32_t* h, uint32_t budget, const Native* native) {
  const bool few = budget - 1 < kFew;  // but not none
  return few ? step(program, t, h, budget) : run_many(program, t, h, budget, native);
}

}  // namespace ipos::vm::fast
