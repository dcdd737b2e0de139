// What the adapters have in common.
#include "runtime/os_port/adapters/adapter_channel.hpp"

#include <fmt/format.h>
#include <linux/can/error.h>

#include <charconv>

namespace ipos::runtime {

std::optional<uint32_t> channel_number(std::string_view text) {
  uint32_t number = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, status] = std::from_chars(text.data(), end, number);
  if (status != std::errc() || stop != end) return std::nullopt;
  return number;
}

PortError no_such_channel(const ChannelWish& wish, const std::vector<std::string>& there) {
  return port_error(PortFault::NoSuchChannel, wish.port,
                    there.empty() ? "no adapter is plugged in"
                                  : fmt::format("there is {}", fmt::join(there, ", ")));
}

PortError no_such_rate(const ChannelWish& wish) {
  return port_error(PortFault::NoBaudRate, wish.port, fmt::format("{} bit/s", wish.baud));
}

PortError lacks_function(const ChannelWish& wish, const std::string& function) {
  return port_error(PortFault::OldLibrary, wish.port, function);
}

std::optional<uint16_t> sja1000_timing(uint32_t baud) {
  switch (baud) {
    case 10'000: return 0x311C;
    case 20'000: return 0x181C;
    case 50'000: return 0x091C;
    case 100'000: return 0x041C;
    case 125'000: return 0x031C;
    case 250'000: return 0x011C;
    case 500'000: return 0x001C;
    case 800'000: return 0x0016;
    case 1'000'000: return 0x0014;
    default: return std::nullopt;
  }
}

CanArrival error_arrival(uint32_t classes, uint8_t controller, uint8_t protocol) {
  CanArrival arrival{};
  arrival.error = CanErrorFrame{classes, {0, controller, protocol}};
  return arrival;
}

CanArrival overrun_arrival() { return error_arrival(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_OVERFLOW); }

}  // namespace ipos::runtime
