// Ends the run when a promise is broken, and how the sanitizers work meanwhile.
#include "tests/fuzz/fuzz.hpp"

#include <cstdio>
#include <cstdlib>

namespace ipos::tests {

void broken(const char* promise) {
  std::fprintf(stderr, "broken promise: %s\n", promise);
  std::abort();
}

}  // namespace ipos::tests

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
// Most of what a short run costs was the 256 MB of freed memory that wait by default, which the processor's cache does not
// hold. A megabyte is more than most runs take. To see who allocated, replay with ASAN_OPTIONS=malloc_context_size=30.
extern "C" const char* __asan_default_options();  // NOLINT: the sanitizer asks for this name
extern "C" const char* __asan_default_options() {
  return "quarantine_size_mb=1:malloc_context_size=1:strict_string_checks=1";
}
#endif
#endif
