// Which lines each test executes, so that a mistake is only tried on tests that reach it.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "tools/coverage/coverage.hpp"
#include "tools/mutants/planting.hpp"

namespace ipos::tools::mutants {

class Reach {
 public:
  // Of each test, in their order.
  explicit Reach(const std::vector<coverage::Coverage>& tests);

  // Numbers of the tests that execute a line of the mistake; where its lines have no code of their own, as that of a
  // `break`, those that come into its function.
  std::vector<size_t> of(const Planted& planted) const;

 private:
  using LinesOfFiles = std::map<std::string, std::set<uint32_t>>;
  static bool has_one(const LinesOfFiles& files, const Lines& lines);

  std::vector<LinesOfFiles> executed_;  // by each test
  LinesOfFiles with_code_;
};

}  // namespace ipos::tools::mutants
