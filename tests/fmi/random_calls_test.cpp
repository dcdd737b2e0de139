// Random sequences of calls.
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "tests/fmi/random_calls.hpp"

namespace ipos::tests {
namespace {

TEST(FmiRandomCalls, KeepTheirPromises) {
  for (unsigned seed = 0; seed < 15; ++seed) {
    std::mt19937 random(seed);
    std::vector<uint8_t> bytes(3'000);
    for (uint8_t& byte : bytes) byte = static_cast<uint8_t>(random());
    const char* broken = play_fmi_calls(bytes);
    ASSERT_EQ(broken, nullptr) << broken << " with seed " << seed;
  }
}

}  // namespace
}  // namespace ipos::tests
