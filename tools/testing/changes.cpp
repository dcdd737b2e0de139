// Looks at the files again and again: that works on every file system, and tests are few.
#include "tools/testing/changes.hpp"

#include <chrono>
#include <filesystem>
#include <thread>

#include "tools/cli/files.hpp"
#include "tools/cli/interrupt.hpp"
#include "tools/input/program.hpp"

namespace ipos::tools::testing {
namespace {

namespace fs = std::filesystem;

bool matters(const std::string& path) {
  return is_source(path) || path.ends_with(".toml") || path.ends_with(".h") || path.ends_with(".ipx");
}

std::string folder_of(const std::string& path) { return fs::path(path).parent_path().string(); }

std::vector<std::string> files_of(const std::string& folder, bool with_all_below) {
  if (with_all_below) return files_below(folder);
  std::vector<std::string> files;
  for (const std::string& name : list_files(folder)) files.push_back((fs::path(folder) / name).string());
  return files;
}

}  // namespace

Changes::Changes(const std::vector<std::string>& paths) {
  for (const std::string& path : paths) add(is_folder(path) ? path : folder_of(path), is_folder(path));
}

void Changes::add(const std::vector<TestCase>& tests) {
  for (const TestCase& test : tests) {
    add(folder_of(test.file), false);
    add(folder_of(test.plant_path), false);
    for (const runtime::StationConfig& station : test.plant.stations)
      add(folder_of(beside(test.plant_path, station.program)), false);
  }
}

void Changes::add(const std::string& folder, bool with_all_below) {
  if (folders_.emplace(folder, with_all_below).second) before_.merge(look(folder, with_all_below));
}

Changes::Files Changes::look(const std::string& folder, bool with_all_below) {
  Files files;
  for (const std::string& path : files_of(folder, with_all_below)) {
    std::error_code error;  // it may just have been removed
    const auto time = static_cast<int64_t>(fs::last_write_time(path, error).time_since_epoch().count());
    if (matters(path)) files.emplace(path, Stamp(time, fs::file_size(path, error)));
  }
  return files;
}

Changes::Files Changes::look() const {
  Files files;
  for (const auto& [folder, with_all_below] : folders_) files.merge(look(folder, with_all_below));
  return files;
}

bool Changes::wait() {
  constexpr std::chrono::milliseconds kPause(200);
  for (; !interrupted(); std::this_thread::sleep_for(kPause))
    if (Files now = look(); now != before_) {
      before_ = std::move(now);
      return true;
    }
  return false;
}

}  // namespace ipos::tools::testing
