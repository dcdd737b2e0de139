// The master of master/slave operation over SBus: a group telegram every millisecond with control word and
// setpoint (1053 1610 p. 50, P750 and P751 on p. 80). Words (11264926 p. 29): control word 1, speed or
// current setpoint, IPOS PO-data.
#pragma once

#include <cstdint>
#include <string>

#include "runtime/bus/can/node.hpp"
#include "runtime/bus/movilink/master_slave.hpp"
#include "runtime/bus/movilink/process_data.hpp"
#include "runtime/clock/event_queue.hpp"

namespace ipos::runtime {

// P750: 0 off, then speed, torque and load sharing, each over RS-485, SBus and both.
constexpr bool sends_over_sbus(int32_t p750) { return p750 >= 1 && p750 <= 9 && p750 % 3 != 1; }

// Permitted are 500 and 1000 kbaud.
constexpr bool is_master_slave_rate(uint32_t baud) { return baud == 500'000 || baud == 1'000'000; }

class GroupMaster {
 public:
  GroupMaster(FrameSender& sender, uint64_t tag, MasterSlaveDrive& drive);

  // With P750, P814 and the rate of the line; why it does not send although P750 asks for it, or empty.
  std::string configure(int32_t p750, uint8_t group, uint32_t baud);
  bool active() const { return active_; }

  // Once a millisecond. A telegram that still waits for the line is overtaken by the new setpoint.
  void tick(Time now) {
    if (active_) send_setpoints(now);
  }

 private:
  void send_setpoints(Time now);

  FrameSender& sender_;
  uint64_t tag_;
  MasterSlaveDrive& drive_;
  bool active_ = false;
  uint8_t group_ = 0;
};

// The words of a group telegram in a slave with P751 in thousandths: the setpoint scaled, limited to 16 bits,
// rounded toward zero (ours: both, and that the slave scales).
ProcessWords scaled_for_slave(ProcessWords words, int32_t p751);

}  // namespace ipos::runtime
