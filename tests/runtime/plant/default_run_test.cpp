// The run that people start, in which nobody looks on but at some moments: no hash, no trace, no report. On every engine it is
// what a run is that executes each millisecond in its turn (--no-skip), and it comes to its end. Without IPOS_PLANTS there
// are 300 random plants; ./dev check tries 5000.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "tests/runtime/plant/bounded.hpp"
#include "tests/runtime/plant/machine_code.hpp"
#include "tests/runtime/plant/picture.hpp"
#include "tests/runtime/plant/plant_rig.hpp"
#include "tests/runtime/plant/reading_plant.hpp"

namespace ipos::tests {
namespace {

namespace fs = std::filesystem;
using runtime::Plant;
using runtime::Time;

// A plant file with its programs, for run after run.
struct Project {
  std::string text;
  std::map<std::string, vm::Image> programs;
};

Project project_of(const std::string& text, const std::map<std::string, std::string>& sources) {
  Project project{text, {}};
  for (const runtime::StationConfig& station : runtime::read_plant_file(text).plant.stations)
    if (!station.program.empty())
      if (auto image = made(station, sources.at(station.program)))
        project.programs[station.program] = std::move(*image);
  return project;
}

struct Engine {
  const char* name;
  bool fast, native;
};
constexpr Engine kEngines[] = {{"native", true, true}, {"fast", true, false}, {"reference", false, false}};

std::unique_ptr<Plant> run_of(const Project& project, const Engine& engine, runtime::Pace pace) {
  runtime::Execution execution;
  execution.pace = pace;
  execution.fast = engine.fast;
  if (engine.native) execution.compiler = machine_code;
  return make_plant<vm::Image>(project.text, project.programs, std::nullopt, execution);
}

// The first line in which two different pictures differ, and the words in it.
std::string difference(const std::string& expected, const std::string& actual) {
  std::istringstream wanted(expected), had(actual);
  std::string wanted_line, had_line;
  for (int line = 1;; ++line) {
    const bool more = static_cast<bool>(std::getline(wanted, wanted_line));
    if (!std::getline(had, had_line))
      return more ? fmt::format("no line {}: {}", line, wanted_line) : "equal";
    if (!more) return fmt::format("one line more, {}: {}", line, had_line);
    if (wanted_line == had_line) continue;
    std::istringstream left(wanted_line), right(had_line);
    std::string a, b, out = fmt::format("line {}", line);
    for (int word = 0; a.clear(), b.clear(), left >> a, right >> b, !a.empty() || !b.empty(); ++word)
      if (a != b)
        out += fmt::format(", word {}: {}, not {}", word, b.empty() ? "none" : b, a.empty() ? "none" : a);
    return out;
  }
}

// Nothing, or how a default run differs from one in turn. One of two runs with the usual engine is looked at only once, at its
// end, the others at some of the moments as well.
std::string complaint(const Project& project, uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto below = [&](Time most) { return static_cast<Time>(random() % static_cast<uint64_t>(most)); };
  std::vector<Time> moments{ms(3000) + below(ms(700))};
  for (int n = 0; n < 12; ++n) moments.push_back(n % 3 == 0 ? ms(below(3000)) : below(ms(3000)));
  std::sort(moments.begin(), moments.end());
  std::vector<std::string> pictures;
  const auto in_turn = run_of(project, {"reference", false, false}, runtime::Pace::InTurn);
  if (!in_turn) return "the plant is refused";
  for (const Time moment : moments) {
    in_turn->run_until(moment);
    pictures.push_back(picture(*in_turn));
  }
  for (int run = 0; run < 4; ++run) {
    const Engine& engine = kEngines[run % 3];
    const auto plant = run_of(project, engine, runtime::Pace::Lazy);
    for (size_t n = 0; n < moments.size(); ++n) {
      if (n + 1 < moments.size() && (run == 0 || random() % 3 != 0)) continue;
      plant->run_until(moments[n]);
      if (const std::string now = picture(*plant); now != pictures[n])
        return fmt::format("{}, at {} ns: {}", engine.name, moments[n], difference(pictures[n], now));
    }
  }
  return "";
}

TEST(DefaultRun, WhatReadsIsTheSameAsInTurn) {
  for (uint64_t seed = first_plant(); seed <= plant_count(300); ++seed) {
    const ReadingPlant random(seed);
    const Project project = project_of(random.text(), random.sources());
    const std::string wrong = bounded([&] { return complaint(project, seed); });
    if (wrong.empty()) continue;
    std::string sources;
    for (const auto& [name, text] : random.sources()) sources += fmt::format("--- {}{}", name, text);
    FAIL() << "seed " << seed << ": " << wrong << '\n' << random.text() << sources;
  }
}

// The plainest programs with a telegram: each loop that has no wait, and values that come in every rhythm. A program that
// runs ahead becomes one that is idle between two telegrams, and the other way round, again and again.
TEST(DefaultRun, WhatReceivesIsTheSameAsInTurn) {
  for (const char* const circle : kCircles)
    for (const int wait : {0, 1, 2, 3, 5, 7, 11, 13, 20, 33})
      for (const int cycle : {3, 5, 10}) {
        const auto unit = [](const char* name, const char* type, const char* address) {
          return fmt::format(
              "[[station]]\nname = \"{0}\"\nunit = \"{1}\"\nprogram = \"{0}.IPC\"\nsbus = \"can\"\n"
              "[station.parameters]\n{2}\n",
              name, type, address);
        };
        std::string loop = circle;
        replace_word(loop, "V", "r1");
        const bool forwards = loop.starts_with("t1");
        const auto program = [&](bool sends, int sent, int received, const std::string& body) {
          return fmt::format(
              "{}main() {{ Tr.ObjectNo = {}; Tr.CycleTime = {}; Tr.Format = 8; Tr.DPointer = numof(t1);\n"
              "Re.ObjectNo = {}; Re.Format = 8; Re.DPointer = numof(r1);\n"
              "{} _SBusCommDef(SCD_REC, Re); _SBusCommOn(); while (1) {{ {} }} }}\n",
              kReadingHead, sent, cycle, received, sends ? "_SBusCommDef(SCD_TRCYCL, Tr);" : "", body);
        };
        const bool b = (wait + cycle) % 2 == 0;
        const Project project = project_of(
            "[[bus]]\nname = \"can\"\nkind = \"can\"\nbaud = 500000\n" + unit("S", "md60a", "P813 = 1") +
                unit("R", b ? "mdxb" : "md60a", b ? "P881 = 2" : "P813 = 2"),
            {{"S.IPC", program(true, 1100, 1101,
                               wait == 0 ? "t1 = t1 + 1;" : fmt::format("t1 = t1 + 1; _Wait({});", wait))},
             {"R.IPC", program(forwards, 1101, 1100, loop)}});
        ASSERT_EQ(bounded([&] { return complaint(project, static_cast<uint64_t>(wait * 100 + cycle)); }), "")
            << loop << " with a wait of " << wait << " and a cycle of " << cycle;
      }
}

std::string read_text(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

// What `ipos new` makes: its template, and each of the examples.
TEST(DefaultRun, EveryTemplateIsTheSameAsInTurn) {
  std::vector<fs::path> plants;
  for (const char* folder : {"tools/new/template", "examples"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(IPOS_SOURCE_DIR) / folder))
      if (entry.path().extension() == ".toml" && entry.path().stem().extension().empty())
        plants.push_back(entry.path());
  EXPECT_GE(plants.size(), 20U);
  std::sort(plants.begin(), plants.end());
  for (const fs::path& plant : plants) {
    std::map<std::string, std::string> sources;
    for (const auto& entry : fs::directory_iterator(plant.parent_path()))
      if (entry.path().extension() == ".IPC")
        sources[entry.path().filename().string()] = read_text(entry.path());
    const Project project = project_of(read_text(plant), sources);
    for (uint64_t seed = 1; seed <= 3; ++seed)
      EXPECT_EQ(bounded([&] { return complaint(project, seed); }), "") << plant << ' ' << seed;
  }
}

// Each mode of VARINT from one value to another one, while its task runs, while it does not, and when it has come to run.
TEST(DefaultRun, EventsOfAStoppedTaskAreLost) {
  struct Row {
    int mode, compare, from, to;
  };
  for (const Row& row :
       {Row{0, 1, 0, 1}, Row{1, 1, 0, 1}, Row{2, 1, 0, 1}, Row{3, 1, 1, 0}, Row{4, 5, 0, 5}, Row{5, 0, 0, 5},
        Row{6, 5, 0, 5}, Row{7, -5, 0, -5}, Row{8, 1, 0, 1}, Row{9, 1, 1, 0}})
    for (const bool starts_first : {true, false}) {
      const std::string start = "_SetTask2(T2_START, t2); _Wait(50);";
      const std::string source = fmt::format(
          "#include <constb.h>\nVARINT v; long src, hit, hits;\nt2() {{ while (1) H1++; }}\nisr() {{ hit++; "
          "}}\n"
          "main() {{ src = {2}; v.Control = 1; v.IntNum = 0; v.SrcVar = numof(src); v.CompareVar = {1}; "
          "v.Mode = {0};\n"
          "v.Priority = 1; {4} _SetVarInterrupt(v, isr); _Wait(50); src = {3}; _Wait(50); {5}\n"
          "hits = hit; src = {2}; _Wait(50); src = {3}; _Wait(50); }}",
          row.mode, row.compare, row.from, row.to, starts_first ? start : "", starts_first ? "" : start);
      const Project project = project_of("[[station]]\nname = \"u\"\nunit = \"mdxb\"\nprogram = \"P.IPC\"\n",
                                         {{"P.IPC", source}});
      for (const Engine& engine : kEngines)
        for (const runtime::Pace pace : {runtime::Pace::InTurn, runtime::Pace::Lazy}) {
          const auto plant = run_of(project, engine, pace);
          plant->run_until(ms(500));
          const int each = row.mode == 0 ? 0 : 1,
                    back = row.mode == 1 ? 1 : 0;  // the way back is a change, too
          EXPECT_EQ(value(*plant, "hits"), starts_first ? each : 0) << row.mode << ' ' << engine.name;
          EXPECT_EQ(value(*plant, "hit"), value(*plant, "hits") + each + back)
              << row.mode << ' ' << engine.name;
        }
    }
}

// What is told of two pictures is where they differ, also where one ends before the other.
TEST(DefaultRun, ADifferenceIsToldByItsPlace) {
  EXPECT_EQ(difference("a b\nc d\n", "a b\nc e\n"), "line 2, word 1: e, not d");
  EXPECT_EQ(difference("a b\n", "a\n"), "line 1, word 1: none, not b");
  EXPECT_EQ(difference("a\n", "a b\n"), "line 1, word 1: b, not none");
  EXPECT_EQ(difference("a\nb\n", "a\n"), "no line 2: b");
  EXPECT_EQ(difference("a\n", "a\nb\n"), "one line more, 2: b");
  EXPECT_EQ(difference("a\nb\n", "a\nb\n"), "equal");
}

#ifndef _WIN32  // see bounded.hpp
// A hang is told.
TEST(DefaultRun, WhatDoesNotEndIsAComplaint) {
  EXPECT_EQ(bounded([] { return std::string("wrong"); }), "wrong");
  EXPECT_EQ(bounded([]() -> std::string {
              raise(SIGXCPU);
              return "";
            }),
            "it does not come to an end");
  EXPECT_EQ(bounded([]() -> std::string { _exit(3); }), "it ends with 3");
}
#endif

}  // namespace
}  // namespace ipos::tests
