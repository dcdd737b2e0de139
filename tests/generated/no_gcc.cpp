// The second oracle where there is no gcc: tests that need it are skipped.
#include "tests/generated/gcc_oracle.hpp"

namespace ipos::tests {

bool gcc_present() { return false; }

GccRun run_with_gcc(const std::vector<Program>&) { return {{}, "there is no gcc"}; }

}  // namespace ipos::tests
