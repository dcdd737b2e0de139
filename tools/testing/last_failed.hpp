// Which tests failed when they were run last, from one run of `ipos test` to the next in the same folder. The list lies in
// the user's cache, so that nothing is written among the tests.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "tools/test_file/test_case.hpp"
#include "tools/testing/result.hpp"

namespace ipos::tools::testing {

class LastFailed {
 public:
  // Reads the list of this folder; without one it is empty.
  explicit LastFailed(std::string folder);

  const std::set<std::string>& names() const { return names_; }
  // Those that passed leave the list, those that did not come in; the others stay. `results` are of one or more turns
  // of `tests`. A cache that cannot be written is no trouble of the tests.
  void update(const std::vector<TestCase>& tests, const std::vector<TestResult>& results);

 private:
  std::string folder_;
  std::set<std::string> names_;
};

}  // namespace ipos::tools::testing
