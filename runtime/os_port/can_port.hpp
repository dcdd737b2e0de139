// A CAN bus of the real world: a SocketCAN interface, an slcan adapter on a serial device, the adapter's
// end of slcan on a pseudo-terminal, to which other programs attach, or an adapter that its maker's library drives.
#pragma once

#include <memory>
#include <optional>
#include <string_view>

#include "runtime/bus/can/frame.hpp"
#include "runtime/os_port/can_error_frame.hpp"
#include "runtime/os_port/port.hpp"

namespace ipos::runtime {

struct CanArrival {
  Time at;  // host time of arrival: the kernel's stamp where it gives one, else when it was read; never
            // decreases
  std::optional<Time>
      device_time;  // of the controller's or adapter's own clock: only differences mean something
  std::optional<CanErrorFrame> error;  // then there is no frame
  Frame frame;
};

class CanPort : public Port {
 public:
  // Queues the frame after those that wait, and sends what it can. A frame that finds the queue full is
  // lost, counted and told. Frames sent never come back through receive().
  virtual void send(const Frame& frame) = 0;

  // The next arrival in order, or nothing: then there is none now, or the others are to have their turn. What
  // is left in the system wakes the loop at once. So the work between two "nothing" is bounded, whatever the
  // other end does. An error is for good.
  virtual tl::expected<std::optional<CanArrival>, PortError> receive() = 0;
};

inline constexpr size_t kCanPortQueue = 1024;  // frames waiting to be sent (ours)

using CanPortResult = tl::expected<std::unique_ptr<CanPort>, PortError>;

// `vcan0`, `can0`: a SocketCAN interface; `slcan:/dev/ttyACM0` or `slcan:/dev/ttyUSB0@115200`: an adapter;
// `slcan:pty:/path`: the adapter's end, linked at that path; `pcan:USB1`, `kvaser:0`, ...: adapters/can_adapters.def. `baud` is the rate of the bus. The clock must
// outlive the port.
CanPortResult open_can_port(std::string_view name, uint32_t baud, RealClock& clock);

}  // namespace ipos::runtime
