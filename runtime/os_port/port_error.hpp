// Errors of ports as values: what went wrong, and one line of text for the user that names the port and,
// where there is one, the system's own reason.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace ipos::runtime {

enum class PortFault : uint8_t {
#define PORT_FAULT(name, text) name,
#include "runtime/os_port/port_faults.def"
};

struct PortError {
  PortFault fault;
  std::string text;
};

// `detail` says what to do or what was found; may be empty.
PortError port_error(PortFault fault, std::string_view port, std::string_view detail = {});

// From an errno value: those with a fault of their own get it, all others are System.
PortError system_error(int error, std::string_view port);

}  // namespace ipos::runtime
