// ipos test --mutate: plants mistakes into the programs of tests, and tells which no test notices.
#pragma once

#include <string>
#include <vector>

#include "tools/testing/suite.hpp"

namespace ipos::tools {

struct MutateFlags {
  testing::SuiteOptions suite;
  bool list = false;
  bool github = false;
  std::string root;   // of the repository, for GitHub
  std::string junit;  // reports; - is standard output, which then has nothing else
  std::string json;
  std::string html;
};

int mutate(const std::vector<testing::TestCase>& tests, const MutateFlags& flags);

}  // namespace ipos::tools
