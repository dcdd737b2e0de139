// The serial port `pty:/path`.
#pragma once

#include "runtime/os_port/serial_port.hpp"

namespace ipos::runtime {

SerialPortResult open_pty_port(std::string_view name, const SerialSettings& settings, RealClock& clock);

}  // namespace ipos::runtime
