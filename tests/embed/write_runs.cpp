// ipos_firmware_runs RUNS EXPECTED COUNT: writes programs for tests/embedding/firmware_run.c, all language programs and examples
// and COUNT by chance, and the hashes that the interpreter of the simulation gives them, a line each.
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "tests/embed/reference.hpp"

using namespace ipos::tests;  // NOLINT

int main(int count, char** arguments) {
  if (count != 4) return 64;
  std::ofstream runs(arguments[1], std::ios::binary), expected(arguments[2]);
  std::vector<OrderedRun> all = language_runs();
  const auto random = static_cast<uint32_t>(std::strtoul(arguments[3], nullptr, 10));
  for (uint32_t number = 0; number < random; ++number) all.push_back(random_run(number));
  for (const OrderedRun& run : all) {
    const uint32_t head[] = {static_cast<uint32_t>(run.image.size()), run.seed, run.ticks};
    runs.write(reinterpret_cast<const char*>(head), sizeof head);
    runs.write(reinterpret_cast<const char*>(run.image.data()), static_cast<std::streamsize>(run.image.size()));
    runs.write("\0\0\0", static_cast<std::streamsize>((4 - run.image.size() % 4) % 4));  // the next one is aligned
    char line[16];
    std::snprintf(line, sizeof line, "%08x\n", reference_hash(run));
    expected << line;
  }
  const uint32_t end = 0;
  runs.write(reinterpret_cast<const char*>(&end), sizeof end);
  return runs.good() && expected.good() ? 0 : 1;
}
