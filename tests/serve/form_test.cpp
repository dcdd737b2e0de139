// A new table of a plant from a form: the readers take it, nothing else of the file moves, and a station hears its line.
#include <gtest/gtest.h>

#include <algorithm>

#include "runtime/plant_file/plant_file.hpp"
#include "tests/harness/contains.hpp"
#include "tests/tools/command.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/head_story.hpp"
#include "tools/examples/examples.hpp"
#include "tools/input/folder_plant.hpp"
#include "tools/serve/host/plant_form.hpp"

namespace ipos::tests {
namespace {

using tools::serve::Arguments;
using tools::serve::Json;

constexpr const char* kPlant =
    "# Two lines.\n[[bus]]\nname = \"sbus\"   # the one\nkind = \"can\"\nbaud = 125000\n"
    "[[bus]]\nname = \"dp\"\nkind = \"profibus\"\nbaud = 500000\n"
    "[[bus]]\nname = \"x\"\nkind = \"rs485\"\n\n"
    "[[station]]\nname = \"unit1\"\nunit = \"mdxb\"\nsbus = \"sbus\"\n[station.parameters]\nP881 = 1\nP884 = 0\n";

Json form(const Json& message) { return tools::serve::plant_form(kPlant, Arguments(message)); }
std::string with(const std::string& text, const Json& message) { return tools::serve::with_table(text, Arguments(message)); }

TEST(PlantForm, KnowsWhatTheReadersKnow) {
  const Json station = form({{"table", "station"}, {"unit", "mdxb"}});
  EXPECT_EQ(station["name"], "unit2");
  EXPECT_TRUE(station["runs_programs"]);
  const auto has = [](const Json& list, const std::string& word) { return std::find(list.begin(), list.end(), Json(word)) != list.end(); };
  for (const char* unit : {"mdxb", "md60a", "mc07"}) EXPECT_TRUE(has(station["units"], unit)) << unit;
  std::vector<std::string> keys;
  for (const Json& key : station["keys"]) keys.push_back(key["key"]);
  for (const char* key : {"program", "sbus", "option", "inputs"}) EXPECT_NE(std::find(keys.begin(), keys.end(), key), keys.end()) << key;
  const Json bus = form({{"table", "bus"}});
  const auto kind = std::find_if(bus["keys"].begin(), bus["keys"].end(), [](const Json& key) { return key["key"] == "kind"; });
  ASSERT_NE(kind, bus["keys"].end());
  EXPECT_TRUE(has((*kind)["words"], "can"));
  EXPECT_TRUE(has(form({{"table", "wire"}})["from"], "unit1.DO01"));
}

// P881 is the SBus address, P884 its baud rate, 0 being 125 kbaud (MOVIDRIVE B, parameters); a MOVIDRIVE A has P813 and P816.
TEST(PlantForm, ProposesAFreeAddressAndWhatMustAgree) {
  const auto line = [](const std::string& unit, const std::string& key) {
    for (const Json reply = form({{"table", "station"}, {"unit", unit}}); const Json& one : reply["lines"])
      if (one["key"] == key) return one;
    return Json();
  };
  const Json sbus = line("mdxb", "sbus");
  ASSERT_EQ(sbus["parameters"].size(), 2U) << sbus;
  EXPECT_EQ(sbus["parameters"][0]["number"], "P881");
  EXPECT_EQ(sbus["parameters"][0]["value"], "2");
  EXPECT_EQ(sbus["parameters"][1]["number"], "P884");
  const Json older = line("md60a", "sbus");
  ASSERT_EQ(older["parameters"].size(), 2U) << older;
  EXPECT_EQ(older["parameters"][0]["number"], "P813");
  EXPECT_EQ(older["parameters"][1]["number"], "P816");
}

TEST(PlantForm, PutsTheTableAtTheEndAndKeepsTheRest) {
  std::string text = kPlant;
  for (const char* name : {"unit2", "unit3"}) {
    const Json asked = tools::serve::plant_form(text, Arguments(Json{{"table", "station"}, {"unit", "mdxb"}}));
    Json message{{"table", "station"}, {"values", {{"name", name}, {"unit", "mdxb"}, {"sbus", "sbus"}}}, {"written", {{"terminator", "true"}}}};
    for (const Json& line : asked["lines"])
      if (line["key"] == "sbus")
        for (const Json& setting : line["parameters"]) message["parameters"][setting["number"].get<std::string>()] = setting["value"];
    const std::string more = with(text, message);
    EXPECT_TRUE(more.starts_with(text));
    text = more;
  }
  text = with(text, {{"table", "wire"}, {"values", {{"from", "unit2.DO01"}, {"to", "unit3.DI05"}}}});
  text = with(text, {{"table", "control"}, {"values", {{"name", "plc"}, {"sbus", "sbus"}}}});
  const auto read = runtime::read_plant_file(text);
  EXPECT_TRUE(read.errors.empty()) << read.errors.front().text << "\n" << text;
  ASSERT_EQ(read.plant.stations.size(), 3U);
  for (size_t n = 0; n < 3; ++n) {
    EXPECT_EQ(read.plant.stations[n].parameters[0].value, static_cast<int32_t>(n) + 1);
    EXPECT_EQ(read.plant.stations[n].parameters[1].value, 0);
  }
  EXPECT_EQ(read.plant.wires.size(), 1U);
}

TEST(PlantForm, SaysWhatTheReadersHaveAgainstIt) {
  const auto why = [](const Json& message) {
    try {
      with(kPlant, message);
    } catch (const tools::serve::Mistake& mistake) {
      return std::string(mistake.what());
    }
    return std::string();
  };
  EXPECT_TRUE(contains(why({{"table", "station"}, {"values", {{"name", "unit1"}, {"unit", "mdxb"}}}}), "there are two of station 'unit1'"));
  EXPECT_TRUE(contains(why({{"table", "station"}, {"values", {{"name", "a"}, {"unit", "mdxc"}}}}), "mdxc"));
  EXPECT_NE(why({{"table", "station"}, {"values", {{"name", "a"}, {"unit", "mdxb"}}}, {"written", {{"load", "1\n[[bus]]"}}}}), "");
  EXPECT_NE(why({{"table", "station"}, {"values", {{"name", "a\"\n[[bus]]"}, {"unit", "mdxb"}}}}), "");
  EXPECT_NE(why({{"table", "switch"}}), "");
}

TEST(Examples, HaveTheirStories) {
  EXPECT_GE(tools::all_examples().size(), 22U);
  for (const tools::Example& example : tools::all_examples()) {
    if (example.plant.empty()) continue;
    EXPECT_NE(example.story, "") << example.name;
    EXPECT_NE(example.kind, "") << example.name;
  }
  EXPECT_EQ(tools::head_story("# One. Two\n# goes on. Three.\n[[bus]]\n", 2), "One. Two goes on.");
  EXPECT_EQ(tools::head_story("# Only one\n\n# Another\n", 2), "Only one");
  EXPECT_EQ(tools::head_story("[[bus]]\n# no head\n", 2), "");
}

TEST(PlantOrProgram, TakesTheOnlyOneAndTellsWhatWasMeant) {
  const TemporaryFolder folder;
  const auto at = [&](const std::string& name) { return (folder.path() / name).string(); };
  const auto why = [](const std::string& named) {
    try {
      return "found " + tools::plant_or_program(named);
    } catch (const tools::Failure& failure) {
      return std::string(failure.what());
    }
  };
  folder.write("A.IPC", "main()\n{\n}\n");
  EXPECT_EQ(why(folder.path().string()), "found " + at("A.IPC"));
  folder.write("line.toml", "[[station]]\nname = \"a\"\nunit = \"mdxb\"\n");
  folder.write("line.test.toml", "plant = \"line.toml\"\n[[station]]\n");
  folder.write("pyproject.toml", "[project]\n");
  EXPECT_EQ(why(folder.path().string()), "found " + at("line.toml"));
  EXPECT_EQ(why(at("line.toml")), "found " + at("line.toml"));
  EXPECT_TRUE(contains(why(at("lin.toml")), "did you mean '" + at("line.toml") + "'?"));
  EXPECT_TRUE(contains(why(at("line.tml")), "did you mean '" + at("line.toml") + "'?"));
  folder.write("other.toml", "[[station]]\nname = \"a\"\nunit = \"mdxb\"\n");
  EXPECT_TRUE(contains(why(folder.path().string()), "has 2 plants; name one of them: "));
  const TemporaryFolder empty;
  EXPECT_TRUE(contains(why(empty.path().string()), "has no plant (.toml) and no program (.IPC)"));
}

}  // namespace
}  // namespace ipos::tests
