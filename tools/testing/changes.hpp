// Waits until a file of the tests changes: for `ipos test --watch`.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tools/test_file/test_case.hpp"

namespace ipos::tools::testing {

class Changes {
 public:
  // `paths` as they are on the command line: folders with all below them, the folders of files. What changes from now on
  // counts, also while tests run.
  explicit Changes(const std::vector<std::string>& paths);

  // The folders of their plants and programs count from now on, too.
  void add(const std::vector<TestCase>& tests);

  // False: Ctrl-C came first.
  bool wait();

 private:
  using Stamp = std::pair<int64_t, uintmax_t>;  // time of the last change, size
  using Files = std::map<std::string, Stamp>;

  void add(const std::string& folder, bool with_all_below);
  static Files look(const std::string& folder, bool with_all_below);
  Files look() const;

  std::map<std::string, bool> folders_;  // whether with all below them
  Files before_;
};

}  // namespace ipos::tools::testing
