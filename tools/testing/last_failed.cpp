// A file a folder, in $XDG_CACHE_HOME/ipos or ~/.cache/ipos: the path of the folder, then a name a line.
#include "tools/testing/last_failed.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <sstream>

#include "tools/cli/failure.hpp"
#include "tools/cli/files.hpp"
#include "tools/cli/outputs.hpp"

namespace ipos::tools::testing {
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

// Long paths keep their end; the first line of the file tells two of them apart.
fs::path list_of(std::string folder) {
  constexpr size_t kLongest = 200;
  const auto divides = [](char c) { return c == '/' || c == '\\' || c == ':'; };
  std::replace_if(folder.begin(), folder.end(), divides, '%');
  if (folder.size() > kLongest) folder.erase(0, folder.size() - kLongest);
  return cache_folder() / ("last-failed" + folder);
}

}  // namespace

LastFailed::LastFailed(std::string folder) : folder_(std::move(folder)) {
  std::istringstream lines(cache_folder().empty() ? ""
                                                  : try_read_file(list_of(folder_).string()).value_or(""));
  std::string line;
  if (!std::getline(lines, line) || line != folder_) return;
  while (std::getline(lines, line)) names_.insert(line);
}

void LastFailed::update(const std::vector<TestCase>& tests, const std::vector<TestResult>& results) {
  std::map<std::string, bool> passed;
  for (size_t n = 0; n < results.size(); ++n) {
    if (results[n].outcome == Outcome::NotRun) continue;
    const auto known = passed.emplace(tests[n % tests.size()].name, true).first;
    known->second = known->second && results[n].outcome == Outcome::Passed;
  }
  for (const auto& [name, good] : passed) {
    if (good)
      names_.erase(name);
    else
      names_.insert(name);
  }
  if (cache_folder().empty()) return;
  std::error_code error;
  if (names_.empty()) {
    fs::remove(list_of(folder_), error);
    return;
  }
  std::string text = folder_ + "\n";
  for (const std::string& name : names_) text += name + "\n";
  fs::create_directories(cache_folder(), error);
  try {
    rewrite_file(list_of(folder_).string(), text);
  } catch (const Failure&) {
  }
}

}  // namespace ipos::tools::testing
