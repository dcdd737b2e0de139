// The serial devices of Windows that are there: COM1, COM3.
#pragma once

#include <string>
#include <vector>

namespace ipos::runtime {

std::vector<std::string> serial_devices();

}  // namespace ipos::runtime
