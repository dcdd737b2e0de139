// What an importer does in event mode of FMI 3, for the tests of terminals: it gives the operations of a bus with their clock,
// and lets the states be updated.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "tests/fmi/functions.hpp"

namespace ipos::tests {

inline void give_operations(void* instance, uint32_t clock, uint32_t data, const std::string& operations) {
  const bool active = true;
  const size_t size = operations.size();
  const auto* in = reinterpret_cast<const uint8_t*>(operations.data());
  EXPECT_EQ(fmi3SetClock(instance, &clock, 1, &active), kOk);
  EXPECT_EQ(fmi3SetBinary(instance, &data, 1, &size, &in, 1), kOk);
}

inline void update_states(void* instance) {
  bool flags[5];
  double next = 0;
  EXPECT_EQ(fmi3UpdateDiscreteStates(instance, &flags[0], &flags[1], &flags[2], &flags[3], &flags[4], &next), kOk);
}

}  // namespace ipos::tests
