// Where a failed test stood, as a session: `ipos serve state.ipos` opens the plant at the first thing that was not as
// expected, with the script of the test beside it, and every moment before it.
#pragma once

#include <string>

#include "tools/testing/run_test.hpp"

namespace ipos::tools::testing {

// `moment`: of the first finding. A Failure says why the plant cannot be kept.
std::string failed_state(const TestCase& test, const CompileFlags& compile, const RunOptions& options, Time moment);

}  // namespace ipos::tools::testing
