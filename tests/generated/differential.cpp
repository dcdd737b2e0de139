// ipos_differential: generated programs against an oracle, with totals and the first difference, reduced.
//   ipos_differential [--count N] [--seed S] [--oracle gcc|tree] [--list] [--print]
// --list reduces nothing; --print writes the program of the seed and does not run it. Exit code 1 when there
// are differences.
#include <cstdio>
#include <cstdlib>
#include <string>

#include "tests/generated/campaign.hpp"
#include "tests/generated/gcc_oracle.hpp"
#include "tests/generated/program_generator.hpp"
#include "tests/generated/source_text.hpp"

int main(int argc, char** argv) {
  using namespace ipos::tests;
  uint64_t count = 10'000, seed = 1;
  Oracle oracle = Oracle::Tree;
  bool list_only = false;
  for (int i = 1; i < argc; ++i) {
    const std::string option = argv[i];
    const std::string value = i + 1 < argc ? argv[i + 1] : "";
    if (option == "--print") {
      Program program = generate_program(seed);
      std::fputs(source_text(program).c_str(), stdout);
      return 0;
    }
    if (option == "--list") {
      list_only = true;
      continue;
    }
    if (option == "--count" && !value.empty()) {
      count = std::strtoull(value.c_str(), nullptr, 10);
    } else if (option == "--seed" && !value.empty()) {
      seed = std::strtoull(value.c_str(), nullptr, 10);
    } else if (option == "--oracle" && (value == "gcc" || value == "tree")) {
      oracle = value == "gcc" ? Oracle::Gcc : Oracle::Tree;
    } else {
      std::fputs("usage: ipos_differential [--count N] [--seed S] [--oracle gcc|tree] [--list] [--print]\n",
                 stderr);
      return 64;
    }
    ++i;
  }
  if (oracle == Oracle::Gcc && !gcc_present()) {
    std::fputs("ipos_differential: there is no gcc\n", stderr);
    return 66;
  }
  const Campaign campaign = run_campaign(oracle, seed, count);
  std::printf("oracle %s, seeds %llu to %llu: %s\n", oracle == Oracle::Gcc ? "gcc" : "tree",
              static_cast<unsigned long long>(seed), static_cast<unsigned long long>(seed + count - 1),
              summary(campaign).c_str());
  if (!campaign.trouble.empty()) return 70;
  if (campaign.differences.empty()) return 0;
  for (const Difference& row : campaign.differences)
    std::printf("seed %llu: %s\n", static_cast<unsigned long long>(row.seed), row.text.c_str());
  if (!list_only) std::fputs(first_difference(oracle, campaign).c_str(), stdout);
  return 1;
}
