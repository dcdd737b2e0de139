// What kind of port a name means, for those who take both kinds. docs/guide/ports.md lists the names.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace ipos::runtime {

// After "is no name of a port": both kinds, as the user may have meant the other one.
extern const std::string_view kPortNames;

// Before the path of a pseudo-terminal.
inline constexpr std::string_view kPtyPort = "pty:";

enum class PortKind : uint8_t { Can, Serial };

// Serial: a pseudo-terminal, a path, or the name of a device in the current folder; on Windows COM1 and up. CAN: anything
// else.
PortKind kind_of_port(std::string_view name);

// Without what stands after an @: "/dev/ttyUSB0" of "/dev/ttyUSB0@16ms".
std::string device_path(std::string_view name);

// A path, or a file of this name in the current folder. Anything else may be meant to be in /dev. On Windows COM1 and up.
bool is_path(const std::string& name);

// Whether a serial device of this name is there, for those who take files by the same option. On Windows any COM1 and up.
bool is_device(std::string_view name);

}  // namespace ipos::runtime
