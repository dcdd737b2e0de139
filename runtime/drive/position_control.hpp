// What the positioning of IPOS, or synchronous operation, orders of the drive, every millisecond. The logic of enable
// stays above it: stop, rapid stop, inhibit and faults win.
#pragma once

#include <cstdint>

#include "runtime/drive/control.hpp"

namespace ipos::runtime {

struct PositionControl {
  // The enabled axis follows `speed`; setpoint source, ramps and minimum speed do not count.
  bool controls = false;
  int32_t speed = 0;               // 1/1000 rpm, positive is CW of the motor
  // _AxisStop: RapidStop or HoldControl as long as it lasts. Stop: a slave in synchronous operation that has to stand.
  Command halt = Command::Enable;
  bool in_position = false;        // for the outputs
  bool referenced = false;
  uint32_t output_flags = 0;  // more for the outputs (outputs.hpp)

  bool operator==(const PositionControl&) const = default;
};

}  // namespace ipos::runtime
