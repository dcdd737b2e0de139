// What ipos test --mutate keeps for editors: of the text that was tried, and only as long as it is that text.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "tests/tools/command.hpp"
#include "tools/survivors/survivors.hpp"

namespace ipos::tests {
namespace {

using tools::kept_survivors;
using tools::Survivor;

const std::string kMutated = "#include \"h.h\"\nlong a, b;\nmain()\n{\n    a = LIMIT;\n    if (a == 1)\n        b = 6;\n}\n";
const std::string kHeader = "#define LIMIT 5\n";

class Survivors : public ::testing::Test {
 protected:
  void SetUp() override {
    setenv("XDG_CACHE_HOME", (folder_.path() / "cache").c_str(), 1);
    folder_.write("h.h", kHeader);
  }
  void TearDown() override { unsetenv("XDG_CACHE_HOME"); }
  void mutate(const std::string& text) {
    folder_.write("A.IPC", text);
    run_ipos({"test", "--mutate", "A.IPC"}, folder_.path());
  }
  std::vector<Survivor> kept(const std::string& name, const std::string& text) const {
    return kept_survivors((folder_.path() / name).string(), text);
  }
  TemporaryFolder folder_;
};

// Nobody looks at b, and its line is not reached; a is looked at, so that 5 in the header has no survivor.
TEST_F(Survivors, AreKeptWithTheirPlaces) {
  const std::string text = kMutated + "// expect a == 5\n// expect b == 0\n";
  mutate(text);
  const std::vector<Survivor> wanted{{6, 14, "1 became 0", true}, {7, 9, "removed: b = 6;", false}, {7, 13, "6 became 7", false}};
  EXPECT_EQ(kept("A.IPC", text), wanted);
  EXPECT_TRUE(kept("h.h", kHeader).empty());
  EXPECT_EQ(kept("../" + folder_.path().filename().string() + "/A.IPC", text), wanted) << "however the source is named";
  EXPECT_TRUE(kept("A.IPC", text + " ").empty()) << "another text";
  EXPECT_TRUE(kept("B.IPC", text).empty());
}

TEST_F(Survivors, AHeaderHasItsOwn) {
  const std::string text = kMutated + "// expect b == 0\n";
  mutate(text);
  EXPECT_EQ(kept("h.h", kHeader), (std::vector<Survivor>{{1, 15, "LIMIT: 5 became 6", true}}));
}

TEST_F(Survivors, AreGoneWhenAllIsNoticed) {
  const std::string text = kMutated + "// expect a == 5\n";
  mutate(text);
  EXPECT_FALSE(kept("A.IPC", text).empty());
  const std::string better = "long a;\nmain()\n{\n    a = 5;\n}\n// expect a == 5\n";
  mutate(better);
  EXPECT_TRUE(kept("A.IPC", better).empty());
  EXPECT_TRUE(kept("A.IPC", text).empty());
}

// Listing runs nothing, and tests that do not pass have nothing to say.
TEST_F(Survivors, StayWhereNothingWasTried) {
  const std::string text = kMutated + "// expect a == 5\n";
  mutate(text);
  const std::vector<Survivor> before = kept("A.IPC", text);
  run_ipos({"test", "--mutate", "--list", "A.IPC"}, folder_.path());
  EXPECT_EQ(kept("A.IPC", text), before);
  mutate(text + "// expect a == 6\n");
  EXPECT_EQ(kept("A.IPC", text), before);
}

TEST_F(Survivors, ACacheOfSomebodyElseIsNotRead) {
  const std::string text = kMutated + "// expect a == 5\n";
  mutate(text);
  for (const auto& file : std::filesystem::directory_iterator(folder_.path() / "cache" / "ipos"))
    folder_.write("cache/ipos/" + file.path().filename().string(), "{\"source\": 5, \"survivors\": 7}");
  EXPECT_TRUE(kept("A.IPC", text).empty());
}

}  // namespace
}  // namespace ipos::tests
