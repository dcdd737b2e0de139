// What kind of port a name means, for those who take both kinds. docs/guide/ports.md lists the names.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace ipos::runtime {

// Behind "is no name of a port": both kinds, as the user may have meant the other one.
inline constexpr std::string_view kPortNames =
    "a CAN port is can0, vcan0, slcan:/dev/ttyACM0 or slcan:pty:/path; a serial port is /dev/ttyUSB0, "
    "/dev/ttyUSB0@16ms, ./tty1 or pty:/path";

// Before the path of a pseudo-terminal.
inline constexpr std::string_view kPtyPort = "pty:";

enum class PortKind : uint8_t { Can, Serial };

// Serial: a pseudo-terminal, a path, or the name of a device in the current folder. CAN: anything else.
PortKind kind_of_port(std::string_view name);

// Without what stands behind an @: "/dev/ttyUSB0" of "/dev/ttyUSB0@16ms".
std::string device_path(std::string_view name);

// A path, or a file of this name in the current folder. Anything else may be meant to be in /dev.
bool is_path(const std::string& name);

}  // namespace ipos::runtime
