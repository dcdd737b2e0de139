// Many pairs (pair.hpp): programs of the generator, with and without interrupts, and soups of sequences.
#pragma once

#include <cstdint>
#include <string>

namespace ipos::tests {

struct EngineCampaign {
  uint64_t programs = 0;
  uint64_t orders = 0;
  uint64_t commands = 0;
  uint64_t operations = 0;  // of the table: how many were chosen in a program at least once
  std::string difference;   // the first; empty: none
};

// For each seed first .. first + count - 1: one generated program, the same with interrupts, and a soup.
EngineCampaign run_engine_campaign(uint64_t first, uint64_t count);

std::string summary(const EngineCampaign& campaign);

}  // namespace ipos::tests
