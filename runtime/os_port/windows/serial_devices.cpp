// As the drivers have registered them.
#include "runtime/os_port/windows/serial_devices.hpp"

#include <windows.h>

#include <algorithm>
#include <array>

#include "runtime/os_port/port_names.hpp"

namespace ipos::runtime {

std::vector<std::string> serial_devices() {
  std::vector<std::string> names;
  HKEY key = nullptr;
  if (RegOpenKeyExW(HKEY_LOCAL_MACHINE, L"HARDWARE\\DEVICEMAP\\SERIALCOMM", 0, KEY_READ, &key) != ERROR_SUCCESS)
    return names;
  for (DWORD index = 0;; ++index) {
    std::array<wchar_t, 256> driver{}, device{};
    DWORD driver_size = driver.size(), size = sizeof device - sizeof device[0], type = 0;
    if (RegEnumValueW(key, index, driver.data(), &driver_size, nullptr, &type,
                      reinterpret_cast<BYTE*>(device.data()), &size) != ERROR_SUCCESS)
      break;
    std::string name;
    for (size_t n = 0; type == REG_SZ && device[n] != 0; ++n) name += static_cast<char>(device[n]);
    if (is_path(name)) names.push_back(name);
  }
  RegCloseKey(key);
  std::sort(names.begin(), names.end(), [](const std::string& one, const std::string& other) {
    return std::pair(one.size(), one) < std::pair(other.size(), other);
  });
  return names;
}

}  // namespace ipos::runtime
