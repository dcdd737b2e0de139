// Random frames of several nodes on the simulated line, compared frame by frame with a model that goes
// through time bit by bit: who wins when, and how long each frame is.
#pragma once

#include <cstdint>
#include <string>

namespace ipos::tests {

struct ArbitrationTotals {
  uint64_t frames = 0;     // compared
  uint64_t contested = 0;  // sent straight after another one
  uint64_t bits = 0;
  std::string trouble;  // the first difference, empty when all are equal
};

ArbitrationTotals run_arbitration(uint64_t frames, uint32_t seed);

std::string summary(const ArbitrationTotals& totals);

}  // namespace ipos::tests
