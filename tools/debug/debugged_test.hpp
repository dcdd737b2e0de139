// A test of `ipos test` under the debugger: its plant, and its script beside it, which does what the test does and says what
// is not as it expects.
#pragma once

#include <string>

#include "tools/debugger/debugger.hpp"
#include "tools/input/program.hpp"

namespace ipos::tools::debug {

// One test of a file *.test.toml; `name` chooses among its cases. Mistakes are printed, then a Failure ends the verb.
// `speed`: commands per ms of every task where the test does not say; 0: P938 and P939.
Debuggee debugged_test(const std::string& file, const std::string& name, const CompileFlags& compile, uint32_t speed);

}  // namespace ipos::tools::debug
