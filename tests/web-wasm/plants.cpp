// ipos_random_plants FOLDER COUNT: writes the plants of the seeds 1 to COUNT, which default_run_test.cpp runs, each into a
// folder of its seed's name.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/runtime/plant/reading_plant.hpp"

int main(int argc, char** argv) {
  if (argc != 3) return 64;
  const uint64_t count = std::strtoull(argv[2], nullptr, 10);
  for (uint64_t seed = 1; seed <= count; ++seed) {
    const std::filesystem::path folder = std::filesystem::path(argv[1]) / std::to_string(seed);
    std::filesystem::create_directories(folder);
    const ipos::tests::ReadingPlant plant(seed);
    std::ofstream(folder / "plant.toml") << plant.text();
    for (const auto& [name, text] : plant.sources()) std::ofstream(folder / name) << text;
  }
  return 0;
}
