// As Windows tells it.
#include <windows.h>

#include <array>

#include "tools/fmu/libraries.hpp"

namespace ipos::tools {

std::filesystem::path program_folder() {
  std::array<wchar_t, 32768> path{};
  const DWORD size = GetModuleFileNameW(nullptr, path.data(), static_cast<DWORD>(path.size()));
  if (size == 0 || size == path.size()) return {};
  return std::filesystem::path(path.data()).parent_path();
}

}  // namespace ipos::tools
