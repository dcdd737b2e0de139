// The master's end of the master/slave link.
#include "runtime/bus/movilink/master_slave.hpp"

#include <utility>

namespace ipos::runtime {

void SetpointSender::start(Time now, uint8_t group) {
  if (running()) return;
  group_ = group;
  timer_ = queue_.schedule(now, source_, *this, 0);
}

void SetpointSender::stop() { queue_.cancel(std::exchange(timer_, kNoEvent)); }

void SetpointSender::on_event(Time now, uint32_t /*kind*/, uint64_t /*argument*/) {
  timer_ = queue_.schedule(now + kSetpointCycle, source_, *this, 0);
  if (std::exchange(waiting_, true)) return;
  SerialTelegram telegram;
  telegram.address = group_;
  telegram.format = kSetpointFormat;
  telegram.words = drive_.setpoint_to_send(now);
  requester_.start(now, telegram, *this);
}

void SetpointSender::on_request_done(Time /*now*/, RequestEnd /*end*/, const SerialTelegram* /*response*/) {
  waiting_ = false;
}

}  // namespace ipos::runtime
