// The debugger in one process: stops, steps, and back again by running anew.
#include <gtest/gtest.h>

#include "tests/debug/plants.hpp"

namespace ipos::tests {
namespace {

using namespace tools::debug;
using runtime::kMillisecond;

// Line numbers count from 1; line 1 is the header.
constexpr const char* kProgram = R"(#include <const.h>
long lCount;
long lSum;
long lWrong;
Add()
{
  lSum = lSum + lCount;
  if (lCount == 7) lWrong = 1;
}
Other()
{
  while (1) { H10++; }
}
main()
{
  _SetTask2(T2_START, Other);
  while (1)
  {
    lCount++;
    Add();
    _Wait(5);
  }
}
)";

class Debugging : public ::testing::Test {
 protected:
  int32_t value(const std::string& name) { return evaluate(debugger_.plant(), 0, name); }
  uint32_t line() { return debugger_.frames(kTask).at(0).place.line; }
  uint32_t address(uint32_t line) { return *debugger_.code(0)->address_of("P1.IPC", line); }
  int stop_at(uint32_t line) {
    debugger_.breakpoints().push_back({debugger_.next_id(), 0, address(line), "", "", "", false, true, 0});
    return debugger_.breakpoints().back().id;
  }
  Stop go(Motion motion, bool backward = false) {
    return debugger_.run(debugger_.order_for(motion, kTask, backward));
  }

  static constexpr TaskRef kTask{0, 1};
  Quiet quiet_;
  Debugger debugger_{plant_of({kProgram, kProgram}), quiet_, nullptr, 10 * runtime::kSecond};
};

TEST_F(Debugging, StepsIntoOverAndOut) {
  stop_at(19);
  EXPECT_EQ(go(Motion::Continue).reason, Reason::Breakpoint);
  EXPECT_EQ(line(), 19U);
  EXPECT_EQ(value("lCount"), 0);
  go(Motion::Over);
  EXPECT_EQ(line(), 20U);
  EXPECT_EQ(value("lCount"), 1);
  go(Motion::Into);
  EXPECT_EQ(line(), 7U);
  ASSERT_EQ(debugger_.frames(kTask).size(), 2U);
  EXPECT_EQ(debugger_.frames(kTask)[0].function, "Add");
  EXPECT_EQ(debugger_.frames(kTask)[1].function, "main");
  EXPECT_EQ(debugger_.frames(kTask)[1].place.line, 20U);
  go(Motion::Out);
  EXPECT_EQ(debugger_.frames(kTask).size(), 1U);
  EXPECT_EQ(value("lSum"), 1);
  EXPECT_EQ(line(), 21U);  // the call was all of line 20
}

TEST_F(Debugging, AStepOverAWaitingCommandLetsItsTimePass) {
  stop_at(21);
  go(Motion::Continue);
  const auto before = debugger_.position().time;
  go(Motion::Over);
  EXPECT_GE(debugger_.position().time, before + 5 * kMillisecond);
}

TEST_F(Debugging, AConditionAndAHitCountChooseTheStop) {
  stop_at(20);
  debugger_.breakpoints()[0].condition = "lCount == 4";
  go(Motion::Continue);
  EXPECT_EQ(value("lCount"), 4);
  debugger_.breakpoints()[0].condition = "";
  debugger_.breakpoints()[0].hits = 0;
  debugger_.breakpoints()[0].hit_condition = "3";
  go(Motion::Continue);
  EXPECT_EQ(value("lCount"), 7);
}

TEST_F(Debugging, ALogpointPrintsAndGoesOn) {
  stop_at(20);
  debugger_.breakpoints()[0].log = "count {lCount}, {lCount * 2}";
  Order order = debugger_.order_for(Motion::ToTime, kTask);
  order.time = 200 * kMillisecond;
  debugger_.run(order);
  EXPECT_TRUE(quiet_.text.starts_with("count 1, 2\ncount 2, 4\n")) << quiet_.text;
}

TEST_F(Debugging, AWrongValueIsFollowedBackToItsCause) {
  debugger_.watchpoints().push_back(
      {debugger_.next_id(), 0, evaluate_place(debugger_.plant(), 0, "lWrong"), "", true, 0});
  const Stop stop = go(Motion::Continue);
  EXPECT_EQ(stop.reason, Reason::Data);
  EXPECT_EQ(stop.text, "lWrong: 0 -> 1");
  go(Motion::Continue, true);  // the change that stopped is the last one
  EXPECT_EQ(value("lCount"), 7);
  EXPECT_EQ(go(Motion::Continue).text, stop.text);  // and comes again
  Order later = debugger_.order_for(Motion::ToTime, kTask);
  later.time = 2000 * kMillisecond;
  debugger_.run(later);
  EXPECT_GT(value("lCount"), 10);
  const Stop cause = go(Motion::Continue, true);
  EXPECT_EQ(cause.reason, Reason::Data);
  EXPECT_EQ(line(), 8U);
  EXPECT_EQ(value("lWrong"), 0);  // not yet written
  EXPECT_EQ(value("lCount"), 7);
  go(Motion::Over, true);  // to the beginning of its line
  EXPECT_EQ(line(), 8U);
  go(Motion::Over, true);
  EXPECT_EQ(line(), 7U);
}

TEST_F(Debugging, EverySingleStepCanBeTakenBack) {
  std::vector<std::pair<Position, std::vector<int32_t>>> taken;
  const auto all = [&] {
    std::vector<int32_t> values;
    for (const auto& station : debugger_.plant().stations())
      values.insert(values.end(), station->machine()->variables().begin(),
                    station->machine()->variables().end());
    return values;
  };
  for (int n = 0; n < 40; ++n) {
    go(Motion::Instruction);
    taken.emplace_back(debugger_.position(), all());
  }
  for (size_t n = taken.size() - 1; n-- > 0;) {
    go(Motion::Instruction, true);
    ASSERT_EQ(debugger_.position().commands, taken[n].first.commands);
    ASSERT_TRUE(debugger_.position() == taken[n].first);
    ASSERT_EQ(all(), taken[n].second);
  }
}

TEST_F(Debugging, WhatTheUserWritesIsWrittenAgainWhenItsMomentComesAgain) {
  stop_at(20);
  go(Motion::Continue);
  debugger_.write(evaluate_place(debugger_.plant(), 0, "lSum"), 1000);
  go(Motion::Over);
  EXPECT_EQ(value("lSum"), 1001);
  go(Motion::Instruction, true);
  go(Motion::Instruction, true);
  EXPECT_GE(value("lSum"), 1000);
  while (debugger_.position().commands > 1 && value("lSum") >= 1000) go(Motion::Instruction, true);
  EXPECT_EQ(value("lSum"), 0);
}

TEST_F(Debugging, AVisitLosesNothingAndRunningOnDropsWhatCameLater) {
  const auto run_to = [this](int ms) {
    Order order = debugger_.order_for(Motion::ToTime, kTask);
    order.time = ms * kMillisecond;
    debugger_.run(order);
  };
  run_to(100);
  debugger_.write(evaluate_place(debugger_.plant(), 0, "lWrong"), 1000);
  run_to(200);
  const int32_t sum = value("lSum");
  debugger_.visit(50 * kMillisecond);
  EXPECT_EQ(debugger_.position().time, 50 * kMillisecond);
  EXPECT_NE(value("lWrong"), 1000);
  EXPECT_LT(value("lSum"), sum);
  EXPECT_EQ(debugger_.furthest().time, 200 * kMillisecond);
  go(Motion::Instruction, true);  // a step back is a look, too
  debugger_.visit(200 * kMillisecond);
  EXPECT_EQ(value("lWrong"), 1000);
  EXPECT_EQ(value("lSum"), sum);
  debugger_.visit(0);
  EXPECT_EQ(value("lSum"), 0);
  run_to(60);
  EXPECT_EQ(debugger_.furthest().time, 60 * kMillisecond);
  run_to(200);
  EXPECT_NE(value("lWrong"), 1000);
  EXPECT_EQ(value("lSum"), sum);
}

TEST_F(Debugging, TheBeginningIsAStop) {
  go(Motion::Over);
  EXPECT_EQ(go(Motion::Continue, true).reason, Reason::Beginning);
  EXPECT_EQ(debugger_.position().commands, 0U);
  EXPECT_EQ(go(Motion::Continue, true).reason, Reason::Beginning);
}

TEST_F(Debugging, ADebuggedPlantDoesWhatItDoesWithoutDebugger) {
  stop_at(20);
  while (debugger_.position().time < 50 * kMillisecond) go(Motion::Continue);
  debugger_.breakpoints().clear();
  Order order = debugger_.order_for(Motion::ToTime, kTask);
  order.time = 300 * kMillisecond;
  debugger_.run(order);
  const auto plain = plant_of({kProgram, kProgram})();
  plain->run_until(300 * kMillisecond);
  for (size_t n = 0; n < 2; ++n) {
    const auto debugged = debugger_.plant().stations()[n]->machine()->variables();
    const auto expected = plain->stations()[n]->machine()->variables();
    EXPECT_TRUE(std::equal(debugged.begin(), debugged.end(), expected.begin(), expected.end()));
    for (int task = 1; task <= vm::kTasks; ++task)
      EXPECT_EQ(debugger_.machine(static_cast<uint32_t>(n))->task(task).commands,
                plain->stations()[n]->machine()->task(task).commands);
  }
}

TEST_F(Debugging, AFaultOfTheProgramStopsAtItsCommand) {
  Debugger other(plant_of({"\nmain()\n{\n  H1 = 5;\n  H2 = H1 / H3;\n}\n"}), quiet_, nullptr, runtime::kSecond);
  const Stop stop = other.run(Order{});
  EXPECT_EQ(stop.reason, Reason::Fault);
  EXPECT_TRUE(stop.text.starts_with("F10")) << stop.text;
  EXPECT_EQ(other.frames({0, 1}).at(0).place.line, 5U);
}

TEST_F(Debugging, ExpressionsFollowC) {
  EXPECT_EQ(value("1 + 2 * 3 == 7 && !(4 & 3)"), 1);
  EXPECT_EQ(value("-7 / 2"), -3);
  EXPECT_EQ(value("0xFFFFFFFF"), -1);
  EXPECT_EQ(value("unit2.H0 + H[1 + 1]"), 0);
}

TEST_F(Debugging, NamesOfPartsAreThoseOfTheWatch) {
  Debugger other(
      plant_of({"typedef struct { long a; long b[3]; } T;\nT y[2];\nlong v[2];\nmain()\n{\n  y[1].b[2] = 9;\n"
                "  v[1] = 7;\n  H498 = 5;\n  y[0].a = 2;\n}\n"}),
      quiet_, nullptr, runtime::kSecond);
  other.run(Order{});
  const auto value_of = [&](const char* text) { return evaluate(other.plant(), 0, text); };
  EXPECT_EQ(value_of("y[1].b[2]"), 9);
  EXPECT_EQ(value_of("y[y[0].a - 1].b[1 + 1] + v[1]"), 16);
  EXPECT_EQ(value_of("unit1.y[0].a"), 2);
  EXPECT_EQ(value_of("RefOffset"), 5);
  EXPECT_EQ(value_of("H[498]"), 5);
  EXPECT_EQ(evaluate_place(other.plant(), 0, "y[1].b[2]").name, "y[1].b[2]");
  for (const char* text : {"y", "y[0]", "y[2].a", "y[0].c", "y[0].b[3].a"})
    EXPECT_THROW(value_of(text), ValueError) << text;
}

TEST_F(Debugging, NonsenseIsRefused) {
  for (const char* text : {"", "1 +", "nobody", "1 / 0", "(1", "H[9999]", "5x", "lCount lSum", "unit9.H0"})
    EXPECT_THROW(value(text), ValueError) << text;
  EXPECT_THROW(value(std::string(100'000, '(')), ValueError);
  EXPECT_THROW(value(std::string(100'000, '-')), ValueError);
}

}  // namespace
}  // namespace ipos::tests
