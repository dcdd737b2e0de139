// ipos test --mutate as a user meets it: what it prints, its exit codes, marks, headers and plants, and its reports.
#include <gtest/gtest.h>

#include <fmt/format.h>
#include <tinyxml2.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/harness/contains.hpp"
#include "tests/tools/command.hpp"
#include "tools/mutants/trial.hpp"

namespace ipos::tests {
namespace {

// Ten mistakes, counted by hand.
const std::string kProgram =
    "long a, b, c;\n"
    "main()\n"
    "{\n"
    "    a = 20;\n"          // removed, 20 became 22
    "    if (a < 30)\n"      // < became <=, 30 became 33
    "        b = 3;\n"       // removed, 3 became 4
    "    if (b == 5)\n"      // == became !=, 5 became 6
    "        c = 4;\n"       // removed, 4 became 5
    "}\n";

class Mutate : public ::testing::Test {
 protected:
  CommandResult run(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"test", "--mutate"});
    return run_ipos(arguments, folder_.path());
  }
  TemporaryFolder folder_;
};

TEST_F(Mutate, SurvivorsHaveTheirLinesAndTheScoreIsLast) {
  folder_.write("A.IPC", kProgram + "// expect b == 3\n// expect a == 20\n");
  const CommandResult result = run({"A.IPC"});
  EXPECT_EQ(result.exit_code, 1);
  // a never comes near 30, so the limit is not tested; c is not looked at.
  EXPECT_EQ(result.out,
            "A.IPC:5:11: < became <=\n"
            "A.IPC:5:13: 30 became 33\n"
            "A.IPC:7:11: == became !=\n"
            "A.IPC:7:14: 5 became 6\n"
            "A.IPC:8:9: removed: c = 4; (no test reaches it)\n"
            "A.IPC:8:13: 4 became 5 (no test reaches it)\n"
            "score 40 % (4 of 10 noticed)\n");
  EXPECT_EQ(result.err, "");
}

TEST_F(Mutate, ABetterTestNoticesMore) {
  folder_.write("A.IPC", kProgram + "// expect b == 3\n// expect a == 20\n// expect c == 0\n");
  const CommandResult result = run({"A.IPC"});
  EXPECT_FALSE(contains(result.out, "7:11")) << result.out;
  EXPECT_TRUE(result.out.ends_with("score 50 % (5 of 10 noticed)\n")) << result.out;
}

TEST_F(Mutate, AllNoticedIsGood) {
  folder_.write("A.IPC", "long a;\nmain()\n{\n    a = 20;\n}\n// expect a == 20\n");
  const CommandResult result = run({"A.IPC"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.out, "score 100 % (2 of 2 noticed)\n");
}

TEST_F(Mutate, MarksTakeOutTheirStatement) {
  folder_.write("A.IPC",
                "long a, b, c;\n"
                "main()\n"
                "{\n"
                "    a = 20;\n"
                "    if (a < 30)  // equivalent: a is 20\n"
                "        b = 3;\n"
                "    c = a +\n"
                "        4;  // equivalent: nobody looks at c\n"
                "}\n"
                "// expect b == 3\n// expect a == 20\n");
  const CommandResult result = run({"A.IPC"});
  EXPECT_EQ(result.exit_code, 0) << result.out;
  // Line 5: <, 30. Lines 7 and 8: removed, c and a swapped, +, 4. A mark of a head says nothing of what stands below it.
  EXPECT_EQ(result.out, "6 mistakes are taken out by `// equivalent`\nscore 100 % (4 of 4 noticed)\n");
  EXPECT_EQ(result.err, "");
}

TEST_F(Mutate, MarksThatSayNothingAreTold) {
  folder_.write("A.IPC",
                "long a;  // equivalent: a declaration\n"
                "main()\n"
                "{\n"
                "    a = 20;  // equivalent:\n"
                "}\n"
                "// expect a == 20\n");
  const CommandResult result = run({"A.IPC"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.out, "score 100 % (2 of 2 noticed)\n");
  EXPECT_EQ(result.err,
            "ipos: note: A.IPC:1:10: `// equivalent` stands behind nothing that could be wrong\n"
            "ipos: note: A.IPC:4:14: `// equivalent:` needs a reason behind it\n");
}

TEST_F(Mutate, WhatCannotBeSeenIsNotPlanted) {
  // Another constant keeps a loop going as well; what nobody calls has no code; a sum and a comparison know no order; a break at
  // the end is no command.
  folder_.write("A.IPC",
                "long a, b, c;\n"
                "Unused()\n"
                "{\n"
                "    a = 5;\n"
                "}\n"
                "main()\n"
                "{\n"
                "    a = 20;  // equivalent: given\n"
                "    b = 30;  // equivalent: given\n"
                "    c = a + b;\n"
                "    if (a == b) c = 7;  // equivalent: given\n"
                "    while (1)\n"
                "    {\n"
                "        switch (a)\n"
                "        {\n"
                "            case 20:  // equivalent: given\n"
                "                break;\n"
                "        }\n"
                "    }\n"
                "}\n"
                "// expect c == 50 at 1s\n");
  const CommandResult list = run({"--list", "A.IPC"});
  EXPECT_EQ(list.out,
            "A.IPC:10:5: removed: c = a + b;\n"
            "A.IPC:10:5: c and a swapped\n"
            "A.IPC:10:11: + became -\n"
            "A.IPC:12:12: 1 became 0\n")
      << list.err;
}

TEST_F(Mutate, FaultsAndProgramsThatHangAreNoticed) {
  folder_.write("A.IPC",
                "long a, b;\n"
                "main()\n"
                "{\n"
                "    a = 0;  // equivalent: given\n"
                "    b = 12;  // equivalent: given\n"
                "    a = a / b;\n"           // swapped: a division by 0
                "    while (b > 0) b = b - 4;\n"  // removed, or +: without end
                "}\n"
                "// expect b == 0\n");
  const CommandResult result = run({"A.IPC"});
  EXPECT_FALSE(contains(result.out, "a and b swapped")) << result.out;
  EXPECT_FALSE(contains(result.out, "removed: b = b - 4;")) << result.out;
  EXPECT_FALSE(contains(result.out, "- became +")) << result.out;
}

TEST_F(Mutate, TestsHaveToPassFirst) {
  folder_.write("A.IPC", "long a;\nmain()\n{\n    a = 20;\n}\n// expect a == 21\n");
  const CommandResult failed = run({"A.IPC"});
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_EQ(failed.out, "");
  EXPECT_TRUE(contains(failed.err, "a of A is 20 at")) << failed.err;
  EXPECT_TRUE(contains(failed.err, "ipos: 1 test does not pass as it is now: nothing was planted\n")) << failed.err;
  folder_.write("A.IPC", "long a;\nmain()\n{\n    a = ;\n}\n// expect a == 21\n");
  const CommandResult malformed = run({"A.IPC"});
  EXPECT_EQ(malformed.exit_code, 65) << malformed.out << malformed.err;
  EXPECT_TRUE(contains(malformed.err, "A.IPC:4:9: error:")) << malformed.err;
}

TEST_F(Mutate, RefusesOptionsOfASingleRun) {
  folder_.write("A.IPC", kProgram + "// expect a == 20\n");
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{"--watch"}, {"--fail-fast"}, {"--repeat", "2"}, {"--tap", "-"}, {"--artifacts", "x"},
        {"--coverage", "c.info"}, {"--durations", "3"}}) {
    std::vector<std::string> arguments{"A.IPC"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(run(arguments).exit_code, 64) << more.front();
  }
}

// Both stations have the header; the #define is one mistake, wherever and for whatever it is used.
TEST_F(Mutate, HeadersAndMacrosOfAPlant) {
  folder_.write("lib.h", "#define STEP 4\nlong total;\nAdd()\n{\n    total = total + STEP;\n}\n");
  folder_.write("A.IPC", "#include \"lib.h\"\nmain()\n{\n    Add();\n    H100 = STEP;\n    _Wait(STEP);\n}\n");
  folder_.write("B.IPC", "#include \"lib.h\"\nmain()\n{\n    Add();\n    Add();\n}\n");
  folder_.write("two.test.toml",
                "[[station]]\nname = \"a\"\nunit = \"md60a\"\nprogram = \"A.IPC\"\n"
                "[[station]]\nname = \"b\"\nunit = \"md60a\"\nprogram = \"B.IPC\"\n"
                "[[expect]]\nstation = \"a\"\nvariable = \"H100\"\nequals = 4\nat = \"100ms\"\n"
                "[[expect]]\nstation = \"b\"\nvariable = \"total\"\nequals = 8\nat = \"100ms\"\n");
  const CommandResult list = run({"--list", "two.test.toml"});
  EXPECT_EQ(list.out,
            "A.IPC:4:5: removed: Add();\n"
            "A.IPC:5:5: removed: H100 = STEP;\n"
            "A.IPC:6:5: removed: _Wait(STEP);\n"
            "B.IPC:4:5: removed: Add();\n"
            "lib.h:1:14: STEP: 4 became 5\n"
            "lib.h:5:5: removed: total = total + STEP;\n"
            "lib.h:5:19: + became -\n")
      << list.err;
  const CommandResult result = run({"."});
  // Nobody looks at total of a. Add() of B is removed once: it is the same code whichever of the two goes.
  EXPECT_EQ(result.out, "A.IPC:4:5: removed: Add();\nA.IPC:6:5: removed: _Wait(STEP);\nscore 71 % (5 of 7 noticed)\n") << result.err;
}

// What a macro of a built-in header stands for is right; the one that is used may be the wrong one.
TEST_F(Mutate, MacrosOfBuiltInHeadersAreTakenForOthers) {
  folder_.write("A.IPC", "#include <iob.h>\nlong a;\nmain()\n{\n    while (1) if (DI10) a = 5;\n}\n");
  folder_.write("a.test.toml",
                "[[station]]\nname = \"u\"\nunit = \"mdxb\"\nprogram = \"A.IPC\"\n"
                "[[expect]]\nvariable = \"a\"\nequals = 0\nat = \"50ms\"\n"
                "[[step]]\ninput = \"DI10\"\nset = 1\nat = \"60ms\"\n"
                "[[expect]]\nvariable = \"a\"\nequals = 5\nat = \"100ms\"\n");
  const CommandResult result = run({"a.test.toml"});
  EXPECT_EQ(result.out, "score 100 % (5 of 5 noticed)\n") << result.err;
  EXPECT_EQ(run({"a.test.toml", "--list"}).out,
            "A.IPC:5:12: 1 became 0\nA.IPC:5:19: DI10 became !DI10\nA.IPC:5:19: DI10: 8 became 9\n"
            "A.IPC:5:25: removed: a = 5;\nA.IPC:5:29: 5 became 6\n");
}

TEST_F(Mutate, OnlyTestsThatReachAMistakeCount) {
  folder_.write("A.IPC", kProgram + "// expect b == 3\n// expect a == 20\n");
  folder_.write("B.IPC", "long a;\nmain()\n{\n    a = 20;\n}\n// expect a == 20\n");
  const CommandResult both = run({"."});
  EXPECT_TRUE(both.out.ends_with("score 50 % (6 of 12 noticed)\n")) << both.out;
  const CommandResult chosen = run({".", "--filter", "B*"});
  EXPECT_EQ(chosen.out, "score 100 % (2 of 2 noticed)\n") << chosen.err;
  EXPECT_EQ(run({".", "--jobs", "1"}).out, both.out);
  EXPECT_EQ(run({".", "--jobs", "4"}).out, both.out);
}

TEST_F(Mutate, Json) {
  folder_.write("A.IPC", kProgram + "// expect b == 3\n// expect a == 20\n");
  const CommandResult result = run({"A.IPC", "--format", "json"});
  EXPECT_EQ(result.exit_code, 1);
  const auto report = nlohmann::json::parse(result.out);
  EXPECT_EQ(report["score"], 40);
  EXPECT_EQ(report["noticed"], 4);
  EXPECT_EQ(report["planted"], 10);
  EXPECT_EQ(report["equivalent"], 0);
  ASSERT_EQ(report["mutants"].size(), 10U);
  EXPECT_EQ(report["mutants"][0], (nlohmann::json{{"file", "A.IPC"}, {"line", 4}, {"column", 5}, {"kind", "statement"},
                                                  {"text", "removed: a = 20;"}, {"outcome", "noticed"}, {"test", "A.IPC"}}));
  EXPECT_EQ(report["mutants"][2]["outcome"], "missed");
  EXPECT_EQ(report["mutants"][9]["outcome"], "unreached");
}

TEST_F(Mutate, JUnitAndHtml) {
  folder_.write("A.IPC", "long a, c;\nmain()\n{\n    a = 20;\n    c = 4 < a;\n    c = 2;  // equivalent: <nobody>\n}\n// expect a == 20\n");
  const CommandResult result = run({"A.IPC", "--junit", "r.xml", "--html", "r.html"});
  EXPECT_EQ(result.exit_code, 1);
  tinyxml2::XMLDocument xml;
  ASSERT_EQ(xml.LoadFile((folder_.path() / "r.xml").c_str()), tinyxml2::XML_SUCCESS);
  const auto* suite = xml.FirstChildElement("testsuites")->FirstChildElement("testsuite");
  EXPECT_STREQ(suite->Attribute("name"), "A.IPC");
  // Lines 4 to 6: 2, 4 (removed, swapped, 4, <) and 2.
  EXPECT_EQ(suite->IntAttribute("tests"), 8);
  EXPECT_EQ(suite->IntAttribute("skipped"), 2);
  size_t failures = 0;
  for (const auto* one = suite->FirstChildElement("testcase"); one != nullptr; one = one->NextSiblingElement("testcase"))
    failures += one->FirstChildElement("failure") != nullptr ? 1U : 0U;
  EXPECT_EQ(static_cast<int>(failures), suite->IntAttribute("failures"));
  const std::string html = read_text(folder_.path() / "r.html");
  for (const char* part :
       {"<h1>score ", "<h2 id=\"f1\">A.IPC</h2>", "<tr class=\"noticed\" title=\"2 noticed\"><td class=\"number\">4</td>",
        "<code>    c = 4 &lt; a;</code></td></tr>\n<tr class=\"survivor\"><td></td><td class=\"told\">removed: c = 4 &lt; a;</td>",
        "&lt; became &lt;=", "(equivalent: &lt;nobody&gt;)"})
    EXPECT_TRUE(contains(html, part)) << part << html;
  EXPECT_FALSE(contains(html, "http")) << "it stands alone";
}

TEST_F(Mutate, GitHubShowsSurvivors) {
  folder_.write("A.IPC", kProgram + "// expect b == 3\n// expect a == 20\n");
  const CommandResult result = run({"A.IPC", "--format", "github"});
  EXPECT_TRUE(contains(result.out, "::warning file=A.IPC,line=5,col=11,title=no test notices::< became <=\n")) << result.out;
  EXPECT_TRUE(result.out.ends_with("score 40 % (4 of 10 noticed)\n")) << result.out;
}

// Thirteen mistakes, counted by hand: 200; 1; <; two of SET_DO01 and two of CLEAR_DO01, gone and bit 2; >, 250; lHot++ gone and
// --; the wait gone and twice as long. Its test tries 20 and 220 degrees and looks at DO01: it notices the 1 and all of the
// outputs.
TEST_F(Mutate, TheHeaterOfTheDocumentation) {
  const std::string folder = "tests/tools/mutate/heater";
  const CommandResult result = run_ipos({"test", "--mutate", folder}, project(""));
  const std::string file = folder + "/HEATER.IPC";
  EXPECT_EQ(result.out, file + ":5:16: WANTED: 200 became 220\n" + file + ":13:22: < became <=\n" + file + ":17:22: > became >=\n" +
                            file + ":17:24: 250 became 275\n" + file + ":18:13: removed: lHot++; (no test reaches it)\n" + file +
                            ":18:13: ++ became -- (no test reaches it)\n" + file + ":19:9: removed: _Wait(100);\n" + file +
                            ":19:15: a wait of 100 ms became one of 200 ms\nscore 38 % (5 of 13 noticed)\n");
  EXPECT_TRUE(contains(read_text(project("docs/guide/testing.md")), "$ ipos test --mutate " + folder + "\n" + result.out + "```\n"));
}

// The table of docs/inside/checks.md: of each example what is noticed, planted and taken out.
TEST_F(Mutate, TheTableOfTheExamples) {
  const CommandResult result = run_ipos({"test", "--mutate", "examples", "--format", "json"}, project(""));
  const auto report = nlohmann::json::parse(result.out, nullptr, false);
  ASSERT_FALSE(report.is_discarded()) << result.out << result.err;
  struct Sums {
    int noticed = 0, planted = 0, equivalent = 0;
  };
  std::map<std::string, Sums> examples;
  for (const auto& mutant : report["mutants"]) {
    const std::string file = mutant["file"];  // examples/hoist/HOIST.IPC
    Sums& sums = examples[file.substr(9, file.find('/', 9) - 9)];
    const std::string outcome = mutant["outcome"];
    sums.noticed += outcome == "noticed" ? 1 : 0;
    sums.equivalent += outcome == "equivalent" ? 1 : 0;
    sums.planted += outcome == "equivalent" ? 0 : 1;
  }
  EXPECT_GE(examples.size(), 21U);
  const std::string page = read_text(project("docs/inside/checks.md"));
  for (const auto& [name, sums] : examples) {
    const std::string row = fmt::format("| `{}` | {} of {} | {} |", name, sums.noticed, sums.planted, sums.equivalent);
    EXPECT_TRUE(contains(page, row)) << row;
  }
  EXPECT_TRUE(contains(page, fmt::format("{} of {} mistakes", report["noticed"].get<int>(), report["planted"].get<int>())))
      << report["noticed"] << " of " << report["planted"];
}

// Of what a test takes without a mistake, with room for a busy machine, and never more than the user allows.
TEST(MutateTime, HasALimitFromTheCleanRun) {
  EXPECT_EQ(tools::mutants::limit_of(0.01, 600), 21U);
  EXPECT_EQ(tools::mutants::limit_of(5, 600), 120U);
  EXPECT_EQ(tools::mutants::limit_of(100, 600), 600U);
  EXPECT_EQ(tools::mutants::limit_of(0.01, 5), 5U);
}

}  // namespace
}  // namespace ipos::tests
