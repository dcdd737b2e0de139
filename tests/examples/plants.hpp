// The plant files of all examples.
#pragma once

#include <algorithm>
#include <filesystem>
#include <vector>

#include "tests/tools/command.hpp"

namespace ipos::tests {

// In order of their paths; files of tests (.test.toml) and campaigns (.campaign.toml) are not plants.
inline std::vector<std::filesystem::path> example_plants() {
  std::vector<std::filesystem::path> found;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(project("examples")))
    if (entry.path().extension() == ".toml" && entry.path().stem().extension().empty())
      found.push_back(entry.path());
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace ipos::tests
