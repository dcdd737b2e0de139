// A drive without IPOS program: its H variables live, as those of a drive whose program does nothing. A master that
// knows indices only moves an axis with them.
#include <gtest/gtest.h>

#include "plant_rig.hpp"
#include "runtime/signals/find.hpp"
#include "runtime/signals/variables.hpp"
#include "stdlib/system_variables.hpp"

namespace ipos::tests {
namespace {

using namespace runtime;  // NOLINT

constexpr uint16_t kFirst = 11'000;  // index of H0 (1053 1610 p. 67)

struct Action {
  int64_t ms;
  uint16_t index;
  int32_t value;
};

// The same drive twice: "bare" has no program, "idle" one that waits.
std::unique_ptr<Plant> twins(const std::string& unit, const std::string& parameters, const Execution& execution = {}) {
  const auto station = [&](const std::string& name, const std::string& more) {
    return "[[station]]\nname = \"" + name + "\"\nunit = \"" + unit + "\"\n" + more + "[station.parameters]\n" +
           parameters + "[station.inputs]\nDI00 = 1\nDI01 = 1\nDI03 = 1\n";
  };
  return make_plant(station("bare", "") + station("idle", "program = \"P.IPC\"\n"),
                    {{"P.IPC", "main() { while (1) _Wait(1000); }\n"}}, std::nullopt, execution);
}

struct Case {
  const char* unit;
  std::string parameters;
  std::vector<Action> actions;
};

std::vector<Case> cases() {
  const std::vector<Action> words = {
      {30, kFirst + 5, 55},         {40, kFirst + 200, -7},      {50, kFirst + 488, 300},   {60, kFirst + 487, 20},
      {61, kFirst + 486, 15},       {200, kFirst + 480, 0b110},  {300, kFirst + 484, 1 << 30}, {450, kFirst + 484, 0},
      {500, kFirst + 480, 0b100},   {520, kFirst + 481, 0xFF},   {600, kFirst + 473, -1},   {610, kFirst + 511, 77},
  };
  std::vector<Action> travel = words;
  const Action more[] = {{700, kFirst + 492, 40'960}, {2'000, kFirst + 493, 77},  {2'010, kFirst + 496, 50'000},
                         {2'020, kFirst + 492, -500}, {2'300, kFirst + 484, 2},   {2'400, kFirst + 484, 0},
                         {3'200, kFirst + 492, 9'000}};
  travel.insert(travel.end(), std::begin(more), std::end(more));
  std::vector<Action> pid = travel;
  const Action control[] = {{3'300, kFirst + 546, 100}, {3'310, kFirst + 540, 1}, {3'400, kFirst + 541, 2'000},
                            {3'600, kFirst + 540, 0}};
  pid.insert(pid.end(), std::begin(control), std::end(control));
  return {{"md60a", "P160 = \"600 rpm\"\nP620 = 21\n", words},
          {"compact", "P160 = \"600 rpm\"\nP620 = 21\n", words},
          {"mc07", "P620 = 21\n", words},
          {"mdxb", "P160 = \"600 rpm\"\n", words},
          {"md60a", "P700 = 13\nP620 = 21\n", travel},
          {"compact", "P700 = 13\n", travel},
          {"mdxb", "P700 = 18\nP264 = 10\n", pid}};
}

void act(Station& station, const Action& action) {
  station.drive().parameters().execute(ParameterService::WriteVolatile, action.index, action.value);
}

void compare(const Plant& plant, int64_t now) {
  const Station &bare = *plant.stations()[0], &idle = *plant.stations()[1];
  for (uint32_t n = 0; n < bare.config().unit->variables; ++n)
    ASSERT_EQ(bare.variable(n), idle.variable(n)) << "H" << n << " after " << now << " ms";
  ASSERT_TRUE(bare.drive().state().axis() == idle.drive().state().axis()) << now;
  ASSERT_EQ(bare.outputs(), idle.outputs()) << now;
  ASSERT_EQ(bare.fault(), idle.fault()) << now;
}

// Whoever looks how often, in turn and with milliseconds left out.
TEST(NoProgram, VariablesAreThoseOfAProgramThatDoesNothing) {
  for (const bool lazy : {false, true})
    for (const int64_t every : {1, 37, 1'000})
      for (const Case& one : cases()) {
        SCOPED_TRACE(testing::Message() << one.unit << ", " << one.parameters << (lazy ? "lazy" : "in turn") << ", every "
                                        << every << " ms");
        const auto plant = twins(one.unit, one.parameters, lazy ? Execution{} : in_turn());
        ASSERT_NE(plant, nullptr);
        auto next = one.actions.begin();
        for (int64_t now = 0; now <= 4'000; ++now) {
          plant->run_until(ms(now));
          for (; next != one.actions.end() && next->ms == now; ++next)
            for (const auto& station : plant->stations()) act(*station, *next);
          if (now % every != 0) continue;
          ASSERT_NO_FATAL_FAILURE(compare(*plant, now));
        }
      }
}

// By hand: 600 rpm are 40.96 increments a millisecond.
TEST(NoProgram, AMasterReadsWhereTheMotorIs) {
  const auto plant = make_plant(
      "[[station]]\nname = \"u\"\nunit = \"mdxb\"\n[station.parameters]\nP160 = \"600 rpm\"\nP130 = \"0 s\"\n"
      "[station.inputs]\nDI00 = 1\nDI01 = 1\nDI03 = 1\nDI04 = 1\n");
  ASSERT_NE(plant, nullptr);
  const auto& u = *plant->stations()[0];
  plant->run_until(ms(1'000));
  const int32_t before = value(*plant, "H511");
  plant->run_until(ms(2'000));
  EXPECT_NEAR(value(*plant, "H511") - before, 40'960, 1);
  EXPECT_EQ(value(*plant, "ActPos_Mot"), u.read(8320)) << "P003";
  EXPECT_EQ(u.read(kFirst + 511), value(*plant, "H511"));
  EXPECT_EQ(value(*plant, "InputLevel"), 0b11011);
  EXPECT_EQ(value(*plant, "OutputLevel"), u.outputs());
  EXPECT_EQ(value(*plant, "StatusWord") & 0b110, 0b110) << "no fault, ready";
  const_cast<Station&>(u).drive().state().raise_fault(1);
  plant->run_until(ms(2'010));
  EXPECT_EQ(value(*plant, "StatusWord") & 0b110, 0);
}

// The whole way of a master that has nothing but indices: inhibit, enable, reference travel on the spot, target.
TEST(NoProgram, AMasterMovesTheAxis) {
  for (const char* unit : {"md60a", "compact", "mdxb"}) {
    SCOPED_TRACE(unit);
    const auto plant =
        make_plant(std::string("[[station]]\nname = \"u\"\nunit = \"") + unit +
                   "\"\n[station.parameters]\nP700 = 13\nP903 = 5\nP900 = 500\nP601 = 18\n"
                   "[station.inputs]\nDI00 = 1\nDI01 = 1\nDI03 = 1\n");
    ASSERT_NE(plant, nullptr);
    Station& u = *plant->stations()[0];
    plant->run_until(ms(500));
    EXPECT_EQ(value(*plant, "H473") >> 20 & 1, 0);
    u.inputs().line(2).driven = 1;  // DI02 = REF. TRAVEL START
    plant->run_until(ms(520));
    EXPECT_EQ(value(*plant, "H473") >> 20 & 1, 1) << "referenced";
    EXPECT_EQ(value(*plant, "H511"), 500);
    act(u, {0, kFirst + 492, 40'960});
    plant->run_until(ms(900));
    act(u, {0, kFirst + 484, 1 << 30});
    plant->run_until(ms(902));
    EXPECT_FALSE(u.drive().state().output_stage()) << "controller inhibit by H484";
    act(u, {0, kFirst + 484, 0});
    plant->run_until(ms(6'000));
    EXPECT_EQ(value(*plant, "H511"), 40'960);
    EXPECT_EQ(value(*plant, "H473") >> 19 & 1, 1) << "in position";
    act(u, {0, kFirst + 493, 123});
    plant->run_until(ms(6'010));
    EXPECT_EQ(u.read(stdlib::parameter_table(*u.config().unit).find("P922")->index), 123);
  }
}

TEST(NoProgram, TheFirstVariablesSurviveThePower) {
  const auto plant = make_plant("[[station]]\nname = \"u\"\nunit = \"mdxb\"\n");
  ASSERT_NE(plant, nullptr);
  Station& u = *plant->stations()[0];
  plant->run_until(ms(10));
  for (const int n : {0, 127, 128, 1023}) {
    const auto reply = u.drive().parameters().execute(ParameterService::Write, static_cast<uint16_t>(kFirst + n), n + 1);
    EXPECT_TRUE(reply) << n;
  }
  EXPECT_FALSE(u.drive().parameters().execute(ParameterService::Write, kFirst + 1'024, 1));
  u.drive().parameters().execute(ParameterService::WriteVolatile, kFirst + 1, 99);
  plant->run_until(ms(20));
  u.power_off();
  u.power_on();
  plant->run_until(ms(30));
  EXPECT_EQ(value(*plant, "H0"), 1);
  EXPECT_EQ(value(*plant, "H127"), 128);
  EXPECT_EQ(value(*plant, "H1"), 0) << "written volatile";
  EXPECT_EQ(value(*plant, "H128"), 0) << "beyond the kept ones";
  EXPECT_EQ(value(*plant, "H1023"), 0);
}

// Expectations, recordings and watch windows take their names; a unit without IPOS has none.
TEST(NoProgram, NamesAreFound) {
  const auto plant = make_plant(
      "[[station]]\nname = \"a\"\nunit = \"md60a\"\n[[station]]\nname = \"m\"\nunit = \"mc31\"\noption = \"size0\"\n"
      "[[expect]]\nstation = \"a\"\nvariable = \"H511\"\nat = \"1ms\"\nequals = 0\n");
  ASSERT_NE(plant, nullptr);
  plant->run_until(ms(10));
  for (const char* name : {"a.H511", "a.H0", "a.ActPos_Mot", "a.position_target"}) {
    const auto found = signals::find_signals(*plant, name);
    EXPECT_TRUE(found && found->size() == 1) << name;
  }
  EXPECT_EQ(signals::find_variable(*plant->stations()[0], "H512"), std::nullopt);
  for (const char* name : {"m.H511", "m.H0", "m.ActPos_Mot"}) EXPECT_FALSE(signals::find_signals(*plant, name)) << name;
  EXPECT_EQ(signals::find_variable(*plant->stations()[1], "H0"), std::nullopt);
}

}  // namespace
}  // namespace ipos::tests
