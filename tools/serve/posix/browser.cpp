// xdg-open.
#include "tools/serve/browser.hpp"

#include <unistd.h>

#include <cstdio>

namespace ipos::tools::serve {

void show_in_browser(const std::filesystem::path& file) {
  const pid_t opener = fork();
  if (opener != 0) return;
  setsid();
  if (freopen("/dev/null", "w", stdout) == nullptr || freopen("/dev/null", "w", stderr) == nullptr) _exit(1);
  execlp("xdg-open", "xdg-open", file.c_str(), static_cast<char*>(nullptr));
  _exit(1);
}

}  // namespace ipos::tools::serve
