// $XDG_CONFIG_HOME/ipos/allow-fmu, else ~/.config/ipos/allow-fmu.
#include "tools/machines/posix/allowed.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace ipos::tools {
namespace {

namespace fs = std::filesystem;

fs::path home() {
  const char* home = std::getenv("HOME");
  return home == nullptr ? fs::path() : fs::path(home);
}

fs::path list() {
  const char* settings = std::getenv("XDG_CONFIG_HOME");
  const fs::path folder = settings != nullptr && *settings == '/' ? fs::path(settings) : home() / ".config";
  return folder.is_absolute() ? folder / "ipos" / "allow-fmu" : fs::path();
}

// What others may write gives no permission.
bool is_own(const fs::path& file) {
  struct stat found {};
  return !file.empty() && stat(file.c_str(), &found) == 0 && S_ISREG(found.st_mode) && found.st_uid == geteuid() &&
         (found.st_mode & (S_IWGRP | S_IWOTH)) == 0;
}

bool is_at_or_below(const fs::path& file, const fs::path& allowed) {
  const auto [end, ignored] = std::mismatch(allowed.begin(), allowed.end(), file.begin(), file.end());
  return end == allowed.end() || (std::next(end) == allowed.end() && end->empty());  // a folder with a slash at its end
}

}  // namespace

bool is_allowed(const std::string& fmu) {
  const fs::path file = list();
  if (!is_own(file)) return false;
  std::error_code error;
  const fs::path wanted = fs::canonical(fmu, error);
  if (error) return false;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    while (line.ends_with(' ') || line.ends_with('\r')) line.pop_back();
    if (line.empty() || line.front() == '#') continue;
    const fs::path path = line.starts_with("~/") ? home() / line.substr(2) : fs::path(line);
    const fs::path allowed = fs::canonical(path, error);
    if (!error && path.is_absolute() && is_at_or_below(wanted, allowed)) return true;
  }
  return false;
}

std::string where_to_allow() {
  const fs::path file = list();
  return file.empty() ? "" : ", or for good by a line in " + file.string() + " with its path or its folder";
}

}  // namespace ipos::tools
