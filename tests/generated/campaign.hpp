// Many seeds against one oracle, with counts that show a shrunken test.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/generated/program.hpp"

namespace ipos::tests {

enum class Oracle : uint8_t { Tree, Gcc };

struct Difference {
  uint64_t seed = 0;
  std::string text;
};

struct Campaign {
  uint64_t programs = 0;
  uint64_t faults = 0;  // programs that end in F10 by the oracle
  uint64_t lines = 0;
  uint64_t commands = 0;
  std::vector<Difference> differences;
  std::string trouble;  // of the oracle itself
};

// Seeds first .. first + count - 1.
Campaign run_campaign(Oracle oracle, uint64_t first, uint64_t count);

std::string summary(const Campaign& campaign);

// The first difference and its reduced source; empty when there is none.
std::string first_difference(Oracle oracle, const Campaign& campaign);

}  // namespace ipos::tests
