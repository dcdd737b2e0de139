// Ports that only Linux has: each says so.
#include "runtime/os_port/port_names.hpp"
#include "runtime/os_port/pty_port.hpp"
#include "runtime/os_port/slcan_adapter.hpp"
#include "runtime/os_port/socket_can.hpp"

namespace ipos::runtime {

CanPortResult SocketCan::open(std::string name, uint32_t, RealClock&) {
  return tl::unexpected(port_error(PortFault::NotOnWindows, name, kPortNames));
}

CanPortResult SlcanAdapter::open(const std::string& path, uint32_t, RealClock&) {
  return tl::unexpected(port_error(PortFault::NotOnWindows, "slcan:pty:" + path, kPortNames));
}

SerialPortResult open_pty_port(std::string_view name, const SerialSettings&, RealClock&) {
  return tl::unexpected(port_error(PortFault::NotOnWindows, name, kPortNames));
}

}  // namespace ipos::runtime
