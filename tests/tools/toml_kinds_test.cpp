// Each kind of TOML file given to each verb that takes one: who does not take it says once what it is and which verb does.
// What a file is, is said here by hand; the reader of the kinds is not asked.
#include <gtest/gtest.h>

#include <algorithm>

#include "runtime/plant_file/toml_kind.hpp"
#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

using runtime::TomlKind;

struct File {
  std::string name, text;
  TomlKind kind;
  std::string place;  // line and column of what tells it
};

const std::string kStation = "[[station]]\nname = \"a\"\nunit = \"mdxb\"\n";
const std::string kPlant = "[[bus]]\nname = \"sbus\"\nkind = \"can\"\n" + kStation + "sbus = \"sbus\"\n[station.parameters]\nP881 = 1\n";
const std::string kExpect = "[[expect]]\nstation = \"a\"\nat = \"5ms\"\nparameter = \"P881\"\nequals = 1\n";
const std::string kStep = "[[step]]\nat = \"1ms\"\nstation = \"a\"\ninput = \"DI01\"\nset = 1\n";
const std::string kFault = "[[fault]]\nbus = \"sbus\"\nkind = \"drop\"\nrate = 2\n";
const std::string kVary = "[[vary]]\nstation = \"a\"\nparameter = \"P130\"\nvalues = [\"1 s\", \"2 s\"]\n";
const std::string kNamed = "plant = \"plant.toml\"\n";

const std::vector<File>& files() {
  static const std::vector<File> kFiles{
      {"plant.toml", kPlant, TomlKind::Plant, ""},
      {"faulty.toml", kPlant + kFault + "count = 3\n", TomlKind::Plant, ""},
      {"expecting.toml", kPlant + kExpect, TomlKind::Plant, ""},
      {"a.test.toml", kNamed + kStep + kExpect, TomlKind::Test, "1:9"},
      {"renamed_test.toml", kNamed + kExpect, TomlKind::Test, "1:9"},
      {"hand.test.toml", "by_hand = true\n" + kPlant + kExpect, TomlKind::Test, "1:11"},
      {"own.toml", kPlant + kStep + kExpect, TomlKind::Test, "10:1"},
      {"faulty.test.toml", kNamed + kFault, TomlKind::Test, "1:9"},
      {"only.test.toml", kNamed, TomlKind::Test, "1:9"},
      {"a.campaign.toml", kNamed + kVary, TomlKind::Campaign, "2:1"},
      {"renamed_campaign.toml", kNamed + "for = \"50ms\"\n", TomlKind::Campaign, "2:7"},
      {"faults.campaign.toml", kNamed + kFault + "seeds = \"1..3\"\n", TomlKind::Campaign, "1:9"},
      {"faults.toml", kNamed + kFault + "seeds = \"1..3\"\n", TomlKind::Campaign, "1:9"},
      {"only.campaign.toml", kNamed, TomlKind::Campaign, "1:9"},
      {"of_tests.toml", "tests = [\"a.test.toml\"]\n", TomlKind::Campaign, "1:9"},
      {"a.settings.toml", "ipos-parameters = 1\nunit = \"mdxb\"\nparameters = [ { number = \"P130\", raw = 2000 } ]\n", TomlKind::Parameters, "1:19"},
  };
  return kFiles;
}

std::string sentence(TomlKind kind) {
  switch (kind) {
    case TomlKind::Plant: return "this is a plant: ";
    case TomlKind::Test: return "this is a test";
    case TomlKind::Campaign: return "this is a campaign: `ipos campaign run FILE --out DIR` runs its cases";
    case TomlKind::Parameters: return "this is a set of parameters: `ipos param load`";
    case TomlKind::Unknown: break;
  }
  return "no such kind";
}

struct VerbOfFile {
  std::vector<std::string> words;
  std::vector<std::string> behind;  // the file
  std::vector<TomlKind> takes;
};

const std::vector<VerbOfFile>& verbs() {
  const std::vector<TomlKind> plant{TomlKind::Plant};
  const std::vector<TomlKind> tested{TomlKind::Plant, TomlKind::Test};
  static const std::vector<VerbOfFile> kVerbs{
      {{"run"}, {"--for", "2ms"}, plant},
      {{"test"}, {}, tested},
      {{"debug"}, {}, tested},
      {{"fmu"}, {"-o", "x.fmu"}, plant},
      {{"bus", "plan"}, {}, plant},
      {{"bus", "dbc"}, {}, plant},
      {{"param", "list"}, {}, plant},
      {{"watch"}, {"a", "P130", "--count", "1", "--every", "1ms"}, plant},
      {{"diag"}, {"a", "--at", "1ms"}, plant},
      {{"campaign", "plan"}, {}, {TomlKind::Campaign}},
      {{"campaign", "run"}, {"--out", "results", "--jobs", "1"}, {TomlKind::Campaign}},
      {{"param", "diff", "good.settings"}, {}, {TomlKind::Plant, TomlKind::Parameters}},
  };
  return kVerbs;
}

size_t count_of(const std::string& text, const std::string& part) {
  size_t count = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

class TomlKinds : public ::testing::Test {
 protected:
  TomlKinds() {
    for (const File& file : files()) folder_.write(file.name, file.text);
    folder_.write("good.settings", files().back().text);
  }
  void expect_told(const CommandResult& result, const File& file, const std::string& words) const {
    const std::string said = result.out + result.err;
    const std::string place = file.place.empty() ? "1:1" : file.place;
    EXPECT_EQ(result.exit_code, 65) << words << said;
    EXPECT_NE(said.find(file.name + ":" + place + ": error: " + sentence(file.kind)), std::string::npos) << words << said;
    EXPECT_EQ(count_of(said, "error: "), 1U) << "one mistake, not one for each key: " << words << said;
  }
  TemporaryFolder folder_;
};

TEST_F(TomlKinds, EveryVerbTellsWhatItDoesNotTake) {
  for (const VerbOfFile& verb : verbs())
    for (const File& file : files()) {
      std::vector<std::string> words = verb.words;
      words.push_back(file.name);
      words.insert(words.end(), verb.behind.begin(), verb.behind.end());
      std::string line;
      for (const std::string& word : words) line += word + " ";
      const CommandResult result = run_ipos(words, folder_.path());
      if (std::find(verb.takes.begin(), verb.takes.end(), file.kind) == verb.takes.end())
        expect_told(result, file, line);
      else
        EXPECT_EQ((result.out + result.err).find("this is a"), std::string::npos) << line << result.out << result.err;
    }
}

// The page would stay open, so only what it does not take.
TEST_F(TomlKinds, ThePageTakesPlantsAndTests) {
  for (const File& file : files())
    if (file.kind == TomlKind::Campaign || file.kind == TomlKind::Parameters)
      expect_told(run_ipos({"serve", "--port", "0", file.name}, folder_.path()), file, "serve ");
}

// A test is one however it is called.
TEST_F(TomlKinds, ATestWithAnotherNameIsDebugged) {
  const CommandResult result = run_ipos({"debug", "renamed_test.toml"}, folder_.path());
  EXPECT_EQ(result.exit_code, 0) << result.err;
}

TEST_F(TomlKinds, AKeyOfACampaignInATestIsAKeyThatItDoesNotHave) {
  folder_.write("x.test.toml", kNamed + "for = \"1s\"\n" + kStep + kExpect);
  const CommandResult result = run_ipos({"test", "x.test.toml"}, folder_.path());
  EXPECT_NE((result.out + result.err).find("x.test.toml:2:1: error: unknown key 'for'"), std::string::npos) << result.out << result.err;
}

// Half-written texts have their name only.
TEST(TomlKind, OfATextThatIsNoTomlTheNameDecides) {
  EXPECT_EQ(runtime::kind_of_text("plant = ", "a.test.toml"), TomlKind::Test);
  EXPECT_EQ(runtime::kind_of_text("plant = ", "a.campaign.toml"), TomlKind::Campaign);
  EXPECT_EQ(runtime::kind_of_text("plant = ", "a.toml"), TomlKind::Unknown);
  EXPECT_EQ(runtime::kind_of_text("", "a.toml"), TomlKind::Unknown);
}

}  // namespace
}  // namespace ipos::tests
