// The fast engine does what the reference interpreter does, command by command: on every program of the
// repository and on random ones. The reference is the expected value.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "compiler/codegen/compile.hpp"
#include "tests/engines/campaign.hpp"
#include "tests/engines/pair.hpp"
#include "vm/fast/commands.hpp"
#include "vm/fast/predecode.hpp"

namespace ipos::tests {
namespace {

namespace fs = std::filesystem;

std::optional<std::string> read_text(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return std::nullopt;
  return std::string{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

TEST(Engines, AgreeOnAllProgramsOfTheRepository) {
  int programs = 0;
  for (const char* folder : {"examples", "tests/language", "tests/bench/programs"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(IPOS_SOURCE_DIR) / folder)) {
      if (entry.path().extension() != ".IPC") continue;
      const std::string path = entry.path().string();
      compiler::CompileOptions options;
      options.read_file = read_text;
      for (const char* unit : {"", "mdxb"}) {
        options.unit = *unit == 0 ? nullptr : stdlib::find_unit(std::string_view(unit));
        const compiler::Compilation made =
            compiler::compile(path, path, read_text(path).value_or(""), options);
        if (!made.image) continue;
        const vm::Limits limits{made.unit->variables, made.unit->program_words, made.unit->tasks,
                                made.unit->call_depth};
        for (uint64_t seed = 1; seed <= 2; ++seed) {
          const auto code = seed == 1 ? made.image->code : with_interrupts(made.image->code, limits, seed);
          const vm::Verification verified = vm::verify(code, limits, {});
          if (!verified.image) continue;
          EXPECT_EQ(run_pair(*verified.image, seed, 1000).difference, "") << path;
          ++programs;
        }
      }
    }
  EXPECT_GT(programs, 300);
}

// 10 000 seeds by ipos_engines.
TEST(Engines, AgreeOnRandomPrograms) {
  const EngineCampaign campaign = run_engine_campaign(1, 600);
  std::printf("%s\n", summary(campaign).c_str());
  EXPECT_EQ(campaign.difference, "");
  EXPECT_GT(campaign.programs, 1500U);
  EXPECT_GT(campaign.operations * 10, static_cast<uint64_t>(vm::fast::Operation::kCount) * 8)
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
