// One channel of a CAN adapter, as the library of its maker gives it. The libraries differ in their functions, numbers and
// structures, and in nothing that a port would have to know: each has a class of this interface.
//
// Their declarations stand beside it in *_api.hpp. They are ours, written after the makers' public documents, which are
// named there. On 64-bit Windows all functions have the one calling convention of the system; __stdcall, with which the
// documents print them, means something to 32-bit programs only, and there is no such build.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

#include "runtime/os_port/can_port.hpp"
#include "runtime/os_port/shared_library.hpp"

namespace ipos::runtime {

// Of its CAN controller (ISO 11898-1).
enum class ControllerState : uint8_t { Active, Warning, Passive, Off };

class AdapterChannel {
 public:
  virtual ~AdapterChannel() = default;

  // None of these waits. An error with the fault Refused concerns this call alone; any other one is for good.

  // False: the library has no room for the frame now.
  virtual tl::expected<bool, PortError> write(const Frame& frame) = 0;
  // What has come, in order, without `at`; nothing: there is none now.
  virtual tl::expected<std::optional<CanArrival>, PortError> read() = 0;
  virtual tl::expected<ControllerState, PortError> state() = 0;
  // Takes part in the bus again after bus-off.
  virtual tl::expected<void, PortError> restart() = 0;
};

// What a port wants.
struct ChannelWish {
  std::string port;     // its name, for messages
  std::string channel;  // what stands behind the prefix
  uint32_t baud = 0;
  PortNotes& notes;  // what the adapter or its driver does not have
};

using ChannelResult = tl::expected<std::unique_ptr<AdapterChannel>, PortError>;

namespace pcan {
ChannelResult open(const SharedLibrary& library, const ChannelWish& wish);
}
namespace vector {
ChannelResult open(const SharedLibrary& library, const ChannelWish& wish);
}
namespace kvaser {
ChannelResult open(const SharedLibrary& library, const ChannelWish& wish);
}
namespace ixxat {
ChannelResult open(const SharedLibrary& library, const ChannelWish& wish);
}

// --- what they have in common

std::optional<uint32_t> channel_number(std::string_view text);

// "there are 0 and 1" for those that want another channel.
PortError no_such_channel(const ChannelWish& wish, const std::vector<std::string>& there);
PortError no_such_rate(const ChannelWish& wish);
PortError lacks_function(const ChannelWish& wish, const std::string& function);

// Bit timing registers BTR0 (high byte) and BTR1 of an SJA1000 at 16 MHz, which PCAN-Basic and VCI take whatever the
// controller is: one sample at 87 % of the bit (80 % at 800 kbit/s, 75 % at 1 Mbit/s), as CiA 301 recommends it.
std::optional<uint16_t> sja1000_timing(uint32_t baud);

// Error frames as Linux has them (linux/can/error.h).
CanArrival error_arrival(uint32_t classes, uint8_t controller = 0, uint8_t protocol = 0);
CanArrival overrun_arrival();

// A counter of 32 bits that begins again; more often than we read it, it does not.
class WideTicks {
 public:
  uint64_t extend(uint32_t ticks) {
    if (ticks < last_) base_ += uint64_t{1} << 32;
    last_ = ticks;
    return base_ + ticks;
  }

 private:
  uint64_t base_ = 0;
  uint32_t last_ = 0;
};

}  // namespace ipos::runtime
