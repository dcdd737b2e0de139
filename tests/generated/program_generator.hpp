// Random programs that are always valid and always end: loops are bounded by counters nothing else writes,
// calls go only to functions written before, numbers behind * and indices are in range, divisors are guarded.
#pragma once

#include "tests/generated/program.hpp"

namespace ipos::tests {

// The same seed gives the same program. Unguarded: divisors may be 0 and numbers behind * may name no
// variable, so that some programs end in F10.
Program generate_program(uint64_t seed, bool unguarded);

// The mix the tests use: one seed in eight is unguarded.
inline Program generate_program(uint64_t seed) { return generate_program(seed, seed % 8 == 7); }

}  // namespace ipos::tests
