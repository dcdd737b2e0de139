// Every example gives the same run, whatever executes its programs: report, journal, frames, telegrams and
// all recorded signals. The run of the reference interpreter is the expected value.
#include <gtest/gtest.h>

#include "tests/examples/plants.hpp"
#include "vm/jit/jit.hpp"

namespace ipos::tests {
namespace {

namespace fs = std::filesystem;

struct Output {
  std::vector<std::string> texts;  // what was printed and written
  bool operator==(const Output&) const = default;
};

// With the hash of every millisecond each tick is executed in its turn, with the usual one most are late.
Output run(const fs::path& plant, const std::vector<std::string>& how,
           const std::string& hash = "--trace-hash") {
  const TemporaryFolder folder;
  const auto file = [&](const char* name) { return (folder.path() / name).string(); };
  std::vector<std::string> arguments{"run",
                                     plant.string(),
                                     "--for",
                                     "2s",
                                     "--watch",
                                     "--why",
                                     "--log",
                                     file("bus.pcapng"),
                                     "--serial-log",
                                     file("serial.log"),
                                     "--trace",
                                     file("run.csv"),
                                     hash};
  arguments.insert(arguments.end(), how.begin(), how.end());
  const CommandResult result = run_ipos(arguments);
  return {{std::to_string(result.exit_code), result.out, result.err, read_text(file("bus.pcapng")),
           read_text(file("serial.log")), read_text(file("run.csv"))}};
}

TEST(Engines, EveryExampleRunsTheSameWithEach) {
  ASSERT_GE(example_plants().size(), 18U);
  for (const fs::path& plant : example_plants()) {
    const Output expected = run(plant, {"--engine", "reference", "--no-skip"});
    EXPECT_TRUE(run(plant, {"--engine", "fast"}) == expected) << plant;
    EXPECT_TRUE(run(plant, {}) == expected) << plant;
    const Output each = run(plant, {"--engine", "reference", "--no-skip"}, "--trace-hash=1ms");
    EXPECT_TRUE(run(plant, {}, "--trace-hash=1ms") == each) << plant;
  }
}

TEST(Engines, MachineCodeIsRefusedWhereThereIsNone) {
  const CommandResult result =
      run_ipos({"run", project("examples/tour/TOUR.IPC").string(), "--engine", "native", "--for", "1ms"});
  EXPECT_EQ(result.exit_code, vm::jit::available() ? 0 : 64) << result.err;
}

}  // namespace
}  // namespace ipos::tests
