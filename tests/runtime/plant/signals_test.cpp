// Signals by name: what each stands for is compared with where the value comes from, and their list with what
// can be found.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <set>

#include "plant_rig.hpp"
#include "runtime/plant_file/state_names.hpp"
#include "runtime/signals/find.hpp"
#include "stdlib/parameters.hpp"

namespace ipos::runtime {
namespace {

constexpr const char* kProgram =
    "long lCount;\n"
    "typedef struct { long a; long b[2]; } S;\n"
    "S T;\n"
    "main()\n"
    "{\n"
    "  lCount = 10;\n"
    "  T.b[1] = 7;\n"
    "  while (1) { _Wait(1000); }\n"  // line 8
    "}\n";

class Signals : public ::testing::Test {
 protected:
  void SetUp() override {
    plant_ = tests::make_plant(
        "[[bus]]\nname = \"sbus\"\nkind = \"can\"\nbaud = 500000\n"
        "[[station]]\nname = \"u\"\nunit = \"mdxb\"\nprogram = \"P.IPC\"\nsbus = \"sbus\"\n"
        "[station.parameters]\nP130 = \"2.5 s\"\nP871 = 1\n"
        "[station.inputs]\nDI03 = 1\n[station.analog]\nAI1 = \"5 V\"\n"
        "[[station]]\nname = \"v.w\"\nunit = \"mc07\"\n",
        {{"P.IPC", kProgram}});
    ASSERT_NE(plant_, nullptr);
    plant_->run_until(20 * kMillisecond);
  }
  std::vector<std::string> names(std::string_view pattern) {
    std::vector<std::string> all;
    const auto found = signals::find_signals(*plant_, pattern);
    EXPECT_TRUE(found) << (found ? "" : found.error());
    if (found)
      for (const signals::Signal& signal : *found) all.push_back(signal.name);
    return all;
  }
  signals::Signal one(std::string_view name) {
    auto found = signals::find_signals(*plant_, name);
    EXPECT_TRUE(found && found->size() == 1) << name << (found ? "" : ": " + found.error());
    return found && !found->empty() ? found->front() : signals::Signal{};
  }
  std::string shown(std::string_view name) {
    const signals::Signal signal = one(name);
    return signal.read ? signal.text(signal.read()) + (signal.unit.empty() ? "" : " " + signal.unit) : "";
  }
  Station& station(size_t n) { return *plant_->stations()[n]; }

  std::unique_ptr<Plant> plant_;
};

TEST_F(Signals, EveryKindIsReadWhereItStands) {
  EXPECT_EQ(shown("u.P130"), "2.500 s");
  EXPECT_EQ(shown("u.DI03"), "1");
  EXPECT_EQ(shown("u.DI04"), "0");
  EXPECT_EQ(shown("u.AI1"), "5.000 V");
  EXPECT_EQ(shown("u.lCount"), "10");
  EXPECT_EQ(shown("u.T.b[1]"), "7");
  EXPECT_EQ(shown("u.task1.line"), "8");
  EXPECT_EQ(shown("u.task1.state"), "2") << "it waits";
  EXPECT_EQ(shown("u.task2.line"), "0");
  EXPECT_EQ(shown("u.powered"), "1");
  EXPECT_EQ(shown("u.status"), std::to_string(station(0).status_word_1()));
  EXPECT_EQ(shown("sbus.load"), "0 %");
  EXPECT_EQ(shown("sbus.count"), "0");
}

TEST_F(Signals, ProcessWordsAreWordsBitsAndNumbers) {
  // SPEED, 0.2 rpm a digit: FFFBh is -5 x 0.2 rpm.
  station(0).drive().state().take_po(PoSource::Sbus, std::vector<uint16_t>{0x0406, 0xFFFB, 7});
  EXPECT_EQ(shown("u.PO1"), "1030");
  EXPECT_EQ(shown("u.PO1.1"), "1");
  EXPECT_EQ(shown("u.PO1.0"), "0");
  EXPECT_EQ(shown("u.PO1.10"), "1");
  EXPECT_EQ(shown("u.PO2_value"), "-1.0 rpm");
  EXPECT_EQ(one("u.PO1.10").bits, 1U);
  EXPECT_FALSE(signals::find_signals(*plant_, "u.PO1.16"));
  EXPECT_FALSE(signals::find_signals(*plant_, "u.speed.0")) << "no bit field";
  EXPECT_EQ(shown("u.lCount.1"), "1");
  EXPECT_EQ(shown("u.lCount.2"), "0");
}

TEST_F(Signals, NamesThatStandForSeveral) {
  EXPECT_EQ(names("u.T"), (std::vector<std::string>{"u.T.a", "u.T.b[0]", "u.T.b[1]"}));
  EXPECT_EQ(names("u.DI0?").size(), 8U);
  EXPECT_EQ(names("u.D*").size(), 16U + 14U + 0U) << "8 + 8 inputs; DB00, DO01 to DO05, DO10 to DO17";
  EXPECT_EQ(names("*.fault"), (std::vector<std::string>{"u.fault", "v.w.fault"}));
  EXPECT_EQ(names("v.w.DO0*").size(), 5U);
  EXPECT_EQ(names("u.PI1.*").size(), 16U);
  std::vector<std::string> ramps;
  for (const stdlib::Parameter& row : stdlib::parameter_table(*station(0).config().unit).rows())
    if (row.number.size() == 3 && row.number.starts_with("13"))
      ramps.push_back(fmt::format("u.P{}", row.number));
  EXPECT_EQ(names("u.P13?"), ramps);
  EXPECT_EQ(names("u.H50?").size(), 10U);
  EXPECT_EQ(names("*.load"), (std::vector<std::string>{"sbus.load"}));
}

// A letter and a pattern behind it may mean all parameters, or all variables.
TEST_F(Signals, PatternsOfParametersAndVariables) {
  const auto numbered = [&](std::string_view pattern, char letter) {
    size_t count = 0;
    const auto found = signals::find_signals(*plant_, pattern);
    if (found)
      for (const signals::Signal& signal : *found)
        count += signal.name.size() > 3 && signal.name[2] == letter && signal.name[3] >= '0' &&
                 signal.name[3] <= '9';
    return count;
  };
  const stdlib::UnitType& unit = *station(0).config().unit;
  std::set<std::string_view> parameters;  // P852 has two rows
  size_t hundreds = 0;
  for (const stdlib::Parameter& row : stdlib::parameter_table(unit).rows()) {
    if (row.index == 0 || row.number.empty()) continue;
    parameters.insert(row.number);
    hundreds += row.number.size() == 3 && row.number[0] == '1' ? 1 : 0;
  }
  EXPECT_EQ(numbered("u.P*", 'P'), parameters.size());
  EXPECT_EQ(numbered("u.P1??", 'P'), hundreds);
  EXPECT_EQ(numbered("u.P", 'P'), 0U);
  EXPECT_EQ(numbered("u.Px*", 'P'), 0U);
  EXPECT_EQ(numbered("u.H*", 'H'), unit.variables);
  EXPECT_EQ(numbered("u.H?", 'H'), 10U);
  EXPECT_EQ(numbered("u.H1???", 'H'), 24U);
  EXPECT_EQ(numbered("u.Hx*", 'H'), 0U);
  EXPECT_EQ(names("v.w.H*").size(), 512U) << "of the unit, with and without a program";
  EXPECT_EQ(shown("u.130"), "2.500 s") << "a parameter by its number alone";
}

TEST_F(Signals, WhatAStationHasIsTold) {
  const auto found = signals::find_signals(*plant_, "u.sped");
  ASSERT_FALSE(found);
  EXPECT_EQ(
      found.error(),
      "station 'u' has no signal 'sped'; it has speed, frequency, position, current, active_current, "
      "motor_utilization, dc_link, temperature, setpoint, shaft_speed, shaft_angle, load_torque, torque, AO1, "
      "AO1_current, AO2, AO2_current, position_setpoint, "
      "position_target, lag, status, fault, parameters as P000, inputs as DI00 and AI1, outputs as DO01, "
      "process data as PO1 and PI1, bits as PO1.6, states as " +
          state_names() +
          ", tasks as task1.line, variables H0 to H1023, lCount, T.a, T.b; the buses have sbus.load, "
          "sbus.count");
  const auto other = signals::find_signals(*plant_, "v.w.sped");
  ASSERT_FALSE(other);
  EXPECT_NE(other.error().find("states as " + state_names() + ", variables H0 to H511; the buses have"),
            std::string::npos)
      << other.error();
  EXPECT_EQ(other.error().find("position_setpoint"), std::string::npos) << "no unit that positions";
}

TEST_F(Signals, WhatIsListedIsFound) {
  std::set<std::string> seen;
  for (const signals::Signal& signal : signals::plant_signals(*plant_)) {
    EXPECT_TRUE(seen.insert(signal.name).second) << signal.name << " stands twice";
    const signals::Signal found = one(signal.name);
    EXPECT_EQ(found.meaning, signal.meaning) << signal.name;
    EXPECT_EQ(found.read(), signal.read()) << signal.name;
    EXPECT_TRUE(signal.name.starts_with(signal.station + "."));
    EXPECT_FALSE(signal.meaning.empty() && signal.group != signals::Group::ProcessData) << signal.name;
  }
}

TEST_F(Signals, WhatIsNotThereIsTold) {
  const auto error = [&](std::string_view name) {
    const auto found = signals::find_signals(*plant_, name);
    return found ? "found" : found.error();
  };
  EXPECT_TRUE(error("u.sped").starts_with("station 'u' has no signal 'sped'; it has speed, frequency"));
  EXPECT_EQ(error("x.*"), "no signal is called like 'x.*'");
  EXPECT_TRUE(error("speed").starts_with("'speed' is no signal; signals begin with u., v.w."));
  EXPECT_FALSE(signals::find_signals(*plant_, "u.H1024"));
  EXPECT_FALSE(signals::find_signals(*plant_, "v.w.lCount"));
  EXPECT_FALSE(signals::find_signals(*plant_, ""));
  EXPECT_FALSE(signals::find_signals(*plant_, "u."));
}

TEST(SignalPatterns, StarsTakeAsMuchAsTheyMust) {
  EXPECT_TRUE(signals::matches("*", ""));
  EXPECT_TRUE(signals::matches("a*b*c", "axxbyybc"));
  EXPECT_FALSE(signals::matches("a*b*c", "axxbyyb"));
  EXPECT_TRUE(signals::matches("?a", "ba"));
  EXPECT_FALSE(signals::matches("?a", "a"));
  EXPECT_TRUE(signals::matches("y[0].*", "y[0].b[1]"));
  EXPECT_FALSE(signals::matches("", "a"));
}

TEST(SignalExpectations, AnySignalCanBeExpected) {
  const auto plant = tests::make_plant(
      "[[station]]\nname = \"u\"\nunit = \"mdxb\"\n[station.analog]\nAI1 = \"5 V\"\n"
      "[[expect]]\nstation = \"u\"\nat = \"10ms\"\nsignal = \"AI1\"\nequals = 5\n"
      "[[expect]]\nstation = \"u\"\nat = \"10ms\"\nsignal = \"PO1.3\"\nequals = 1\n");
  ASSERT_NE(plant, nullptr);
  plant->run_until(20 * kMillisecond);
  ASSERT_EQ(plant->results().size(), 2U);
  EXPECT_TRUE(plant->results()[0].met);
  EXPECT_FALSE(plant->results()[1].met);
}

}  // namespace
}  // namespace ipos::runtime
