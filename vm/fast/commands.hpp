// The commands the fast engine carries out itself, and Fused: several of them in one step. Everything about a
// sequence is known while compiling, so a handler is a few loads and stores.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>

#include "vm/context/arithmetic.hpp"
#include "vm/fast/slot.hpp"
#include "vm/isa/isa.hpp"

namespace ipos::vm::fast {

enum class Kind : uint8_t { Alu, Divide, Set, Load, Store, Test, Jump, Own };

// What a command is, as types.
#define COMMAND_H(name, kind_, value)                                                    \
  struct name {                                                                          \
    static constexpr Opcode opcode = Opcode::name;                                       \
    static constexpr Kind kind = Kind::kind_;                                            \
    static constexpr bool constant = false;                                              \
    static constexpr int words = kind == Kind::Test ? 2 : 1;                             \
    static constexpr auto apply([[maybe_unused]] int32_t x, int32_t y) { return value; } \
  };
#define COMMAND_K(name, kind_, value)                                                    \
  struct name {                                                                          \
    static constexpr Opcode opcode = Opcode::name;                                       \
    static constexpr Kind kind = Kind::kind_;                                            \
    static constexpr bool constant = true;                                               \
    static constexpr int words = kind == Kind::Test ? 3 : 2;                             \
    static constexpr auto apply([[maybe_unused]] int32_t x, int32_t y) { return value; } \
  };
#define COMMAND(name, kind, value) COMMAND_H(name##HH, kind, value) COMMAND_K(name##HK, kind, value)
COMMAND(Add, Alu, add(x, y))
COMMAND(Sub, Alu, subtract(x, y))
COMMAND(Mul, Alu, multiply(x, y))
COMMAND(And, Alu, x& y)
COMMAND(Or, Alu, x | y)
COMMAND(Xor, Alu, x ^ y)
COMMAND(Shl, Alu, shift_left(x, y))
COMMAND(Shr, Alu, shift_right(x, y))
COMMAND(Ashr, Alu, shift_right_sign(x, y))
COMMAND(Div, Divide, divide(x, y))
COMMAND(Mod, Divide, remainder(x, y))
COMMAND(JmpEq, Test, x == y)
COMMAND(JmpNe, Test, x != y)
COMMAND(JmpLt, Test, x < y)
COMMAND(JmpLe, Test, x <= y)
COMMAND(JmpGt, Test, x > y)
COMMAND(JmpGe, Test, x >= y)
COMMAND(Set, Set, y)
#undef COMMAND
COMMAND_H(SetiLoad, Load, y)
COMMAND_H(SetiStore, Store, y)
COMMAND_K(Jmp, Jump, y)
COMMAND_H(NotH, Set, ~y)
#undef COMMAND_H
#undef COMMAND_K

// Commands that no sequence contains do it all by themselves.
#define COMMAND_OWN(name, words_, statement)                                                    \
  struct name {                                                                                 \
    static constexpr Opcode opcode = Opcode::name;                                              \
    static constexpr Kind kind = Kind::Own;                                                     \
    static constexpr bool constant = false;                                                     \
    static constexpr int words = words_;                                                        \
    static void act([[maybe_unused]] const Slot* s, [[maybe_unused]] int32_t* h) { statement; } \
  };
inline void copy_block(const Slot* s, int32_t* h) {
  std::memmove(h + s->command.a, h + s->command.b, s[1].command.a * sizeof(int32_t));
}
inline void change_bit(const Slot* s, int32_t* h, bool on) {
  h[s->command.a] = set_bit(h[s->command.a], s->command.b, on);
}
inline bool source_bit(const Slot* s, const int32_t* h) {
  return test_bit(h[s[1].command.a], s[1].command.b);
}
COMMAND_OWN(Nop, 1, )
COMMAND_OWN(Copy, 2, copy_block(s, h))
COMMAND_OWN(BitSet, 1, change_bit(s, h, true))
COMMAND_OWN(BitClear, 1, change_bit(s, h, false))
COMMAND_OWN(BitMove, 2, change_bit(s, h, source_bit(s, h)))
COMMAND_OWN(BitMoveNeg, 2, change_bit(s, h, !source_bit(s, h)))
#undef COMMAND_OWN

// How a part meets the result of the part before it: not at all, as left variable, as right variable or
// index, as the value stored.
enum class Meets : uint8_t { Other, Left, Right, Value };
template <Meets M, class C>
struct Part {
  using Command = C;
  static constexpr Meets meets = M;
};
template <class C>
using O = Part<Meets::Other, C>;
template <class C>
using D = Part<Meets::Left, C>;
template <class C>
using I = Part<Meets::Right, C>;
template <class C>
using V = Part<Meets::Value, C>;

template <class... Parts>
struct Fused {
  static constexpr int kParts = sizeof...(Parts);
  static constexpr int kWords = (Parts::Command::words + ...);
  static constexpr std::array<Opcode, kParts> kOpcodes{Parts::Command::opcode...};
  static constexpr int kMet = ((Parts::meets != Meets::Other) + ...);
  static constexpr bool kFaults =
      ((Parts::Command::kind == Kind::Load || Parts::Command::kind == Kind::Store ||
        Parts::Command::kind == Kind::Divide) ||
       ...);
  static constexpr bool kAlwaysJumps = ((Parts::Command::kind == Kind::Jump) || ...);

  // Where the routes of its jumps stand; 0 where there is none.
  static constexpr std::array<int, 3> kExits = [] {
    std::array<int, 3> exits{};
    size_t n = 0;
    int at = 0;
    ((at += Parts::Command::words, Parts::Command::kind == Kind::Test || Parts::Command::kind == Kind::Jump
                                       ? void(exits[n++] = at - 1)
                                       : void()),
     ...);
    return exits;
  }();
  static constexpr bool kTests = kExits[0] != 0;
  // A JMP and nothing that could jump before it; a variable that is stepped and tested, as at the end of
  // loops.
  static constexpr bool kJumps = kAlwaysJumps && kExits[1] == 0;
  static constexpr bool kEndsLoop = [] {
    bool ends = false;
    bool stepped = false;
    ((ends = stepped && Parts::Command::kind == Kind::Test && Parts::meets == Meets::Left,
      stepped = Parts::Command::opcode == Opcode::AddHK || Parts::Command::opcode == Opcode::SubHK),
     ...);
    return ends;
  }();

  // Whether the commands at s, which have these opcodes, meet as the parts say.
  static bool fits(const Slot* s) {
    int32_t result = -1;
    return (fits_part<Parts>(s, result) && ...);
  }

  // 0: all is done. Above 0: a jump is taken, its route stands in s[code]. Below 0: the command at s[~code]
  // is not done, nor what follows; the reference interpreter finds what is wrong with it.
  [[gnu::always_inline]] static int run(const Slot* s, int32_t* h, uint32_t variables) {
    return go<0, Parts...>(s, h, variables, 0);
  }

 private:
  template <class P>
  static bool fits_part(const Slot*& s, int32_t& result) {
    using C = typename P::Command;
    const int32_t a = s->command.a;
    const int32_t b = C::constant ? -2 : s->command.b;
    s += C::words;
    bool good = true;
    if (P::meets == Meets::Left) good = a == result && b != result;
    if (P::meets == Meets::Value) good = b == result;
    if (P::meets == Meets::Right)
      good = C::kind == Kind::Store                            ? a == result
             : C::kind == Kind::Alu || C::kind == Kind::Divide ? b == result && a != result
                                                               : b == result;
    if (C::kind == Kind::Store) result = -1;
    if (C::kind != Kind::Store && C::kind != Kind::Test && C::kind != Kind::Jump) result = a;
    return good;
  }

  // Whether the variable is written again at once, with no read in between.
  template <class...>
  struct Overwritten {
    static constexpr bool value = false;
  };
  template <class P, class... Rest>
  struct Overwritten<P, Rest...> {
    static constexpr bool value = P::meets == Meets::Left && P::Command::kind == Kind::Alu;
  };

  template <int at>
  [[gnu::always_inline]] static int go(const Slot*, int32_t*, uint32_t, int32_t) {
    return 0;
  }
  template <int at, class P, class... Rest>
  [[gnu::always_inline]] static int go(const Slot* s, int32_t* h, uint32_t variables, int32_t last) {
    using C = typename P::Command;
    const Slot& slot = s[at];
    int32_t y = 0;
    if constexpr (C::kind == Kind::Own) C::act(s + at, h);
    if constexpr (C::kind == Kind::Jump)
      return at + C::words - 1;
    else if constexpr (C::constant)
      y = s[at + 1].constant.value;
    else if constexpr (C::kind != Kind::Store && C::kind != Kind::Own)
      y = P::meets == Meets::Right ? last : h[slot.command.b];

    if constexpr (C::kind == Kind::Test) {
      const int32_t x = P::meets == Meets::Left ? last : h[slot.command.a];
      if (C::apply(x, y)) return at + C::words - 1;
    } else if constexpr (C::kind == Kind::Store) {
      const auto number = bits(P::meets == Meets::Right ? last : h[slot.command.a]);
      if (number >= variables) [[unlikely]]
        return ~at;
      h[number] = P::meets == Meets::Value ? last : h[slot.command.b];
    } else if constexpr (C::kind != Kind::Own) {
      if constexpr (C::kind == Kind::Divide)
        if (y == 0) [[unlikely]]
          return ~at;
      if constexpr (C::kind == Kind::Load) {
        if (bits(y) >= variables) [[unlikely]]
          return ~at;
        last = h[bits(y)];
      } else if constexpr (C::kind == Kind::Set) {
        last = C::apply(0, y);
      } else {
        last = C::apply(P::meets == Meets::Left ? last : h[slot.command.a], y);
      }
      if constexpr (!Overwritten<Rest...>::value) h[slot.command.a] = last;
    }
    return go<at + C::words, Rest...>(s, h, variables, last);
  }
};

}  // namespace ipos::vm::fast
