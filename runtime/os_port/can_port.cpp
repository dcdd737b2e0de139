// From names to ports.
#include "runtime/os_port/can_port.hpp"

#include <charconv>

#include "runtime/os_port/adapter_port.hpp"
#include "runtime/os_port/port_names.hpp"
#include "runtime/os_port/slcan_adapter.hpp"
#include "runtime/os_port/slcan_client.hpp"
#include "runtime/os_port/socket_can.hpp"

namespace ipos::runtime {
namespace {

constexpr std::string_view kSlcan = "slcan:";
constexpr size_t kLongestInterface = 15;        // of Linux, IFNAMSIZ without the 0
constexpr uint32_t kSlcanSerialBaud = 115'200;  // of a device without @; USB adapters do not mind (ours)

CanPortResult open_slcan(std::string_view name, std::string_view device, uint32_t baud, RealClock& clock) {
  if (device.starts_with(kPtyPort))
    return SlcanAdapter::open(std::string(device.substr(kPtyPort.size())), baud, clock);
  uint32_t serial_baud = kSlcanSerialBaud;
  const size_t at = device.rfind('@');
  if (at != std::string_view::npos) {
    const std::string_view digits = device.substr(at + 1);
    const auto [end, status] = std::from_chars(digits.data(), digits.data() + digits.size(), serial_baud);
    if (status != std::errc() || end != digits.data() + digits.size())
      return tl::unexpected(port_error(PortFault::BadName, name, "write slcan:/dev/ttyUSB0@115200"));
    device = device.substr(0, at);
  }
  std::string path(device);
  if (!is_path(path))
    return tl::unexpected(
        port_error(PortFault::BadName, name, "write slcan:/dev/ttyACM0, slcan:./ttyACM0 or slcan:pty:/path"));
  return SlcanClient::open(std::move(path), serial_baud, baud, clock);
}

}  // namespace

CanPortResult open_can_port(std::string_view name, uint32_t baud, RealClock& clock) {
  if (name.starts_with(kSlcan)) return open_slcan(name, name.substr(kSlcan.size()), baud, clock);
  if (is_adapter_port(name)) return open_adapter_port(name, baud, clock);
  if (name.empty() || name.size() > kLongestInterface || name.find_first_of("/: ") != std::string_view::npos)
    return tl::unexpected(port_error(PortFault::BadName, name, kPortNames));
  return SocketCan::open(std::string(name), baud, clock);
}

}  // namespace ipos::runtime
