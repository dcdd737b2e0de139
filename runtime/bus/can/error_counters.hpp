// Fault confinement of one CAN controller (ISO 11898-1): the two error counters and the states they decide.
#pragma once

#include <algorithm>
#include <cstdint>

namespace ipos::runtime {

enum class ErrorState : uint8_t { Active, Passive, BusOff };

struct ErrorCounters {
  uint32_t transmit = 0;
  uint32_t receive = 0;

  ErrorState state() const {
    if (transmit > 255) return ErrorState::BusOff;
    return transmit > 127 || receive > 127 ? ErrorState::Passive : ErrorState::Active;
  }
  bool untouched() const { return (transmit | receive) == 0; }
  void sent() { transmit -= transmit > 0 ? 1 : 0; }
  void send_failed() { transmit += 8; }
  // An error-passive sender that misses the acknowledge and sees no dominant bit during its flag does not
  // count: so a lone station stays on the bus at 128 for ever.
  void not_acknowledged() { transmit += state() == ErrorState::Active ? 8 : 0; }
  void received() { receive = receive > 127 ? 127 : receive - (receive > 0 ? 1 : 0); }
  // `first`: its own flag was the first one, so it sees a dominant bit after it.
  void receive_failed(bool first = false) { receive = std::min(receive + (first ? 9U : 1U), 255U); }
};

}  // namespace ipos::runtime
