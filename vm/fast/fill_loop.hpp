// Loops that are one operation, for (; k < n; k += d) v[k] = c, without leaving the handler. The variable of
// the loop stays in a register, as reading back what was just stored takes longer than all the rest; it is
// stored in every turn all the same, and read again when the loop overwrites it.
#pragma once

#include <type_traits>

#include "vm/fast/commands.hpp"

namespace ipos::vm::fast {

// SET t = k; ADD t + base; [SET c = value;] SETI [t] = c; Step k; Test k, back to the SET.
template <bool constant, class Step, class Test>
struct FillLoop {
  using Body =
      std::conditional_t<constant, Fused<O<SetHH>, D<AddHK>, O<SetHK>, V<SetiStore>, O<Step>, D<Test>>,
                         Fused<O<SetHH>, D<AddHK>, I<SetiStore>, O<Step>, D<Test>>>;
  static constexpr int kValue = 3;
  static constexpr int kStore = constant ? 5 : 3;
  static constexpr int kStep = kStore + 1;
  static constexpr int kTest = kStep + Step::words;
  static constexpr int kRoute = kTest + Test::words - 1;
  static constexpr int kWords = kRoute + 1;
  static constexpr int kCommands = constant ? 6 : 5;

  static bool fits(const Slot* s) {
    const uint16_t t = s[0].command.a;
    const uint16_t k = s[0].command.b;
    const uint16_t c = s[kStore].command.b;
    return Body::fits(s) && s[kStore].command.a == t && s[kStep].command.a == k && t != k &&
           (!constant || (s[kValue].command.a == c && c != t && c != k));
  }

  enum class End : uint8_t { Done, Spent, Fault };

  // `left` as in engine.cpp; Spent leaves the loop in front of a turn, Fault in front of the store.
  static End run(const Slot* s, int32_t* h, uint32_t variables, int32_t& left, int32_t bound) {
    int32_t& t = h[s[0].command.a];
    const uint32_t k_number = s[0].command.b;
    const uint32_t c_number = s[kStore].command.b;
    const uint32_t step_number = s[kStep].command.b;
    const uint32_t limit_number = s[kTest].command.b;
    const int32_t base = s[2].constant.value;
    int32_t k = h[k_number];
    for (;;) {
      t = add(k, base);
      if constexpr (constant) h[c_number] = s[kValue + 1].constant.value;
      const uint32_t number = bits(add(k, base));
      if (number >= variables) [[unlikely]]
        return End::Fault;
      h[number] = h[c_number];
      if (number == k_number) [[unlikely]]
        k = h[k_number];
      k = Step::apply(k, Step::constant ? s[kStep + 1].constant.value : h[step_number]);
      h[k_number] = k;
      if (!Test::apply(k, Test::constant ? s[kTest + 1].constant.value : h[limit_number])) return End::Done;
      left -= kCommands;
      if (left < bound) return End::Spent;
    }
  }
};

}  // namespace ipos::vm::fast
