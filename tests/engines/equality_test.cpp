// The fast engine does what the reference interpreter does, command by command: on every program of the
// repository and on random ones. The reference is the expected value.
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/engines/programs.hpp"
#include "vm/fast/commands.hpp"
#include "vm/fast/predecode.hpp"
#include "vm/jit/jit.hpp"

namespace ipos::tests {
namespace {

TEST(Engines, AgreeOnAllProgramsOfTheRepository) {
  EngineCampaign campaign;
  for (const EngineProgram& program : programs_of_the_repository()) campaign.run(program);
  EXPECT_EQ(campaign.difference, "");
  EXPECT_GT(campaign.programs, 300U);
}

// Quick, and so the first to notice a mistake: further seeds of what needs no compiler.
TEST(Engines, AgreeOnAFewLoopsStateMachinesAndMixes) {
  EngineCampaign campaign;
  for (uint64_t seed = 1001; seed <= 1015; ++seed)
    for (const EngineProgram& program : assembled_programs_of(seed)) campaign.run(program);
  EXPECT_EQ(campaign.difference, "");
  EXPECT_GT(campaign.programs, 40U);
}

// 10 000 seeds by ipos_engines.
TEST(Engines, AgreeOnRandomPrograms) {
  EngineCampaign campaign;
  for (uint64_t seed = 1; seed <= 600; ++seed)
    for (const EngineProgram& program : programs_of(seed)) campaign.run(program);
  std::printf("%s\n", campaign.summary().c_str());
  EXPECT_EQ(campaign.difference, "");
  EXPECT_GT(campaign.programs, 2500U);
  if (vm::jit::available()) {
    EXPECT_EQ(campaign.native, campaign.programs) << "machine code for each of them";
  }
  EXPECT_GT(campaign.operations.size() * 10, static_cast<size_t>(vm::fast::Operation::kCount) * 8)
      << "random programs have to contain most operations";
}

// The lengths of commands stand in commands.hpp a second time, as types.
TEST(Engines, CommandLengthsAreThoseOfTheInstructionSet) {
#define SPECIAL(name)
#define PLAIN(command) EXPECT_EQ(vm::fast::command::words, vm::info(vm::Opcode::command).words) << #command;
#define FUSED(name, ...)
#define FUSED_CALL(name, ...)
#define FUSED_RET(name, ...)
#define FILL(name, ...)
#include "vm/fast/operations.def"
}

}  // namespace
}  // namespace ipos::tests
