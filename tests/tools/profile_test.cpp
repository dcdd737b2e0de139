// Profiles of programs whose calls and waits are known by hand; what is counted adds up to what the machine executed.
#include <gtest/gtest.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "compiler/compile.hpp"
#include "runtime/plant_file/plant_file.hpp"
#include "tools/profile/profiler.hpp"

namespace ipos::tools::profile {
namespace {

constexpr uint32_t kRate = 20;  // commands of each task in a millisecond

const std::string kSample =
    "long n, a;\n"               //  1
    "halve()\n"                  //  2
    "{\n"                        //  3
    "  a = a / 2;\n"             //  4
    "}\n"                        //  5
    "weigh()\n"                  //  6
    "{\n"                        //  7
    "  a = n * 3;\n"             //  8
    "  halve();\n"               //  9
    "  halve();\n"               // 10
    "}\n"                        // 11
    "main()\n"                   // 12
    "{\n"                        // 13
    "  for (n = 0; n < 7; n++)\n"  // 14
    "    weigh();\n"             // 15
    "  _Wait(100);\n"            // 16
    "  halve();\n"               // 17
    "  while (1) ;\n"            // 18
    "}\n";

struct Profiled {
  std::unique_ptr<runtime::Plant> plant;
  std::unique_ptr<Profiler> profiler;

  const vm::TaskContext& task(int number) const { return plant->stations().front()->machine()->task(number); }
};

Profiled run_of(const std::string& text, runtime::Time time) {
  compiler::CompileOptions options;
  options.unit = stdlib::find_unit("mdxb");
  const compiler::Compilation made = compiler::compile("S.IPC", "", text, options);
  EXPECT_TRUE(made.image.has_value());
  std::vector<runtime::PlantError> errors;
  Profiled run;
  runtime::Execution execution;
  execution.pace = runtime::Pace::InTurn;
  run.plant = std::make_unique<runtime::Plant>(
      runtime::read_plant_file("[[station]]\nname = \"u\"\nunit = \"mdxb\"\nprogram = \"S.IPC\"\n").plant,
      std::vector<std::optional<vm::Image>>{made.image}, vm::Rates{{kRate, kRate, kRate}}, errors, execution);
  EXPECT_TRUE(errors.empty());
  run.profiler = std::make_unique<Profiler>(*run.plant);
  run.plant->run_until(time);
  return run;
}

const Row& row_of(const std::vector<Row>& all, uint32_t line, const std::string& function) {
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const Row& row) { return row.line.line == line && row.function == function; });
  EXPECT_NE(found, all.end()) << line << " of " << function;
  return found == all.end() ? all.front() : *found;
}

TEST(Profile, CountsCallsAndWaits) {
  const Profiled run = run_of(kSample, 500 * runtime::kMillisecond);
  const std::vector<Row> all = rows(run.profiler->tasks());
  EXPECT_EQ(row_of(all, 8, "weigh").calls, 7U);
  EXPECT_EQ(row_of(all, 4, "halve").calls, 15U);  // twice in each weigh, once in main
  EXPECT_EQ(row_of(all, 18, "main").calls, 1U);
  EXPECT_EQ(row_of(all, 4, "halve").cost.commands % 15, 0U);
  EXPECT_EQ(row_of(all, 18, "main").line.text(), all.front().line.text());  // the most expensive stands first
  // WAIT lasts 100 ticks after the millisecond of its command.
  EXPECT_NEAR(row_of(all, 16, "main").cost.waits, 100, 1);
}

TEST(Profile, AddsUpToWhatTheMachineExecuted) {
  const Profiled run = run_of(kSample, 500 * runtime::kMillisecond);
  Cost sum;
  for (const Row& row : rows(run.profiler->tasks())) sum += row.cost;
  EXPECT_EQ(sum.commands, run.task(1).commands);
  EXPECT_NEAR(sum.ms, static_cast<double>(sum.commands) / kRate, 1e-6);
  EXPECT_NEAR(sum.ms + sum.waits, 500, 1.5);  // each millisecond is worked or waited
}

// main calls weigh 7 times, which calls halve; and halve itself.
TEST(Profile, KeepsTheWaysOfCalls) {
  const Profiled run = run_of(kSample, 300 * runtime::kMillisecond);
  std::map<std::string, uint64_t> ways;
  for (const Task& task : run.profiler->tasks())
    for (const Node& node : task.nodes) {
      std::string way = node.function;
      for (size_t up = node.parent; up != SIZE_MAX; up = task.nodes[up].parent) way = task.nodes[up].function + " " + way;
      ways[way] += node.calls;
    }
  EXPECT_EQ(ways, (std::map<std::string, uint64_t>{{"main", 1}, {"main halve", 1}, {"main weigh", 7}, {"main weigh halve", 14}}));
}

// https://www.speedscope.app/file-format-schema.json: frames by number, a weight a sample.
TEST(Profile, IsASpeedscopeFile) {
  const Profiled run = run_of(kSample, 300 * runtime::kMillisecond);
  const std::vector<Task> tasks = run.profiler->tasks();
  const auto file = nlohmann::json::parse(speedscope(tasks, "S"));
  const auto& frames = file.at("shared").at("frames");
  ASSERT_EQ(file.at("profiles").size(), 1U);
  const auto& profile = file.at("profiles").front();
  EXPECT_EQ(profile.at("type"), "sampled");
  EXPECT_EQ(profile.at("unit"), "milliseconds");
  EXPECT_EQ(profile.at("name"), "u.task1");
  ASSERT_EQ(profile.at("samples").size(), profile.at("weights").size());
  double sum = 0;
  std::set<std::string> deepest;
  for (size_t n = 0; n < profile.at("samples").size(); ++n) {
    sum += profile.at("weights")[n].get<double>();
    std::string way;
    for (const auto& frame : profile.at("samples")[n]) way += frames.at(frame.get<size_t>()).at("name").get<std::string>() + " ";
    deepest.insert(way);
  }
  Cost all;
  for (const Row& row : rows(tasks)) all += row.cost;
  EXPECT_NEAR(sum, all.ms + all.waits, 1e-6);
  EXPECT_DOUBLE_EQ(profile.at("endValue").get<double>(), sum);
  EXPECT_TRUE(deepest.contains("main weigh halve S.IPC:4 "));
  EXPECT_TRUE(deepest.contains("main S.IPC:16 waits "));
}

// An interrupt routine uses the commands of task 1 and is called once a timer's period.
TEST(Profile, InterruptRoutinesStandInTask1) {
  const Profiled run = run_of(
      "#include <const.h>\n"
      "long seen;\n"
      "tick()\n"
      "{\n"
      "  seen++;\n"
      "}\n"
      "main()\n"
      "{\n"
      "  _SetInterrupt(SI_TIMER0, tick);\n"
      "  T0_Reload = 10;\n"
      "  Timer_0 = 10;\n"
      "  while (1) ;\n"
      "}\n",
      205 * runtime::kMillisecond);
  const std::vector<Row> all = rows(run.profiler->tasks());
  const Row& row = row_of(all, 5, "tick");
  EXPECT_EQ(row.task, "u.task1");
  const auto& symbols = run.plant->stations().front()->symbols();
  const auto seen = std::find_if(symbols.begin(), symbols.end(), [](const auto& symbol) { return symbol.name == "seen"; });
  ASSERT_NE(seen, symbols.end());
  EXPECT_EQ(row.calls, static_cast<uint64_t>(run.plant->stations().front()->machine()->variables()[seen->variable]));
  EXPECT_GT(row.calls, 10U);
}

}  // namespace
}  // namespace ipos::tools::profile
