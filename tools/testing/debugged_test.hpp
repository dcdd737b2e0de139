// A test of `ipos test` under the debugger or on the page: its plant, and its script beside it, which does what the test does
// and says what is not as it expects.
#pragma once

#include <memory>
#include <string>

#include "tools/debugger/debugger.hpp"
#include "tools/testing/run_test.hpp"

namespace ipos::tools::testing {

// One test of a file; `name` chooses among its cases. A Failure says what can be chosen.
std::shared_ptr<const TestCase> chosen_test(const std::string& file, const std::string& name);

// Mistakes are printed, then a Failure ends the verb. Of the options only speed and seed count.
debug::Debuggee debugged_test(std::shared_ptr<const TestCase> test, const CompileFlags& compile, const RunOptions& options);

}  // namespace ipos::tools::testing
