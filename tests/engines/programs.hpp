// What campaigns run: programs of the generator, with and without interrupts, loops over tables, state
// machines, soups of sequences, and all programs of the repository.
#pragma once

#include <string>
#include <vector>

#include "tests/engines/campaign.hpp"

namespace ipos::tests {

// One generated program, the same with interrupts, loops over tables, a state machine and a soup; fewer where
// they do not fit.
std::vector<EngineProgram> programs_of(uint64_t seed);

// Those of them that are made of commands, which takes no time.
std::vector<EngineProgram> assembled_programs_of(uint64_t seed);

// Each .IPC file of examples, language tests and benchmarks that compiles, without and with interrupts.
std::vector<EngineProgram> programs_of_the_repository();

}  // namespace ipos::tests
