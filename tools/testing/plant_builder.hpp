// The plant of a test with its programs.
#pragma once

#include <memory>
#include <string>

#include "tools/testing/run_test.hpp"

namespace ipos::tools::testing {

struct BuiltPlant {
  std::unique_ptr<runtime::Plant> plant;  // null: `messages` say why
  std::string messages;
  std::vector<Finding> findings;  // about messages of the compiler
  size_t checks = 0;              // of them
};

BuiltPlant build_plant(const TestCase& test, Programs& programs, const RunOptions& options);

}  // namespace ipos::tools::testing
