// Coverage of a sample whose figures were counted by hand, and its forms as other tools read them.
#include <gtest/gtest.h>
#include <tinyxml2.h>

#include <cstdlib>
#include <memory>
#include <sstream>

#include "compiler/compile.hpp"
#include "tests/tools/command.hpp"
#include "tools/coverage/collector.hpp"
#include "tools/coverage/write.hpp"

namespace ipos::tools::coverage {
namespace {

const std::string kSample =
    "long turn;\n"                              //  1
    "long a;\n"                                 //  2
    "long sum;\n"                               //  3
    "weigh()\n"                                 //  4
    "{\n"                                       //  5
    "  if (a > 1 && turn == 0)\n"               //  6
    "    sum = sum + 10;\n"                     //  7
    "  else\n"                                  //  8
    "    sum = sum + 1;\n"                      //  9
    "  sum = sum * 2;\n"                        // 10
    "}\n"                                       // 11
    "main()\n"                                  // 12
    "{\n"                                       // 13
    "  for (turn = 0; turn < TURNS; turn++)\n"  // 14
    "  {\n"                                     // 15
    "    a = 0;\n"                              // 16
    "    while (a < 3)\n"                       // 17
    "    {\n"                                   // 18
    "      weigh();\n"                          // 19
    "      a++;\n"                              // 20
    "    }\n"                                   // 21
    "    switch (turn)\n"                       // 22
    "    {\n"                                   // 23
    "      case 0: sum = sum + 100; break;\n"   // 24
    "      case 1: sum = sum + 200; break;\n"   // 25
    "      default: sum = sum + 300;\n"         // 26
    "    }\n"                                   // 27
    "  }\n"                                     // 28
    "}\n";                                      // 29

vm::Image compiled(const std::string& text, const std::vector<std::string>& defines) {
  compiler::CompileOptions options;
  options.unit = stdlib::find_unit("mdxb");
  options.defines = defines;
  const compiler::Compilation result = compiler::compile("S.IPC", "", text, options);
  EXPECT_TRUE(result.image.has_value());
  return result.image.value_or(vm::Image{});
}

std::unique_ptr<runtime::Plant> plant_of(const std::vector<vm::Image>& images) {
  std::string text;
  for (size_t n = 0; n < images.size(); ++n)
    text += "[[station]]\nname = \"u" + std::to_string(n) + "\"\nunit = \"mdxb\"\nprogram = \"S.IPC\"\n";
  std::vector<runtime::PlantError> errors;
  auto plant = std::make_unique<runtime::Plant>(
      runtime::read_plant_file(text).plant,
      std::vector<std::optional<vm::Image>>(images.begin(), images.end()), vm::Rates{{10, 10, 10}}, errors);
  EXPECT_TRUE(errors.empty());
  return plant;
}

Coverage coverage_of(const std::vector<vm::Image>& images, runtime::Time time = runtime::kSecond) {
  const auto plant = plant_of(images);
  const Collector collector(*plant);
  plant->run_until(time);
  return collector.coverage();
}

Coverage coverage_of(const std::string& text, const std::vector<std::string>& defines) {
  return coverage_of({compiled(text, defines)});
}

using Lines = std::map<uint32_t, uint64_t>;

// The two ways of each condition, by line and in order of columns.
std::vector<std::array<uint64_t, 3>> ways(const SourceFile& file) {
  std::vector<std::array<uint64_t, 3>> all;
  for (const auto& [key, condition] : file.conditions)
    all.push_back({key.at.line, condition.ways[0].count, condition.ways[1].count});
  return all;
}

void expect_figure(const Figure& figure, size_t covered, size_t all) {
  EXPECT_EQ(figure.covered, covered);
  EXPECT_EQ(figure.all, all);
}

std::string text_of(void (*write)(std::ostream&, const Coverage&), const Coverage& coverage) {
  std::ostringstream out;
  write(out, coverage);
  return out.str();
}

// Counted by hand for TURNS = 3. weigh() runs for a = 0, 1, 2 in each of the turns 0, 1, 2: 9 times.
//    6   9 calls. a > 1: 3 times (a is 2), 6 times not. Then turn == 0: once (turn 0), twice not
//    7   once                       9   8 times                    10, 11   9 times
//   14   turn++ and turn < 3 behind it 3 times: the first test is known when compiling and makes no command.
//        turn < 3: twice, once not
//   16   once a turn: 3
//   17   the test before the loop 3 times, that behind a++ 9 times: 9. a < 3: 3 * 3 times; once a turn not
//   19, 20   9 times
//   22   3 times. 0: once, else twice; then 1: once, else once
//   24, 25, 26   once each         29   once
TEST(Coverage, AllPathsOfTheSample) {
  const Coverage coverage = coverage_of(kSample, {"TURNS=3"});
  ASSERT_EQ(coverage.files.size(), 1U);
  const SourceFile& file = coverage.files.at("S.IPC");
  EXPECT_EQ(file.lines, (Lines{{6, 9},
                               {7, 1},
                               {9, 8},
                               {10, 9},
                               {11, 9},
                               {14, 3},
                               {16, 3},
                               {17, 9},
                               {19, 9},
                               {20, 9},
                               {22, 3},
                               {24, 1},
                               {25, 1},
                               {26, 1},
                               {29, 1}}));
  // Way 0 goes on to what is written behind: into the `if`, out of the `for` (tested at its end), into the
  // `while` (tested before it), to the next case.
  EXPECT_EQ(ways(file), (std::vector<std::array<uint64_t, 3>>{
                            {6, 3, 6}, {6, 1, 2}, {14, 1, 2}, {17, 9, 3}, {22, 2, 1}, {22, 1, 1}}));
  EXPECT_EQ(file.functions.at("weigh").count, 9U);
  EXPECT_EQ(file.functions.at("weigh").line, 6U);
  EXPECT_EQ(file.functions.at("main").count, 1U);
  const Figures all = figures(coverage);
  expect_figure(all.lines, 15, 15);
  expect_figure(all.branches, 12, 12);
  expect_figure(all.functions, 2, 2);
}

// TURNS = 1: turn 0 alone. weigh() runs 3 times; turn == 0 never fails (line 6), no second turn (14), nothing
// but case 0 (22, 25, 26): 13 of 15 lines, and of 12 branches those of line 6: 3, 14: 1, 17: 2, 22: 1,
// together 7.
TEST(Coverage, MissedPathsOfTheSample) {
  const Coverage coverage = coverage_of(kSample, {"TURNS=1"});
  const SourceFile& file = coverage.files.at("S.IPC");
  EXPECT_EQ(file.lines, (Lines{{6, 3},
                               {7, 1},
                               {9, 2},
                               {10, 3},
                               {11, 3},
                               {14, 1},
                               {16, 1},
                               {17, 3},
                               {19, 3},
                               {20, 3},
                               {22, 1},
                               {24, 1},
                               {25, 0},
                               {26, 0},
                               {29, 1}}));
  EXPECT_EQ(ways(file), (std::vector<std::array<uint64_t, 3>>{
                            {6, 1, 2}, {6, 1, 0}, {14, 1, 0}, {17, 3, 1}, {22, 0, 1}, {22, 0, 0}}));
  const Figures all = figures(coverage);
  expect_figure(all.lines, 13, 15);
  expect_figure(all.branches, 7, 12);
  expect_figure(all.functions, 2, 2);
}

TEST(Coverage, RunsAndStationsAddUp) {
  Coverage sum = coverage_of(kSample, {"TURNS=1"});
  sum.merge(coverage_of(kSample, {"TURNS=3"}));
  const Coverage stations = coverage_of({compiled(kSample, {"TURNS=1"}), compiled(kSample, {"TURNS=3"})});
  EXPECT_EQ(text_of(write_lcov, sum), text_of(write_lcov, stations));
  const SourceFile& file = sum.files.at("S.IPC");
  EXPECT_EQ(file.lines.at(6), 12U);
  EXPECT_EQ(ways(file)[0], (std::array<uint64_t, 3>{6, 4, 8}));
  EXPECT_EQ(file.functions.at("weigh").count, 12U);
  expect_figure(figures(sum).branches, 12, 12);
}

// A function that two tasks call has a copy for each, a task that begins with its loop is entered once, and a
// loop without end has no branch.
TEST(Coverage, CopiesOfAFunctionAreOne) {
  const Coverage coverage = coverage_of(
      "long n; long calls; long other;\n"
      "step()\n"                                          // 2
      "{\n"                                               // 3
      "  calls = calls + (n * 2 > calls * 3 ? 1 : 2);\n"  // 4
      "}\n"                                               // 5
      "second()\n"                                        // 6
      "{\n"                                               // 7
      "  while (1)\n"                                     // 8
      "  {\n"                                             // 9
      "    if (other++ < 3) step();\n"                    // 10
      "  }\n"                                             // 11
      "}\n"                                               // 12
      "main()\n"                                          // 13
      "{\n"                                               // 14
      "  _SetTask2(T2_START, second);\n"                  // 15
      "  step();\n"                                       // 16
      "  step();\n"                                       // 17
      "}\n",
      {"T2_START=1"});
  const SourceFile& file = coverage.files.at("S.IPC");
  EXPECT_EQ(file.functions.at("step").count, 5U);
  EXPECT_EQ(file.functions.at("second").count, 1U);
  EXPECT_EQ(file.lines.at(4), 5U);
  EXPECT_EQ(figures(file).functions.all, 3U);
  EXPECT_EQ(figures(file).branches.all, 4U);  // of lines 4 and 10
}

TEST(Coverage, TheRunIsTheSame) {
  for (const bool with : {false, true}) {
    static std::vector<int32_t> expected;
    const auto plant = plant_of({compiled(kSample, {"TURNS=200"})});
    std::optional<Collector> collector;
    if (with) collector.emplace(*plant);
    std::vector<int32_t> seen;
    plant->run_until(100 * runtime::kMillisecond, [&](runtime::Time) {
      const auto h = plant->stations()[0]->machine()->variables();
      seen.insert(seen.end(), h.begin(), h.end());
      return true;
    });
    if (with)
      EXPECT_EQ(seen, expected);
    else
      expected = seen;
  }
}

// _InputCall and _SystemCall call or do not; SC_UC always does, which is no branch.
TEST(Coverage, ConditionalCallsAreBranches) {
  const Coverage coverage = coverage_of(
      "long n;\n"
      "called()\n"                           // 2
      "{\n"                                  // 3
      "  n++;\n"                             // 4
      "}\n"                                  // 5
      "main()\n"                             // 6
      "{\n"                                  // 7
      "  _SystemCall(SC_UC, called);\n"      // 8
      "  _SystemCall(SC_N, called);\n"       // 9: the axis stands still
      "  _SystemCall(SC_TP1, called);\n"     // 10: no touch probe is enabled
      "  _InputCall(IC_HIGH, 1, called);\n"  // 11: DI00 is 0
      "}\n",
      {"SC_UC=0", "SC_N=1", "SC_TP1=4", "IC_HIGH=1"});
  const SourceFile& file = coverage.files.at("S.IPC");
  EXPECT_EQ(ways(file), (std::vector<std::array<uint64_t, 3>>{{9, 0, 1}, {10, 1, 0}, {11, 1, 0}}));
  EXPECT_EQ(file.functions.at("called").count, 2U);
}

// A program that was changed in the program memory is not that of the source.
TEST(Coverage, ChangedCodeIsNotCounted) {
  const auto plant = plant_of({compiled("main()\n{\n  while (1) H200 = H200 + 1;\n}\n", {})});
  const Collector collector(*plant);
  plant->run_until(10 * runtime::kMillisecond);
  const uint64_t before = collector.coverage().files.at("S.IPC").lines.at(3);
  EXPECT_GT(before, 0U);
  runtime::Station& station = *plant->stations()[0];
  const int32_t counted = station.variable(200);
  station.stop_program();
  station.drive().parameters().execute(runtime::ParameterService::WriteVolatile, 16001, 5);  // ADD H200 + 5
  EXPECT_EQ(station.start_program(), std::nullopt);
  plant->run_until(20 * runtime::kMillisecond);
  EXPECT_GT(station.variable(200), 2 * counted);
  EXPECT_EQ(collector.coverage().files.at("S.IPC").lines.at(3), before);
}

// Places are those of the line table: of an assignment the expression it computes.
TEST(CoverageForms, TextTellsWhatIsMissing) {
  const std::string text = text_of(write_text, coverage_of(kSample, {"TURNS=1"}));
  EXPECT_EQ(text,
            "coverage             lines          branches         functions\n"
            "S.IPC         13/15  86.7%       7/12  58.3%        2/2 100.0%\n"
            "\n"
            "S.IPC:\n"
            "  lines not executed: 25-26\n"
            "  6:16: never goes to 9:11, 1 time to 7:11\n"
            "  14:18: never goes to 16:5, 1 time to 29:1\n"
            "  22:13: never goes to 22:13, 1 time to 24:21\n"
            "  22:13: never tested\n");
}

TEST(CoverageForms, Lcov) {
  const std::string text = text_of(write_lcov, coverage_of(kSample, {"TURNS=1"}));
  EXPECT_TRUE(
      text.starts_with("TN:\nSF:S.IPC\nFN:14,main\nFN:6,weigh\nFNDA:1,main\nFNDA:3,weigh\nFNF:2\nFNH:2\n"
                       "BRDA:6,0,0,1\nBRDA:6,0,1,2\nBRDA:6,1,0,1\nBRDA:6,1,1,0\n"))
      << text;
  EXPECT_NE(text.find("BRDA:22,0,0,0\nBRDA:22,0,1,1\nBRDA:22,1,0,-\nBRDA:22,1,1,-\nBRF:12\nBRH:7\nDA:6,3\n"),
            std::string::npos)
      << text;
  EXPECT_TRUE(text.ends_with("DA:25,0\nDA:26,0\nDA:29,1\nLF:15\nLH:13\nend_of_record\n")) << text;
}

TEST(CoverageForms, Cobertura) {
  tinyxml2::XMLDocument document;
  ASSERT_EQ(document.Parse(text_of(write_cobertura, coverage_of(kSample, {"TURNS=1"})).c_str()),
            tinyxml2::XML_SUCCESS);
  const tinyxml2::XMLElement* root = document.RootElement();
  EXPECT_STREQ(root->Attribute("line-rate"), "0.8667");
  EXPECT_STREQ(root->Attribute("branch-rate"), "0.5833");
  EXPECT_EQ(root->IntAttribute("lines-valid"), 15);
  EXPECT_EQ(root->IntAttribute("branches-covered"), 7);
  const tinyxml2::XMLElement* file = root->FirstChildElement("packages")
                                         ->FirstChildElement("package")
                                         ->FirstChildElement("classes")
                                         ->FirstChildElement("class");
  EXPECT_STREQ(file->Attribute("filename"), "S.IPC");
  int lines = 0;
  for (const auto* line = file->FirstChildElement("lines")->FirstChildElement("line"); line != nullptr;
       line = line->NextSiblingElement("line")) {
    ++lines;
    if (line->IntAttribute("number") == 6) {
      EXPECT_EQ(line->IntAttribute("hits"), 3);
      EXPECT_STREQ(line->Attribute("condition-coverage"), "75% (3/4)");
    }
    if (line->IntAttribute("number") == 25) {
      EXPECT_EQ(line->IntAttribute("hits"), 0);
    }
  }
  EXPECT_EQ(lines, 15);
}

TEST(CoverageVerb, GenhtmlTakesTheTracefile) {
  if (std::system("command -v genhtml >/dev/null") != 0) GTEST_SKIP() << "there is no genhtml (package lcov)";
  const tests::TemporaryFolder folder;
  folder.write("S.IPC", kSample);
  const tests::CommandResult run = tests::run_ipos(
      {"run", "S.IPC", "-D", "TURNS=1", "--until", "end", "--coverage", "s.info"}, folder.path());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::string in = "cd " + folder.path().string() + " && ";
  ASSERT_EQ(std::system((in + "genhtml --branch-coverage -o html s.info >out.txt 2>err.txt").c_str()), 0)
      << tests::read_text(folder.path() / "err.txt");
  const std::string out = tests::read_text(folder.path() / "out.txt");
  EXPECT_EQ(tests::read_text(folder.path() / "err.txt"), "");
  EXPECT_NE(out.find("lines......: 86.7% (13 of 15 lines)"), std::string::npos) << out;
  EXPECT_NE(out.find("functions..: 100.0% (2 of 2 functions)"), std::string::npos) << out;
  EXPECT_NE(out.find("branches...: 58.3% (7 of 12 branches)"), std::string::npos) << out;
}

TEST(CoverageVerb, RunsOfAPlantAreTheSame) {
  const tests::TemporaryFolder folder;
  const std::string plant = tests::project("examples/scom/scom.toml").string();
  const std::string path = folder.path().string() + "/";
  const tests::CommandResult without = tests::run_ipos(
      {"run", plant, "--for", "300ms", "--watch", "--log", path + "a.log", "--trace", path + "a.csv"});
  const tests::CommandResult with =
      tests::run_ipos({"run", plant, "--for", "300ms", "--watch", "--log", path + "b.log", "--trace",
                       path + "b.csv", "--coverage", path + "b.info", "--coverage", path + "b.xml"});
  EXPECT_EQ(with.out, without.out);
  EXPECT_EQ(with.err, without.err);
  EXPECT_EQ(tests::read_text(folder.path() / "a.log"), tests::read_text(folder.path() / "b.log"));
  EXPECT_EQ(tests::read_text(folder.path() / "a.csv"), tests::read_text(folder.path() / "b.csv"));
  EXPECT_NE(tests::read_text(folder.path() / "b.info").find("SCOM2.IPC"), std::string::npos);
}

// Tests run on several threads, each with a plant of its own.
TEST(CoverageVerb, TestsAddUp) {
  const tests::TemporaryFolder folder;
  folder.write("A.IPC", "main()\n{\n  H0 = 1;\n}\n// expect H0 == 1\n");
  const tests::CommandResult run = tests::run_ipos(
      {"test", "A.IPC", "--repeat", "20", "--jobs", "4", "--coverage", "a.info", "--coverage", "-"},
      folder.path());
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.out.find("20 tests, 20 passed"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("2/2 100.0%"), std::string::npos) << run.out;
  const std::string info = tests::read_text(folder.path() / "a.info");
  EXPECT_NE(info.find("\nDA:3,20\n"), std::string::npos) << info;
  EXPECT_EQ(tests::run_ipos({"test", "A.IPC", "--tap", "-", "--coverage", "-"}, folder.path()).exit_code, 64);
}

TEST(CoverageVerb, Mistakes) {
  const tests::TemporaryFolder folder;
  const std::string file = folder.write("A.IPC", "main()\n{\n  H0 = 1;\n}\n");
  const tests::CommandResult html = tests::run_ipos({"run", file, "--coverage", "a.html"});
  EXPECT_EQ(html.exit_code, 64);
  EXPECT_NE(html.err.find("a.html: the name must end in .info, .xml or .txt, or be -"), std::string::npos);
  EXPECT_EQ(tests::run_ipos({"run", file, "--coverage", "/nowhere/a.info"}).exit_code, 74);
  EXPECT_EQ(tests::run_ipos({"run", file, "--coverage", "-", "--format", "json"}).exit_code, 64);
  const tests::CommandResult text = tests::run_ipos({"run", file, "--until", "end", "--coverage", "-"});
  EXPECT_EQ(text.exit_code, 0);
  EXPECT_NE(text.out.find("2/2 100.0%"), std::string::npos) << text.out;
  const std::string plant = folder.write("p.toml", "[[station]]\nname = \"u\"\nunit = \"mdxb\"\n");
  const tests::CommandResult none = tests::run_ipos({"run", plant, "--for", "1ms", "--coverage", "-"});
  EXPECT_EQ(none.exit_code, 65);
  EXPECT_NE(none.err.find("no station has a program"), std::string::npos) << none.err;
}

}  // namespace
}  // namespace ipos::tools::coverage
