// Where the cache is, and the names in it.
#include "tools/cli/cache.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "tools/cli/failure.hpp"
#include "tools/cli/files.hpp"
#include "tools/cli/outputs.hpp"

namespace ipos::tools {
namespace {

namespace fs = std::filesystem;

// Empty without a place for it.
fs::path cache_folder() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  if (cache != nullptr && fs::path(cache).is_absolute()) return fs::path(cache) / "ipos";
  const char* local = std::getenv("LOCALAPPDATA");  // Windows
  if (local != nullptr && *local != 0) return fs::path(local) / "ipos";
  const char* home = std::getenv("HOME");
  return home == nullptr || *home == 0 ? fs::path() : fs::path(home) / ".cache" / "ipos";
}

fs::path file_of(std::string_view kind, std::string path) {
  constexpr size_t kLongest = 200;
  const auto divides = [](char c) { return c == '/' || c == '\\' || c == ':'; };
  std::replace_if(path.begin(), path.end(), divides, '%');
  if (path.size() > kLongest) path.erase(0, path.size() - kLongest);
  return cache_folder() / (std::string(kind) + path);
}

}  // namespace

std::string read_cache(std::string_view kind, const std::string& path) {
  if (cache_folder().empty()) return {};
  return try_read_file(file_of(kind, path).string()).value_or("");
}

void write_cache(std::string_view kind, const std::string& path, const std::string& text) {
  if (cache_folder().empty()) return;
  std::error_code error;
  if (text.empty()) {
    fs::remove(file_of(kind, path), error);
    return;
  }
  fs::create_directories(cache_folder(), error);
  try {
    rewrite_file(file_of(kind, path).string(), text);
  } catch (const Failure&) {
  }
}

}  // namespace ipos::tools
