// What all real ports have in common. A port never blocks: output waits in its queue, input in the system,
// until the loop comes by. What is lost is counted and told.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "runtime/os_port/port_error.hpp"
#include "runtime/os_port/port_notes.hpp"
#include "runtime/os_port/real_clock.hpp"

namespace ipos::runtime {

// Frames of a CAN port, bytes of a serial port.
struct PortCounts {
  uint64_t sent = 0;
  uint64_t received = 0;
  uint64_t lost_out = 0;  // not sent: queue full, interface down, refused
  uint64_t lost_in = 0;   // overrun before we could read them, or broken beyond reading
  uint64_t waited = 0;    // attempts at which the system had no room; sent later
};

class Port {
 public:
  virtual ~Port() = default;

  virtual const std::string& name() const = 0;
  virtual PortNeeds needs() const = 0;

  // Sends what waits, as far as the system takes it. An error is for good.
  virtual tl::expected<void, PortError> flush() = 0;

  // Why nothing goes through now, although the port may be of use again: "the interface is down". Empty: it is there.
  virtual std::string_view absence() const { return {}; }

  // Frames or bytes that wait to be sent.
  virtual size_t waiting() const = 0;

  virtual const PortCounts& counts() const = 0;
  virtual std::vector<std::string> take_notes() = 0;
  // At the end: how often came what was told once.
  virtual std::vector<std::string> repeats() const { return {}; }
};

}  // namespace ipos::runtime
