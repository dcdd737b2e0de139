// A long program as a plant's programmer writes one: stations with state machines, tables, limits, counters
// and telegrams, a statement on almost every line. Always the same text for the same number of stations.
#pragma once

#include <string>

namespace ipos::bench {

inline constexpr int kDenseStations = 41;

// For an mdxb; compiles without a message.
std::string dense_program(int stations = kDenseStations);

}  // namespace ipos::bench
