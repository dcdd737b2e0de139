// ipos_engines [--count N] [--seed S]: the reference interpreter and the fast engine on random programs, with
// random budgets, steps and interrupts. Exit code 1 when they differ.
#include <cstdio>
#include <cstdlib>
#include <string>

#include "tests/engines/campaign.hpp"

int main(int argc, char** argv) {
  uint64_t count = 10'000, seed = 1;
  for (int n = 1; n + 1 < argc; n += 2) {
    const std::string option = argv[n];
    if (option == "--count") count = std::strtoull(argv[n + 1], nullptr, 10);
    if (option == "--seed") seed = std::strtoull(argv[n + 1], nullptr, 10);
  }
  const ipos::tests::EngineCampaign campaign = ipos::tests::run_engine_campaign(seed, count);
  std::printf("%s\n", ipos::tests::summary(campaign).c_str());
  return campaign.difference.empty() ? 0 : 1;
}
