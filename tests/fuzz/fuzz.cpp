// Ends the run when a promise is broken.
#include "tests/fuzz/fuzz.hpp"

#include <cstdio>
#include <cstdlib>

namespace ipos::tests {

void broken(const char* promise) {
  std::fprintf(stderr, "broken promise: %s\n", promise);
  std::abort();
}

}  // namespace ipos::tests
