// What the user has chosen to open pages with.
#include "tools/serve/browser.hpp"

#include <windows.h>

#include <shellapi.h>

namespace ipos::tools::serve {

void show_in_browser(const std::filesystem::path& file) {
  ShellExecuteW(nullptr, L"open", file.c_str(), nullptr, nullptr, SW_SHOWNORMAL);
}

}  // namespace ipos::tools::serve
