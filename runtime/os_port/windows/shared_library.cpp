// LoadLibrary.
#include "runtime/os_port/shared_library.hpp"

#include <fmt/format.h>
#include <windows.h>

namespace ipos::runtime {

tl::expected<SharedLibrary, std::string> SharedLibrary::load(const std::string& name) {
  SetDllDirectoryW(L"");  // not out of the current folder, where anybody may have put one
  if (const HMODULE handle = LoadLibraryW(std::wstring(name.begin(), name.end()).c_str()))
    return SharedLibrary(handle);
  switch (const DWORD error = GetLastError()) {
    case ERROR_MOD_NOT_FOUND: return tl::unexpected(name + " is not found");
    case ERROR_BAD_EXE_FORMAT: return tl::unexpected(name + " is none for 64-bit programs");
    default: return tl::unexpected(fmt::format("{}: error {} of Windows", name, error));
  }
}

void* SharedLibrary::find(const char* function) const {
  return reinterpret_cast<void*>(GetProcAddress(static_cast<HMODULE>(handle_), function));
}

}  // namespace ipos::runtime
