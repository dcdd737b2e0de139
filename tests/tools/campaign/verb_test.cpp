// ipos campaign as a user meets it: cases, results, exit codes, and what is said of mistakes.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "tests/tools/command.hpp"

namespace {

namespace fs = std::filesystem;
using ipos::tests::CommandResult;
using ipos::tests::run_ipos;
using ipos::tests::TemporaryFolder;
using nlohmann::json;

constexpr const char* kProgram = "long lIn, lOut;\nmain() { while (1) { lOut = lIn * 2; } }\n";
constexpr const char* kPlant =
    "[[bus]]\nname = \"sbus\"\nkind = \"can\"\n[[station]]\nname = \"a\"\nunit = \"mdxb\"\nprogram = \"A.IPC\"\nsbus = \"sbus\"\n"
    "[station.parameters]\nP881 = 1\n"
    "[[expect]]\nstation = \"a\"\nat = \"20ms\"\nvariable = \"lOut\"\nequals = 6\n";
constexpr const char* kCampaign =
    "plant = \"p.toml\"\nfor = \"50ms\"\n"
    "[[vary]]\nstation = \"a\"\nvariable = \"lIn\"\nvalues = [2, 3, 0x4]\n"
    "[[vary]]\nstation = \"a\"\nparameter = \"P130\"\nfrom = \"1 s\"\nto = \"2 s\"\nsteps = 3\n"
    "[[vary]]\nkey = \"bus.sbus.baud\"\nvalues = [125000, 500000]\n"
    "[[measure]]\nname = \"out\"\nsignal = \"a.lOut\"\ntake = \"max\"\nat_most = 7\n";

class CampaignVerb : public testing::Test {
 protected:
  CampaignVerb() {
    folder_.write("A.IPC", kProgram);
    folder_.write("p.toml", kPlant);
    folder_.write("c.campaign.toml", kCampaign);
  }
  CommandResult campaign(std::vector<std::string> words) {
    words.insert(words.begin(), "campaign");
    return run_ipos(words, folder_.path());
  }
  CommandResult run(const std::string& out, std::vector<std::string> more = {}) {
    more.insert(more.begin(), {"run", "c.campaign.toml", "--out", out});
    return campaign(more);
  }
  std::string text(const std::string& name) const {
    std::ifstream file(folder_.path() / name);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  std::vector<json> rows(const std::string& name) const {
    std::istringstream lines(text(name));
    std::vector<json> all;
    for (std::string line; std::getline(lines, line);) all.push_back(json::parse(line));
    return all;
  }

  TemporaryFolder folder_;
};

TEST_F(CampaignVerb, PlanEndsWithTheNumberOfCases) {
  const auto plan = campaign({"plan", "c.campaign.toml"});
  EXPECT_EQ(plan.exit_code, 0) << plan.err;
  EXPECT_TRUE(plan.out.ends_with("\n18 cases\n")) << plan.out;
}

TEST_F(CampaignVerb, ResultsAreLinesOfJson) {
  const auto ran = run("out");
  EXPECT_EQ(ran.exit_code, 1) << ran.err;
  const auto all = rows("out/shard-1-of-1.jsonl");
  ASSERT_EQ(all.size(), 18U);
  for (const json& row : all) {
    const int64_t in = row["factors"]["a.lIn"];
    EXPECT_EQ(row["measures"]["out"], 2 * in);
    std::vector<std::string> failed;
    if (in != 3) failed.push_back("p.toml:11:1: lOut of a is " + std::to_string(2 * in) + " at 20 ms, expected 6");
    if (in == 4) failed.push_back("out: 8 is more than 7");
    EXPECT_EQ(row["failed"].get<std::vector<std::string>>(), failed);
    EXPECT_EQ(row["hash"].get<std::string>().size(), 16U);
    EXPECT_EQ(row["case"].get<std::string>().size(), 16U);
    EXPECT_TRUE(row["ms"].is_number());
  }
}

// The values in the text of the plant, and the plain verb.
TEST_F(CampaignVerb, EachCaseIsTheRunOfItsPlant) {
  run("out");
  for (const json& row : rows("out/shard-1-of-1.jsonl")) {
    std::string plant = kPlant;
    plant.replace(plant.find("P881"), 0, "P130 = \"" + row["factors"]["a.P130"].get<std::string>() + "\"\n");
    plant.replace(plant.find("kind"), 0, "baud = " + row["factors"]["bus.sbus.baud"].dump() + "\n");
    plant += "[[stimulus]]\nstation = \"a\"\nat = \"0ms\"\nvariable = \"lIn\"\nset = " + row["factors"]["a.lIn"].dump() + "\n";
    folder_.write("own.toml", plant);
    const auto alone = run_ipos({"run", "own.toml", "--for", "50ms", "--trace-hash"}, folder_.path());
    const std::string wanted = "trace hash " + row["hash"].get<std::string>();
    EXPECT_NE(alone.err.find(wanted), std::string::npos) << alone.err << row;

    const auto shown = campaign({"show", "c.campaign.toml", row["case"], "--plant"});
    folder_.write("shown.toml", shown.out);
    EXPECT_NE(run_ipos({"run", "shown.toml", "--for", "50ms", "--trace-hash"}, folder_.path()).err.find(wanted), std::string::npos) << shown.out;
  }
}

// 8470 is P130 by its index.
TEST_F(CampaignVerb, AParameterIsFoundByAnyOfItsNames) {
  std::string plant = kPlant;
  folder_.write("p.toml", plant.replace(plant.find("P881"), 0, "8470 = 700\n"));
  run("out");
  const json row = rows("out/shard-1-of-1.jsonl").front();
  const std::string shown = campaign({"show", "c.campaign.toml", row["case"], "--plant"}).out;
  EXPECT_EQ(shown.find("P130"), std::string::npos) << shown;
  EXPECT_NE(shown.find("8470 = " + row["factors"]["a.P130"].dump() + "\n"), std::string::npos) << shown;
}

TEST_F(CampaignVerb, ShowPrintsTheCommandThatReplaysACase) {
  run("out");
  const json row = rows("out/shard-1-of-1.jsonl").front();
  const auto shown = campaign({"show", "c.campaign.toml", row["case"]});
  const std::string name = row["case"];
  ASSERT_EQ(shown.out, "ipos campaign run c.campaign.toml --case " + name + "\n");
  const auto again = campaign({"run", "c.campaign.toml", "--case", name});
  EXPECT_EQ(again.exit_code, row["failed"].empty() ? 0 : 1);
  EXPECT_NE(again.err.find("trace hash " + row["hash"].get<std::string>()), std::string::npos) << again.err;
  EXPECT_EQ(campaign({"show", "c.campaign.toml", "0000000000000000"}).exit_code, 66);
}

TEST_F(CampaignVerb, WhatIsThereIsNotRunAgain) {
  run("out");
  const std::string before = text("out/shard-1-of-1.jsonl");
  const auto again = run("out");
  EXPECT_EQ(again.exit_code, 1);
  EXPECT_NE(again.out.find("18 of them were there already"), std::string::npos) << again.out;
  EXPECT_EQ(text("out/shard-1-of-1.jsonl"), before);
  EXPECT_FALSE(fs::exists(folder_.path() / "out/shard-1-of-1.lock"));
}

TEST_F(CampaignVerb, ShardsArePartsAndMergeIntoTheSame) {
  run("whole");
  for (const char* shard : {"3/3", "1/3", "2/3"}) EXPECT_EQ(run("parts", {"--shard", shard, "--jobs", "2"}).exit_code, 1);
  EXPECT_EQ(rows("parts/shard-2-of-3.jsonl").size(), 6U);
  for (const char* form : {"--csv", "--junit", "--html"}) {
    const auto whole = campaign({"merge", "whole", form, "-"});
    const auto parts = campaign({"merge", "parts", form, "-"});
    EXPECT_EQ(whole.exit_code, 1) << whole.err;
    EXPECT_EQ(whole.out, parts.out) << form;
  }
  for (const char* wrong : {"0/3", "4/3", "1", "1/0", "a/b", "1/3x", "-1/3"}) EXPECT_EQ(run("parts", {"--shard", wrong}).exit_code, 64) << wrong;
}

TEST_F(CampaignVerb, CsvHasFactorsThenMeasuresInTheOrderOfThePlan) {
  run("out", {"--jobs", "2"});
  const auto csv = campaign({"merge", "out", "--csv", "-"}).out;
  EXPECT_TRUE(csv.starts_with("a.lIn,a.P130,bus.sbus.baud,out\n2,1 s,125000,4\n2,1 s,500000,4\n2,1.5 s,125000,4\n")) << csv;
  EXPECT_TRUE(csv.ends_with("2 s,500000,8\n")) << csv;
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 19);
}

TEST_F(CampaignVerb, AFailureComesMadeSmallAndWithThoseThatAreAlike) {
  const auto ran = run("out");
  EXPECT_NE(ran.out.find("12 cases: p.toml:11:1: lOut of a is 4 at 20 ms, expected 6\n  it fails so with a.lIn = 2, and every other factor at its middle value\n"
                         "  ipos campaign run c.campaign.toml --factor a.lIn=2\n"),
            std::string::npos)
      << ran.out;
  const auto small = campaign({"run", "c.campaign.toml", "--factor", "a.lIn=2"});
  EXPECT_EQ(small.exit_code, 1);
  EXPECT_NE(small.out.find("a.P130 = 1.5 s"), std::string::npos) << small.out;
  EXPECT_EQ(campaign({"run", "c.campaign.toml", "--middle"}).exit_code, 0);
  EXPECT_EQ(campaign({"run", "c.campaign.toml", "--factor", "a.lIn=7"}).exit_code, 64);
}

TEST_F(CampaignVerb, ACaseThatTakesTooLongIsAResult) {
  folder_.write("c.campaign.toml",
                "plant = \"p.toml\"\nfor = \"100000s\"\nlimit = \"300ms\"\n[[vary]]\nstation = \"a\"\nvariable = \"lIn\"\nvalues = [3, 4]\n");
  folder_.write("A.IPC", "long lIn, lOut;\nmain() { while (1) { lOut = lIn * 2; H200 = H200 + lOut; } }\n");
  const auto ran = run("out", {"--jobs", "2"});
  EXPECT_EQ(ran.exit_code, 1) << ran.err;
  for (const json& row : rows("out/shard-1-of-1.jsonl")) {
    EXPECT_EQ(row["failed"].dump(), "[\"time\"]");
    EXPECT_EQ(row["hash"], "");
  }
}

TEST_F(CampaignVerb, AChangedPlantGivesNewCasesAndTheMixtureIsRefused) {
  run("out");
  folder_.write("p.toml", std::string(kPlant) + "\n# changed\n");
  run("out");
  EXPECT_EQ(rows("out/shard-1-of-1.jsonl").size(), 36U);
  const auto merged = campaign({"merge", "out", "--csv", "x.csv"});
  EXPECT_EQ(merged.exit_code, 65);
  EXPECT_NE(merged.err.find("mixture"), std::string::npos) << merged.err;
  EXPECT_NE(merged.err.find("p.toml has changed"), std::string::npos) << merged.err;
  EXPECT_FALSE(fs::exists(folder_.path() / "x.csv"));
}

TEST_F(CampaignVerb, AnIncludedFileDecidesToo) {
  folder_.write("A.IPC", "#include \"f.h\"\nlong lIn, lOut;\nmain() { while (1) { lOut = lIn * FACTOR; } }\n");
  folder_.write("f.h", "#define FACTOR 2\n");
  run("out");
  folder_.write("f.h", "#define FACTOR 3\n");
  run("out");
  EXPECT_EQ(rows("out/shard-1-of-1.jsonl").size(), 36U);
}

TEST_F(CampaignVerb, MergeSaysWhatIsMissingDoubleOrContradicts) {
  run("out", {"--shard", "1/2"});
  auto merged = campaign({"merge", "out", "--csv", "x.csv"});
  EXPECT_EQ(merged.exit_code, 65);
  EXPECT_NE(merged.err.find("9 of 18 cases are missing"), std::string::npos) << merged.err;
  EXPECT_TRUE(fs::exists(folder_.path() / "x.csv"));

  run("out");
  fs::copy(folder_.path() / "out", folder_.path() / "twice");
  merged = campaign({"merge", "out", "twice"});
  EXPECT_EQ(merged.exit_code, 65);
  EXPECT_NE(merged.err.find("18 cases are double"), std::string::npos) << merged.err;

  std::string wrong = text("twice/shard-1-of-2.jsonl");
  wrong.replace(wrong.find("\"hash\":\"") + 8, 4, "dead");
  folder_.write("twice/shard-1-of-2.jsonl", wrong);
  merged = campaign({"merge", "out", "twice"});
  EXPECT_EQ(merged.exit_code, 65);
  EXPECT_NE(merged.err.find("contradict"), std::string::npos) << merged.err;
  EXPECT_EQ(campaign({"merge", "nowhere"}).exit_code, 66);
}

TEST_F(CampaignVerb, ATornLastLineIsDroppedAndTold) {
  run("out");
  const std::string whole = text("out/shard-1-of-1.jsonl");
  folder_.write("out/shard-1-of-1.jsonl", whole.substr(0, whole.size() - 20));
  EXPECT_NE(campaign({"merge", "out"}).err.find("not whole"), std::string::npos);
  const auto again = run("out");
  EXPECT_NE(again.err.find("its last line was not whole"), std::string::npos) << again.err;
  EXPECT_EQ(rows("out/shard-1-of-1.jsonl").size(), 18U);
  EXPECT_EQ(campaign({"merge", "out"}).exit_code, 1);
}

TEST_F(CampaignVerb, TestsCountWithTheirExpectations) {
  folder_.write("t.test.toml", "plant = \"p.toml\"\n[[expect]]\nvariable = \"lOut\"\nat = \"20ms\"\nmin = 5\n");
  folder_.write("c.campaign.toml",
                "tests = [\"t.test.toml\"]\n[[vary]]\nstation = \"a\"\nvariable = \"lIn\"\nvalues = [2, 3]\n"
                "[[fault]]\nname = \"lost\"\nbus = \"sbus\"\nkind = \"drop\"\nrate = 500\nseeds = \"1..3\"\nat = [\"5ms\", \"10ms\"]\n");
  const auto plan = campaign({"plan", "c.campaign.toml"});
  EXPECT_TRUE(plan.out.ends_with("\n12 cases\n")) << plan.out << plan.err;
  EXPECT_EQ(run("out").exit_code, 1);
  for (const json& row : rows("out/shard-1-of-1.jsonl")) {
    ASSERT_EQ(row["failed"].size(), row["factors"]["a.lIn"] == 2 ? 1U : 0U);
    if (!row["failed"].empty()) {
      EXPECT_TRUE(row["failed"][0].get<std::string>().starts_with("t.test.toml:2:1: ")) << row;
    }
    EXPECT_TRUE(row["factors"].contains("lost.seed"));
    EXPECT_TRUE(row["factors"].contains("lost.at"));
  }
}

// A call on the way down turns the cabin round. The test of the example does not see it, as nobody calls meanwhile.
TEST_F(CampaignVerb, FindsAMistakeInTheHoistThatItsTestDoesNot) {
  const fs::path hoist = fs::path(IPOS_SOURCE_DIR) / "examples/hoist";
  for (const auto& file : fs::directory_iterator(hoist)) fs::copy(file.path(), folder_.path());
  EXPECT_EQ(campaign({"run", "hoist.campaign.toml", "--out", "good"}).exit_code, 0);
  std::string program = text("HOIST.IPC");
  const std::string down = "_GoAbs(GO_WAIT, GROUND);";
  folder_.write("HOIST.IPC", program.replace(program.rfind(down), down.size(),
                                             "_GoAbs(GO_NOWAIT, GROUND);\n            while (ActPos_Mot > GROUND + 10)\n"
                                             "                if (DI10) _GoAbs(GO_NOWAIT, UPPER);"));
  EXPECT_EQ(run_ipos({"test", "hoist.test.toml"}, folder_.path()).exit_code, 0);
  const auto found = campaign({"run", "hoist.campaign.toml", "--out", "bad"});
  EXPECT_EQ(found.exit_code, 1) << found.out;
  EXPECT_NE(found.out.find("27 cases: 0 good, 27 failed"), std::string::npos) << found.out;
}

TEST_F(CampaignVerb, CoverageIsSummedOverAllShards) {
  folder_.write("A.IPC", "long lIn, lOut;\nmain() {\n  while (1) {\n    if (lIn == 2)\n      lOut = 4;\n    else if (lIn == 9)\n      lOut = 5;\n    else\n      lOut = 6;\n  }\n}\n");
  for (const char* shard : {"1/2", "2/2"}) run("out", {"--shard", shard, "--coverage", "--jobs", "2"});
  const std::string page = campaign({"merge", "out", "--html", "-"}).out;
  EXPECT_NE(page.find("\"unreached\":[7]"), std::string::npos);
}

struct Mistake {
  std::string text, place, says;
};
class CampaignMistake : public CampaignVerb, public testing::WithParamInterface<Mistake> {};

TEST_P(CampaignMistake, IsToldWithItsPlace) {
  folder_.write("c.campaign.toml", GetParam().text);
  const auto plan = campaign({"plan", "c.campaign.toml"});
  EXPECT_EQ(plan.exit_code, 65);
  EXPECT_NE(plan.err.find("c.campaign.toml:" + GetParam().place + ": error: "), std::string::npos) << plan.err;
  EXPECT_NE(plan.err.find(GetParam().says), std::string::npos) << plan.err;
}

INSTANTIATE_TEST_SUITE_P(
    All, CampaignMistake,
    testing::Values(
        Mistake{"plant = \"p.toml\"\nfoo = 1\n", "2:1", "unknown key 'foo'"}, Mistake{"for = \"5s\"\n", "1:1", "either plant"},
        Mistake{"plant = \"x.toml\"\n", "1:9", "x.toml"}, Mistake{"plant = \"p.toml\"\nsample = \"some\"\n", "2:10", "sample is grid"},
        Mistake{"plant = \"p.toml\"\nsample = \"random\"\n", "2:10", "needs count"},
        Mistake{"plant = \"p.toml\"\n[[vary]]\nstation = \"b\"\nvariable = \"lIn\"\nvalues = [1]\n", "3:11", "no station 'b'"},
        Mistake{"plant = \"p.toml\"\n[[vary]]\nstation = \"a\"\nvariable = \"lNone\"\nvalues = [1]\n", "5:11", "lNone"},
        Mistake{"plant = \"p.toml\"\n[[vary]]\nstation = \"a\"\nparameter = \"P9999\"\nvalues = [1]\n", "4:13", "no parameter P9999"},
        Mistake{"plant = \"p.toml\"\n[[vary]]\nstation = \"a\"\nparameter = \"P130\"\nvalues = [\"1 s\", \"1 m\"]\n", "5:18", "P130"},
        Mistake{"plant = \"p.toml\"\n[[vary]]\nstation = \"a\"\nvariable = \"lIn\"\nvalues = [1, 1]\n", "5:14", "twice"},
        Mistake{"plant = \"p.toml\"\n[[vary]]\nkey = \"bus.can.baud\"\nvalues = [1]\n", "4:11", "no bus 'can'"},
        Mistake{"plant = \"p.toml\"\n[[vary]]\nkey = \"bus.sbus.baud\"\nvalues = [17]\n", "4:11", "baud"},
        Mistake{"plant = \"p.toml\"\n[[vary]]\nstation = \"a\"\nvariable = \"lIn\"\nfrom = 1\nto = 3\n", "2:1", "steps"},
        Mistake{"plant = \"p.toml\"\n[[measure]]\nsignal = \"a.nothing\"\ntake = \"max\"\n", "3:10", "nothing"},
        Mistake{"plant = \"p.toml\"\n[[measure]]\nsignal = \"a.speed\"\ntake = \"most\"\n", "4:8", "take is one of"},
        Mistake{"plant = \"p.toml\"\n[[measure]]\nsignal = \"a.speed\"\ntake = \"time\"\n", "2:1", "above, below, equals"},
        Mistake{"plant = \"p.toml\"\n[fault]\nbus = \"sbus\"\n", "2:1", "write [[fault]]"},
        Mistake{"plant = \"p.toml\"\n[[fault]]\nbus = \"sbus\"\nkind = \"drop\"\nseeds = \"9..1\"\n", "5:9", "seeds"}));

}  // namespace
