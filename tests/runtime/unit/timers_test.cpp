// Timers and watchdog to the millisecond.
#include "runtime/services/timers.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/runtime/unit/program_rig.hpp"

namespace ipos::runtime {
namespace {

using tests::ProgramRig;

TEST(Timers, CountDownToZeroAndStay) {
  ProgramRig rig("END\n");
  rig.h("Timer_1") = 3;
  rig.h("Timer_2") = 1;
  rig.h("Timer_0") = 2;
  const int32_t expected[][3] = {{1, 2, 0}, {0, 1, 0}, {0, 0, 0}, {0, 0, 0}};
  for (int n = 0; n < 4; ++n) {
    EXPECT_EQ(rig.tick().timer_0, n == 1);
    EXPECT_EQ(rig.h("Timer_0"), expected[n][0]);
    EXPECT_EQ(rig.h("Timer_1"), expected[n][1]);
    EXPECT_EQ(rig.h("Timer_2"), expected[n][2]);
  }
  rig.h("Timer_1") = -5;
  rig.tick();
  EXPECT_EQ(rig.h("Timer_1"), -5) << "stands still";
}

TEST(Timers, ReloadGivesAnEventEveryReloadMilliseconds) {
  ProgramRig rig("END\n");
  rig.h("T0_Reload") = 7;
  std::vector<int> events;
  for (int ms = 0; ms < 40; ++ms)
    if (rig.tick().timer_0) events.push_back(ms);
  EXPECT_EQ(events, (std::vector<int>{7, 14, 21, 28, 35})) << "loaded in ms 0 without an event";
  rig.h("T0_Reload") = 0;
  events.clear();
  for (int ms = 0; ms < 40; ++ms)
    if (rig.tick().timer_0) events.push_back(ms);
  EXPECT_EQ(events, std::vector<int>{2}) << "the running time ends, then it stands";
}

TEST(Timers, ATimerSetByTheProgramTakesItsTime) {
  // Sets Timer_1 to 20, then notes when it sees 0: H1 counts ms.
  ProgramRig rig(R"(
      SET H488 = 20
M01 : JMP H488 > 0 , M01
      SET H0 = 1
      END
)");
  int ms = 0;
  while (rig.h(0) == 0 && ms < 100) rig.tick(), ++ms;
  EXPECT_EQ(ms, 21) << "set in the first tick, seen 20 ms later";
}

TEST(Timers, RestWhenATickDoesNothing) {
  ProgramRig rig("END\n");
  for (const char* name : {"Timer_0", "Timer_1", "Timer_2", "T0_Reload", "WdogTimer"})
    for (const int32_t value : {-1, 0, 1, 2}) {
      rig.h(name) = value;
      const bool rests = rig.timers.rest(rig.machine.variables());
      const std::vector<int32_t> before(rig.machine.variables().begin(), rig.machine.variables().end());
      Timers timers = rig.timers;
      const auto expired = timers.tick(rig.machine.variables());
      const bool same = std::ranges::equal(rig.machine.variables(), before);
      EXPECT_EQ(rests, same && !expired.timer_0 && !expired.watchdog) << name << " = " << value;
      for (const char* other : {"Timer_0", "Timer_1", "Timer_2", "T0_Reload", "WdogTimer"}) rig.h(other) = 0;
    }
  rig.timers.start_watchdog(rig.machine.variables(), 5);
  EXPECT_TRUE(rig.timers.watchdog_runs());
  EXPECT_FALSE(rig.timers.rest(rig.machine.variables()));
  rig.timers.stop_watchdog();
  EXPECT_FALSE(rig.timers.watchdog_runs());
}

// Up to its bound as tick for tick, and the tick behind it reports or loads something.
TEST(Timers, AdvanceAsTheyTick) {
  for (const int32_t timer_0 : {-1, 0, 1, 2, 6})
    for (const int32_t other : {-3, 0, 1, 2, 9})
      for (const int32_t reload : {-1, 0, 1, 4})
        for (const int32_t watchdog : {-1, 0, 1, 2, 7})
          for (const bool watched : {false, true}) {
            const Timers::Counts begin{timer_0, other, 9 - other, reload, watchdog, watched};
            SCOPED_TRACE(testing::Message()
                         << timer_0 << ' ' << other << ' ' << reload << ' ' << watchdog << ' ' << watched);
            const Ticks bound = begin.bound();
            Timers::Counts ticked = begin;
            for (Ticks n = 0; n <= std::min<Ticks>(bound, 12); ++n) {
              Timers::Counts advanced = begin;
              advanced.advance(n);
              EXPECT_EQ(advanced, ticked) << n;
              const Timers::Counts before = ticked;
              const Timers::Expired expired = ticked.tick();
              const bool decided =
                  expired.timer_0 || expired.watchdog || ticked.timer_0 > std::max(before.timer_0, 0);
              EXPECT_EQ(decided, n == bound) << n;
            }
            const bool ends = timer_0 > 0 || (timer_0 == 0 && reload > 0) || watched;
            EXPECT_EQ(bound == kNoBound, !ends);
          }
  Timers::Counts far{INT32_MAX, INT32_MAX, 5, 0, INT32_MAX, true};
  EXPECT_EQ(far.bound(), static_cast<Ticks>(INT32_MAX) - 1);
  far.advance(far.bound());
  EXPECT_EQ(far, (Timers::Counts{1, 1, 0, 0, 1, true}));
}

TEST(Watchdog, RunsOutUnlessRenewed) {
  ProgramRig rig(R"(
      WDON 10
M01 : JMP H0 == 1 , M01
      SET H490 = 10
      JMP M01
)");
  for (int ms = 0; ms < 50; ++ms) ASSERT_FALSE(rig.tick().watchdog) << ms;
  rig.h(0) = 1;
  rig.tick();  // the round under way may renew it once more
  rig.h("WdogTimer") = 10;
  int ms = 0;
  while (!rig.tick().watchdog && ms < 100) ++ms;
  EXPECT_EQ(ms + 1, 10) << "10 ms after the last renewal";
}

TEST(Watchdog, OffAndZero) {
  ProgramRig off("WDON 5\nWDOFF\nEND\n");
  for (int ms = 0; ms < 20; ++ms) ASSERT_FALSE(off.tick().watchdog);
  EXPECT_EQ(off.h("WdogTimer"), 5) << "keeps its value";
  ProgramRig zero("WDON 0\nM01 : JMP M01\n");
  EXPECT_FALSE(zero.tick().watchdog);
  EXPECT_TRUE(zero.tick().watchdog);
  ProgramRig negative("WDON H0\nEND\n");
  negative.h(0) = -1;
  negative.run();
  EXPECT_EQ(negative.machine.fault().number, 10);
}

}  // namespace
}  // namespace ipos::runtime
