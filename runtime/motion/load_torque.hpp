// The static torque of the load by speed or by place ([station.load] torque_by). In integers and without a library's sine,
// so that each build gives the same.
#pragma once

#include <cstdint>

#include "runtime/motion/fine_speed.hpp"
#include "runtime/motion/machine_data.hpp"

namespace ipos::runtime {

// 2^20 x the sine of a 2^32nd of a turn.
int64_t sine(uint32_t angle);

// `place`: increments of the motor from the machine's zero. Positive pulls counter-clockwise.
int64_t load_torque(const MachineData& machine, FineSpeed speed, int32_t place);

}  // namespace ipos::runtime
