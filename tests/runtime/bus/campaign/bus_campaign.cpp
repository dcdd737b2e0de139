// ipos_bus_campaign: the campaigns at any size, with totals. Exit code 1 when something differs.
//   ipos_bus_campaign arbitration [--count FRAMES] [--seed S]     default 1000000 frames
//   ipos_bus_campaign faults [--count SEEDS] [--seed FIRST]       default 10000 seeds
#include <cstdio>
#include <cstdlib>
#include <string>

#include "tests/runtime/bus/campaign/arbitration_campaign.hpp"
#include "tests/runtime/bus/campaign/fault_campaign.hpp"

int main(int argc, char** argv) {
  using namespace ipos::tests;
  const std::string what = argc > 1 ? argv[1] : "";
  uint64_t count = what == "faults" ? 10'000 : 1'000'000;
  uint64_t seed = 1;
  bool good = (what == "faults" || what == "arbitration") && argc % 2 == 0;
  for (int i = 2; good && i + 1 < argc; i += 2) {
    const std::string option = argv[i];
    good = option == "--count" || option == "--seed";
    (option == "--count" ? count : seed) = std::strtoull(argv[i + 1], nullptr, 10);
  }
  if (!good) {
    std::fputs("usage: ipos_bus_campaign arbitration|faults [--count N] [--seed S]\n", stderr);
    return 64;
  }
  if (what == "arbitration") {
    const ArbitrationTotals totals = run_arbitration(count, static_cast<uint32_t>(seed));
    std::printf("%s\n", totals.trouble.empty() ? summary(totals).c_str() : totals.trouble.c_str());
    return totals.trouble.empty() ? 0 : 1;
  }
  const FaultTotals totals = run_faults(seed, count);
  for (const std::string& failure : totals.failures) std::printf("%s\n", failure.c_str());
  std::printf("%s\n", summary(totals).c_str());
  return totals.failures.empty() ? 0 : 1;
}
