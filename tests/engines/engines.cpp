// ipos_engines [--count N] [--seed S]: all engines on random programs, with random budgets, steps and
// interrupts. Exit code 1 when they differ. With [--write FILE] the programs, and those of the repository,
// are written for ipos_engines_replay instead.
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "tests/engines/programs.hpp"

int main(int argc, char** argv) {
  uint64_t count = 10'000, first = 1;
  std::ofstream out;
  for (int n = 1; n + 1 < argc; n += 2) {
    const std::string option = argv[n];
    if (option == "--count") count = std::strtoull(argv[n + 1], nullptr, 10);
    if (option == "--seed") first = std::strtoull(argv[n + 1], nullptr, 10);
    if (option == "--write") out.open(argv[n + 1]);
  }
  ipos::tests::EngineCampaign campaign;
  for (uint64_t seed = first; seed < first + count && campaign.difference.empty(); ++seed)
    for (const ipos::tests::EngineProgram& program : ipos::tests::programs_of(seed))
      out.is_open() ? write(out, program) : campaign.run(program);
  if (out.is_open()) {
    for (const ipos::tests::EngineProgram& program : ipos::tests::programs_of_the_repository())
      write(out, program);
    return out.good() ? 0 : 1;
  }
  std::printf("%s\n", campaign.summary().c_str());
  return campaign.difference.empty() ? 0 : 1;
}
