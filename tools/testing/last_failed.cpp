// The path of the folder, then a name a line.
#include "tools/testing/last_failed.hpp"

#include <map>
#include <sstream>

#include "tools/cli/cache.hpp"

namespace ipos::tools::testing {
namespace {

constexpr std::string_view kKind = "last-failed";

}  // namespace

LastFailed::LastFailed(std::string folder) : folder_(std::move(folder)) {
  std::istringstream lines(read_cache(kKind, folder_));
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
  std::string text = names_.empty() ? "" : folder_ + "\n";
  for (const std::string& name : names_) text += name + "\n";
  write_cache(kKind, folder_, text);
}

}  // namespace ipos::tools::testing
