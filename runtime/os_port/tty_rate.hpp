// Any rate of a serial device: termios2 of Linux (ioctl_tty(2), BOTHER), for the rates that termios(3) has no name for,
// such as 93.75 and 187.5 kbaud of PROFIBUS. A file of its own, as the kernel's header and <termios.h> exclude each other.
#pragma once

#include <cstdint>
#include <string>

#include <tl/expected.hpp>

namespace ipos::runtime {

// Sets the rate in both directions, and leaves the other settings. The rate that the device has then, which a driver may
// have rounded to what its clock can do; or errno.
tl::expected<uint32_t, int> set_any_rate(int descriptor, uint32_t baud);

// Of the protocols here, and of USB adapters (ours).
inline constexpr uint32_t kSlowestRate = 9'600, kFastestRate = 4'000'000;

// Why a device is refused that has made `got` of the rate.
inline std::string other_rate(uint32_t wanted, uint32_t got) {
  return std::to_string(wanted) + " bit/s: it makes " + std::to_string(got) +
         " of it; an adapter with another clock is needed";
}

// Whether two stations at these rates understand each other: within 1 % (ours; a character of 11 bits bears less than
// half a bit between both ends, 4.5 %, and the other end has its share).
constexpr bool is_close_rate(uint32_t wanted, uint32_t got) {
  const uint32_t difference = wanted > got ? wanted - got : got - wanted;
  return uint64_t{100} * difference <= wanted;
}

}  // namespace ipos::runtime
