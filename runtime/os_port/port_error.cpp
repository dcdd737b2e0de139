// Texts of port errors.
#include "runtime/os_port/port_error.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>

namespace ipos::runtime {

PortError port_error(PortFault fault, std::string_view port, std::string_view detail) {
  static constexpr std::string_view kTexts[] = {
#define PORT_FAULT(name, text) text,
#include "runtime/os_port/port_faults.def"
  };
  std::string text = fmt::format("{}: {}", port, kTexts[static_cast<size_t>(fault)]);
  if (!detail.empty()) text += fmt::format(": {}", detail);
  return {fault, std::move(text)};
}

PortError system_error(int error, std::string_view port) {
  switch (error) {
    case EACCES:
    case EPERM: return port_error(PortFault::NoPermission, port, std::strerror(error));
    case ENOENT: return port_error(PortFault::NoSuchDevice, port);
    case EBUSY: return port_error(PortFault::InUse, port);
    case ENOTTY: return port_error(PortFault::NotSerial, port);
    case ENODEV:
    case ENXIO:
    case EIO: return port_error(PortFault::Gone, port, std::strerror(error));
    default: return port_error(PortFault::System, port, std::strerror(error));
  }
}

}  // namespace ipos::runtime
