// The system variables that a part of the unit follows or shows (column `use` of
// stdlib/system_variables.def), as they were before the tasks ran: while they are the same nobody has to look
// what the program has written. The others (timers, scope, analog outputs, H522 to H530) may change.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <span>
#include <utility>

#include "stdlib/system_variables.hpp"

namespace ipos::runtime {

class NotedVariables {
 public:
  void note(std::span<const int32_t> h) {
    each_range(h, [](int32_t* noted, const int32_t* now, auto count) {
      std::memcpy(noted, now, count() * sizeof(int32_t));
    });
  }
  bool same(std::span<const int32_t> h) {
    Four fours{};
    int32_t rest = 0;
    each_range(h, [&](const int32_t* noted, const int32_t* now, auto count) {
      constexpr size_t kFours = count() / 4;
      [&]<size_t... n>(std::index_sequence<n...>) {
        ((fours |= load(noted + 4 * n) ^ load(now + 4 * n)), ...);
      }
      (std::make_index_sequence<kFours>());
      for (size_t n = 4 * kFours; n < count(); ++n) rest |= noted[n] ^ now[n];
    });
    return (fours[0] | fours[1] | fours[2] | fours[3] | rest) == 0;
  }

 private:
  // Four variables at a time: memcmp would be called for each range.
  using Four [[gnu::vector_size(16)]] = int32_t;
  [[gnu::always_inline]] static Four load(const int32_t* from) {
    Four value;
    std::memcpy(&value, from, sizeof value);
    return value;
  }

  // Variables that stand in a row, with numbers in between that are no system variables.
  struct Range {
    size_t first, last;
  };
  static constexpr size_t kRanges = 5;
  static constexpr size_t kWidestGap = 12;
  static constexpr auto kNoted = [] {
    std::array<Range, kRanges> ranges{};
    size_t count = 0;
    bool joins = false;
    for (const stdlib::UsedVariable& variable : stdlib::kUsedVariables) {
      const bool noted =
          variable.use != stdlib::VariableUse::Nothing && variable.use != stdlib::VariableUse::Counts;
      if (noted && joins && variable.number - ranges[count - 1].last <= kWidestGap)
        ranges[count - 1].last = variable.number;
      else if (noted)
        ranges[count++] = {variable.number, variable.number};  // more than kRanges do not compile
      joins = noted;
    }
    return ranges;
  }();
  static constexpr size_t kFirst = kNoted.front().first, kLast = kNoted.back().last;
  static_assert(kLast == stdlib::kLastSystemVariable);

  // The last ranges are of units that have so many variables.
  template <class Do>
  [[gnu::always_inline]] void each_range(std::span<const int32_t> h, Do act) {
    [&]<size_t... n>(std::index_sequence<n...>) { (range<n>(h, act), ...); }
    (std::make_index_sequence<kRanges>());
  }
  template <size_t n, class Do>
  [[gnu::always_inline]] void range(std::span<const int32_t> h, Do& act) {
    constexpr Range kRange = kNoted[n];
    if (n + 1 == kRanges && h.size() <= kRange.last) return;
    act(noted_.data() + (kRange.first - kFirst), h.data() + kRange.first,
        std::integral_constant<size_t, kRange.last - kRange.first + 1>());
  }

  std::array<int32_t, kLast - kFirst + 1> noted_{};
};

}  // namespace ipos::runtime
