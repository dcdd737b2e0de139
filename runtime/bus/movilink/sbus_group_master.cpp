// The sending half of master/slave operation, and the slave's scaling.
#include "runtime/bus/movilink/sbus_group_master.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/bus/movilink/identifiers.hpp"

namespace ipos::runtime {

GroupMaster::GroupMaster(FrameSender& sender, uint64_t tag, MasterSlaveDrive& drive)
    : sender_(sender), tag_(tag), drive_(drive) {}

std::string GroupMaster::configure(int32_t p750, uint8_t group, uint32_t baud) {
  group_ = group;
  const bool wanted = sends_over_sbus(p750);
  active_ = wanted && is_master_slave_rate(baud);
  if (!wanted || active_) return {};
  return fmt::format(
      "P750 = {}: no slave setpoints are sent at {} kbaud, master/slave needs 500 or 1000 kbaud", p750,
      baud / 1000);
}

void GroupMaster::send_setpoints(Time now) {
  sender_.withdraw(tag_);
  sender_.send(
      process_frame(sbus_identifier(Telegram::GroupProcessOutput, group_), drive_.setpoint_to_send(now)),
      tag_);
}

ProcessWords scaled_for_slave(ProcessWords words, int32_t p751) {
  const int64_t setpoint = int64_t{static_cast<int16_t>(words[1])} * p751 / 1000;
  words[1] = static_cast<uint16_t>(std::clamp<int64_t>(setpoint, INT16_MIN, INT16_MAX));
  return words;
}

}  // namespace ipos::runtime
