// In place of what libFuzzer does at each comparison (-Wl,--wrap): nothing.
#include <cstdint>

#define QUICK __attribute__((no_sanitize("coverage")))
#define COMPARISON(bytes, type)                                                      \
  extern "C" QUICK void __wrap___sanitizer_cov_trace_cmp##bytes(type, type) {}       \
  extern "C" QUICK void __wrap___sanitizer_cov_trace_const_cmp##bytes(type, type) {}
COMPARISON(1, uint8_t)
COMPARISON(2, uint16_t)
COMPARISON(4, uint32_t)
COMPARISON(8, uint64_t)
#undef COMPARISON
#undef QUICK
