// The system variables that drive, positioning, PID controller and mirrored parameters follow or show, as
// they were before the tasks ran: while they are the same nobody has to look what the program has written.
// The others (timers, scope, analog outputs, H522 to H530) may change.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <span>

#include "stdlib/system_variables.hpp"

namespace ipos::runtime {

class NotedVariables {
 public:
  void note(std::span<const int32_t> h) {
    each(h, [](int32_t* noted, const int32_t* now, size_t bytes) {
      std::memcpy(noted, now, bytes);
      return true;
    });
  }
  bool same(std::span<const int32_t> h) {
    return each(h, [](const int32_t* noted, const int32_t* now, size_t bytes) {
      return std::memcmp(noted, now, bytes) == 0;
    });
  }

 private:
  template <size_t first, size_t last, class Do>
  bool range(std::span<const int32_t> h, Do act) {
    return act(noted_.data() + (first - kFirst), h.data() + first, (last - first + 1) * sizeof(int32_t));
  }
  template <class Do>
  bool each(std::span<const int32_t> h, Do act) {
    using stdlib::system_variable;
    return range<kFirst, system_variable("ModCount")>(h, act) &&
           range<system_variable("StatusWord"), system_variable("StatusWord")>(h, act) &&
           range<system_variable("OptOutpIPOS"), system_variable("ControlWord")>(h, act) &&
           range<system_variable("SetpointPos"), system_variable("ActPos_Mot")>(h, act) &&
           (h.size() <= kLast || range<system_variable("PID_Mode"), kLast>(h, act));
  }

  static constexpr size_t kFirst = stdlib::system_variable("ModuloCtrl");
  static constexpr size_t kLast = stdlib::system_variable("SyncGearSlave");  // MOVIDRIVE B
  std::array<int32_t, kLast - kFirst + 1> noted_{};
};

}  // namespace ipos::runtime
