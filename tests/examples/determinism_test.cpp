// The same plant gives the same run: the trace hash of every example, twice, with everything else that may
// differ between two runs (folder, environment, logs) changed in between. tests/examples/determinism.sh
// compares builds.
#include <gtest/gtest.h>

#include <set>

#include "tests/examples/plants.hpp"

namespace ipos::tests {
namespace {

namespace fs = std::filesystem;

// The line "trace hash 0123456789abcdef".
std::string trace_hash(const CommandResult& run) {
  const std::string label = "trace hash ";
  const size_t at = run.err.find(label);
  return at == std::string::npos ? "" : run.err.substr(at + label.size(), 16);
}

CommandResult run(const fs::path& plant, std::vector<std::string> more, const fs::path& folder = {}) {
  std::vector<std::string> arguments{"run", plant.string(), "--for", "5s", "--trace-hash=1ms"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run_ipos(arguments, folder);
}

TEST(Determinism, EveryExampleRunsTheSameTwice) {
  const std::vector<fs::path> plants = example_plants();
  ASSERT_GE(plants.size(), 18U);
  std::set<std::string> hashes;
  for (const fs::path& plant : plants) {
    const std::string first = trace_hash(run(plant, {}));
    EXPECT_EQ(first.size(), 16U) << plant;
    hashes.insert(first);
    const TemporaryFolder folder;
    const auto second =
        run(plant, {"--log", "can.log", "--serial-log", "serial.log", "--watch", "--why"}, folder.path());
    EXPECT_EQ(trace_hash(second), first) << plant;
  }
  // Different plants have different hashes: it is not a constant.
  EXPECT_EQ(hashes.size(), plants.size());
}

TEST(Determinism, ADifferenceOfOneIncrementShows) {
  const TemporaryFolder folder;
  const std::string plant =
      folder.write("plant.toml", "[[station]]\nname = \"unit1\"\nunit = \"mdxb\"\nprogram = \"A.IPC\"\n");
  std::vector<std::string> hashes;
  for (const char* value : {"1", "2", "1"}) {
    folder.write("A.IPC",
                 std::string("#define VALUE ") + value + "\n" + "main() { while (1) H11 = H11 + VALUE; }\n");
    hashes.push_back(trace_hash(run(plant, {})));
  }
  EXPECT_EQ(hashes[0], hashes[2]);
  EXPECT_NE(hashes[0], hashes[1]);
}

}  // namespace
}  // namespace ipos::tests
