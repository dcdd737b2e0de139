// A browser has no real ports: each says so.
#include "runtime/os_port/adapter_port.hpp"
#include "runtime/os_port/port_names.hpp"
#include "runtime/os_port/pty_port.hpp"
#include "runtime/os_port/slcan_adapter.hpp"
#include "runtime/os_port/socket_can.hpp"
#include "runtime/os_port/tty.hpp"

namespace ipos::runtime {
namespace {

tl::unexpected<PortError> absent(std::string_view name) {
  return tl::unexpected(port_error(PortFault::NotInBrowsers, name));
}

}  // namespace

CanPortResult SocketCan::open(std::string name, uint32_t, RealClock&) { return absent(name); }

CanPortResult SlcanAdapter::open(const std::string& path, uint32_t, RealClock&) { return absent("slcan:pty:" + path); }

CanPortResult open_adapter_port(std::string_view name, uint32_t, RealClock&, const std::string&) { return absent(name); }

SerialPortResult open_pty_port(std::string_view name, const SerialSettings&, RealClock&) { return absent(name); }

struct Tty::System {};
tl::expected<Tty, PortError> Tty::open(const std::string& path, const TtySettings&, PortNotes&) { return absent(path); }
Tty::~Tty() = default;
Tty::Tty(Tty&&) noexcept = default;
tl::expected<size_t, int> Tty::read(std::span<char>) { return size_t{0}; }
tl::expected<size_t, int> Tty::write(std::string_view) { return size_t{0}; }
int Tty::descriptor() const { return -1; }

}  // namespace ipos::runtime
