// What time passes through is a plain value, a part:
//
//   advance(n)  does at once what n milliseconds do in which nothing is decided
//   bound()     for how many of them that holds at most: up to the next thing that counting leads to
//
// The law: where a tick left a part as advance(1) would have, and nobody writes to it, each of the next
// bound() ticks does the same. tests/runtime/pace holds every part to it.
#pragma once

#include <concepts>
#include <cstdint>
#include <type_traits>

namespace ipos::runtime {

using Ticks = uint32_t;
inline constexpr Ticks kNoBound = UINT32_MAX;

template <class P>
concept Part = std::is_trivially_copyable_v<P> && std::equality_comparable<P> &&
    requires(P part, const P constant, Ticks n) {
  part.advance(n);
  { constant.bound() } -> std::same_as<Ticks>;
};

// How many of the next ticks advance() can do: tried on the last one, not concluded from what a part is. Its
// == is defaulted, so a new member is compared by itself.
template <Part P>
Ticks steady_ticks(P before, const P& after) {
  before.advance(1);
  return before == after ? after.bound() : 0;
}

}  // namespace ipos::runtime
