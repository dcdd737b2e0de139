// The system variables that drive, positioning, PID controller and mirrored parameters follow or show, as
// they were before the tasks ran: while they are the same nobody has to look what the program has written.
// The others (timers, scope, analog outputs, H522 to H530) may change.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <utility>

#include "stdlib/system_variables.hpp"

namespace ipos::runtime {

class NotedVariables {
 public:
  // All of them lie between these.
  static constexpr size_t kFirst = stdlib::system_variable("ModuloCtrl");
  static constexpr size_t kLast = stdlib::system_variable("SyncGearSlave");  // MOVIDRIVE B

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

  template <size_t first, size_t last, class Do>
  [[gnu::always_inline]] void range(std::span<const int32_t> h, Do& act) {
    act(noted_.data() + (first - kFirst), h.data() + first,
        std::integral_constant<size_t, last - first + 1>());
  }
  template <class Do>
  [[gnu::always_inline]] void each_range(std::span<const int32_t> h, Do act) {
    using stdlib::system_variable;
    range<kFirst, system_variable("ModCount")>(h, act);
    range<system_variable("StatusWord"), system_variable("StatusWord")>(h, act);
    range<system_variable("OptOutpIPOS"), system_variable("ControlWord")>(h, act);
    range<system_variable("SetpointPos"), system_variable("ActPos_Mot")>(h, act);
    if (h.size() > kLast) range<system_variable("PID_Mode"), kLast>(h, act);
  }

  std::array<int32_t, kLast - kFirst + 1> noted_{};
};

}  // namespace ipos::runtime
