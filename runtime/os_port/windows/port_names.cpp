// Serial devices of Windows are COM1 and up, also written \\.\COM1.
#include "runtime/os_port/port_names.hpp"

#include <algorithm>

namespace ipos::runtime {

const std::string_view kPortNames =
    "a CAN port is slcan:COM3, pcan:USB1, vector:0, kvaser:0 or ixxat:0; a serial port is COM3 or COM3@16ms";

std::string device_path(std::string_view name) { return std::string(name.substr(0, name.rfind('@'))); }

bool is_path(const std::string& name) {
  constexpr std::string_view kPrefix = "\\\\.\\";
  const std::string_view device = std::string_view(name).substr(name.starts_with(kPrefix) ? kPrefix.size() : 0);
  const auto is_letter = [&](size_t at, char letter) { return (device[at] | 0x20) == letter; };
  return device.size() > 3 && is_letter(0, 'c') && is_letter(1, 'o') && is_letter(2, 'm') &&
         std::all_of(device.begin() + 3, device.end(), [](char c) { return c >= '0' && c <= '9'; });
}

bool is_device(std::string_view name) { return is_path(device_path(name)); }

PortKind kind_of_port(std::string_view name) {
  if (name.starts_with(kPtyPort)) return PortKind::Serial;
  return is_path(device_path(name)) ? PortKind::Serial : PortKind::Can;
}

}  // namespace ipos::runtime
