// By the form of the name, and by what there is in the current folder.
#include "runtime/os_port/port_names.hpp"

#include <sys/stat.h>

namespace ipos::runtime {

const std::string_view kPortNames =
    "a CAN port is can0, vcan0, slcan:/dev/ttyACM0, slcan:pty:/path, pcan:USB1 or kvaser:0; a serial port is /dev/ttyUSB0, "
    "/dev/ttyUSB0@16ms, ./tty1 or pty:/path";

std::string device_path(std::string_view name) { return std::string(name.substr(0, name.rfind('@'))); }

bool is_path(const std::string& name) {
  struct stat status {};
  return name.find('/') != std::string::npos || (!name.empty() && stat(name.c_str(), &status) == 0);
}

bool is_device(std::string_view name) {
  struct stat status {};
  return stat(device_path(name).c_str(), &status) == 0;
}

PortKind kind_of_port(std::string_view name) {
  if (name.starts_with("slcan:")) return PortKind::Can;
  if (name.starts_with("pty:")) return PortKind::Serial;
  return is_path(device_path(name)) ? PortKind::Serial : PortKind::Can;
}

}  // namespace ipos::runtime
