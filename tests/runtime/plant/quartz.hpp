// In a quarter of the random plants each unit has a quartz of its own, which may be worse than any real one. It draws nothing, so
// that the rest of a plant does not depend on it.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>

namespace ipos::tests {

inline std::string quartz(uint64_t seed, int unit) {
  if (seed % 4 != 3) return "";
  const auto ppm = static_cast<int64_t>((seed * 7'919 + static_cast<uint64_t>(unit) * 104'729) % 20'001) - 10'000;
  return fmt::format("clock_ppm = {}\n", ppm);
}

}  // namespace ipos::tests
