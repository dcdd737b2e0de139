// Serial devices of Windows are COM1 and up.
#include "runtime/os_port/port_names.hpp"

#include <algorithm>

namespace ipos::runtime {

const std::string_view kPortNames = "a CAN port is slcan:COM3; a serial port is COM3 or COM3@16ms";

std::string device_path(std::string_view name) { return std::string(name.substr(0, name.rfind('@'))); }

bool is_path(const std::string& name) {
  const auto is_letter = [&](size_t at, char letter) { return (name[at] | 0x20) == letter; };
  return name.size() > 3 && is_letter(0, 'c') && is_letter(1, 'o') && is_letter(2, 'm') &&
         std::all_of(name.begin() + 3, name.end(), [](char c) { return c >= '0' && c <= '9'; });
}

PortKind kind_of_port(std::string_view name) {
  if (name.starts_with(kPtyPort)) return PortKind::Serial;
  return is_path(device_path(name)) ? PortKind::Serial : PortKind::Can;
}

}  // namespace ipos::runtime
