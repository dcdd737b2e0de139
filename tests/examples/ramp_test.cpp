// examples/ramp: the times of a run-up, a reversal, a stop and a rapid stop against their closed form,
// millisecond by millisecond, and the plot of docs/inside/drive.md.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

using Columns = std::map<std::string, std::vector<double>>;  // by name without unit; a value each millisecond

Columns read_trace(const std::string& csv) {
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  std::vector<std::string> names;
  std::istringstream header(line);
  for (std::string name; std::getline(header, name, ',');) names.push_back(name.substr(0, name.find(' ')));
  Columns columns;
  for (const std::string& name : names) columns[name].push_back(0);  // at 0 ms
  while (std::getline(lines, line)) {
    std::istringstream row(line);
    size_t column = 0;
    for (std::string cell; std::getline(row, cell, ','); ++column)
      columns[names[column]].push_back(std::stod(cell));
  }
  return columns;
}

// From `start` to `end` rpm, when `time_ms` is the time for `reference` rpm. Before it `delay_ms` of
// premagnetization.
struct Ramp {
  double start, end, reference, time_ms, delay_ms = 0;

  double duration() const { return std::abs(end - start) * time_ms / reference; }
  double at(double ms) const {
    return start + (end - start) * std::clamp((ms - delay_ms) / duration(), 0.0, 1.0);
  }
};

class RampExample : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    const TemporaryFolder folder;
    const std::string csv = (folder.path() / "ramp.csv").string();
    const CommandResult run = run_ipos(
        {"run", project("examples/ramp/ramp.toml").string(), "--for", "16s", "--trace", csv, "--signals",
         "movidrive.speed,movidrive.P094,movidrive.P095,movitrac.speed,movitrac.P094,movitrac.P095"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    trace_ = read_trace(read_text(csv));
  }

  // An order is a change of the process data words in P094 and P095; the drive acts on it in the next
  // millisecond.
  static void follows(const std::string& station, const std::vector<Ramp>& ramps) {
    const std::vector<double>& speed = trace_[station + ".speed"];
    const std::vector<double>& word = trace_[station + ".P094"];
    const std::vector<double>& wanted = trace_[station + ".P095"];
    ASSERT_GE(speed.size(), 16'000U);
    std::vector<size_t> orders;
    for (size_t ms = 1; ms < speed.size(); ++ms)
      if (word[ms] != word[ms - 1] || wanted[ms] != wanted[ms - 1]) orders.push_back(ms);
    ASSERT_EQ(orders.size(), ramps.size());
    orders.push_back(speed.size());
    int checked = 0;
    for (size_t n = 0; n < ramps.size(); ++n) {
      const Ramp& ramp = ramps[n];
      for (size_t ms = orders[n]; ms < orders[n + 1]; ++ms, ++checked)
        ASSERT_NEAR(speed[ms], ramp.at(static_cast<double>(ms - orders[n])), 0.002)
            << station << " at " << ms << " ms";
      size_t reached = orders[n];
      while (std::abs(speed[reached] - ramp.end) > 0.002) ++reached;
      EXPECT_EQ(static_cast<double>(reached - orders[n]), ramp.delay_ms + ramp.duration()) << station;
    }
    std::printf("%s: %d milliseconds on the closed form\n", station.c_str(), checked);
  }

  static inline Columns trace_;
};

TEST_F(RampExample, MovidriveRefersTo3000Rpm) {
  follows("movidrive", {{0, 1500, 3000, 2000},      // 1 s
                        {1500, -1500, 3000, 2000},  // 2 s
                        {-1500, 0, 3000, 2000},     // 1 s
                        {0, 1500, 3000, 2000},      // 1 s
                        {1500, 0, 3000, 500}});     // rapid stop: 0.25 s
}

// Without P323 it magnetizes for 100 ms (ours).
TEST_F(RampExample, Movitrac07RefersTo1500Rpm) {
  follows("movitrac", {{0, 1500, 1500, 2000, 100},  // 2 s
                       {1500, -1500, 1500, 2000},   // 4 s
                       {-1500, 0, 1500, 2000},      // 2 s
                       {0, 1500, 1500, 2000, 100},  // 2 s
                       {1500, 0, 1500, 500}});      // rapid stop: 0.5 s
}

TEST(DrivePlots, AreMadeByIpos) {
  const TemporaryFolder folder;
  const auto is_drawn = [&](const std::string& name, const std::string& time, const std::string& signals) {
    const std::string made = (folder.path() / (name + ".svg")).string();
    const CommandResult run = run_ipos({"run", project("examples/" + name + "/" + name + ".toml").string(),
                                        "--for", time, "--plot", made, "--signals", signals});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_TRUE(read_text(made) == read_text(project("docs/images/" + name + ".svg")))
        << name << ".svg is not what the command in docs/inside/drive.md draws";
    const std::string page = read_text(project("docs/inside/drive.md"));
    EXPECT_NE(page.find("](../images/" + name + ".svg)"), std::string::npos);
    EXPECT_NE(page.find("--for " + time + " --plot " + name + ".svg --signals " + signals),
              std::string::npos);
  };
  is_drawn("ramp", "16s", "movidrive.speed,movidrive.status,movitrac.speed,movitrac.status");
  is_drawn("winder", "9s", "line.speed,takeup.speed,takeup.torque");
  is_drawn("fan", "13s", "fan.setpoint,fan.speed,fan.current");
}

}  // namespace
}  // namespace ipos::tests
