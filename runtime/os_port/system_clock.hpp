// The clock of this machine. The tools make one and hand it down; nothing else reads a clock.
#pragma once

#include "runtime/os_port/real_clock.hpp"

namespace ipos::runtime {

class SystemClock final : public RealClock {
 public:
  Time now() override;
  Time wall() override;
  void wait(Time until, std::span<const PortNeeds> ports) override;
};

}  // namespace ipos::runtime
