// Left-out milliseconds, those that only go on, and those that are executed later: a plant that has them is
// at every moment what one is that executes all of each in its turn. The run without skipping is the expected
// value, in random plants: programs that wait, look, count, send, receive and ask each other, buses, wires,
// switches, and stimuli at random times.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <random>
#include <tuple>
#include <utility>
#include <vector>

#include "runtime/signals/variables.hpp"
#include "tests/harness/proves.hpp"
#include "tests/runtime/plant/picture.hpp"
#include "tests/runtime/plant/plant_rig.hpp"
#include "tests/runtime/plant/waiting_plant.hpp"

namespace ipos::tests {
namespace {

using runtime::Plant;
using runtime::Time;

TEST(Sleep, RandomPlantsAreTheSameAsWithoutIt) {
  uint64_t asleep = 0, steady = 0, late = 0, looked = 0;
  for (uint64_t seed = first_plant(); seed <= plant_count(150); ++seed) {
    WaitingPlant random(seed);
    auto all = make_plant(random.text(), random.sources(), std::nullopt, in_turn()),
         some = make_plant(random.text(), random.sources());
    ASSERT_TRUE(all && some) << random.text();
    Watched expected(std::move(all)), skipping(std::move(some));
    Time now = 0;
    while (now < 4 * runtime::kSecond) {
      now += random.pick(0, 3) == 0 ? random.pick(1, 5'000'000) : ms(random.pick(1, 600));
      expected.plant->run_until(now);
      skipping.plant->run_until(now);
      for (const auto& station : skipping.plant->stations()) {
        late += station->behind() ? 1 : 0;
        asleep += is_asleep(*station) ? 1 : 0;
        steady += is_steady(*station) && !is_asleep(*station) ? 1 : 0;
        ++looked;
      }
      if (random.pick(0, 3) == 0) {
        const auto touch = [&](Plant& plant, size_t n, int level) {
          plant.stations()[n]->inputs().line(2).forced = level;
        };
        const auto n =
            static_cast<size_t>(random.pick(0, static_cast<int>(expected.plant->stations().size()) - 1));
        const int level = random.pick(0, 1);
        touch(*expected.plant, n, level);
        touch(*skipping.plant, n, level);
      }
      ASSERT_NO_FATAL_FAILURE(
          expect_same(skipping, expected, fmt::format("seed {} at {}\n{}", seed, now, random.text())));
    }
  }
  EXPECT_GT(asleep * 4, looked) << "of " << looked << " looks at a station " << asleep << " found it asleep";
  EXPECT_GT(steady * 8, looked) << "of " << looked << " looks at a station " << steady << " found it steady";
  EXPECT_GT(late * 8, looked) << "of " << looked << " looks at a station " << late << " found it late";
}

// The smaller units have neither the variables nor the PID controller of MOVIDRIVE B.
TEST(Sleep, AWaitingProgramSleepsInEveryUnitThatHasPrograms) {
  for (const stdlib::UnitType& unit : stdlib::unit_types()) {
    if (unit.tasks == 0) continue;
    SCOPED_TRACE(unit.title);
    const auto plant = make_station("main() { while (1) _Wait(5000); }", "", std::string(unit.name));
    ASSERT_TRUE(plant);
    plant->run_until(ms(3000));
    EXPECT_TRUE(is_asleep(*plant->stations()[0]));
  }
}

// Within the first second the reference signals P400..P434 come to rest.
TEST(Sleep, AWaitingProgramSleepsUntilItsWaitIsOver) {
  const auto plant = make_station("long n; main() { while (1) { _Wait(5000); n = n + 1; } }");
  ASSERT_TRUE(plant);
  plant->run_until(ms(3000));
  EXPECT_TRUE(is_asleep(*plant->stations()[0]));
  EXPECT_EQ(plant->next_time(), ms(5000));
  EXPECT_EQ(value(*plant, "n"), 0);
  plant->run_until(ms(5000));
  EXPECT_EQ(value(*plant, "n"), 1);
}

// Who asks each millisecond whether the program is over hears it in the millisecond in which it ends.
TEST(Sleep, TheEndOfAProgramIsSeenInItsMillisecond) {
  for (const char* body : {"_Wait(20);", "_Wait(700); n = 1; _Wait(33);", "for (n = 0; n < 3000; n++) ;",
                           "_Wait(1500); for (n = 0; n < 500; n++) ; _Wait(9);"}) {
    const std::string source = std::string("long n; main() { ") + body + " }";
    const std::string unit = "[[station]]\nname = \"u\"\nunit = \"mdxb\"\nprogram = \"P.IPC\"\n";
    const auto expected = make_plant(unit, {{"P.IPC", source}}, std::nullopt, in_turn());
    const auto plant = make_plant(unit, {{"P.IPC", source}});
    ASSERT_TRUE(expected && plant);
    for (const auto& run : {expected.get(), plant.get()})
      run->run_until(20 * runtime::kSecond, [run](runtime::Time) { return !run->programs_over(); });
    EXPECT_LT(expected->now(), 20 * runtime::kSecond) << body;
    EXPECT_EQ(plant->now(), expected->now()) << body;
  }
}

TEST(Sleep, OperatingHoursAreExact) {
  const auto plant = make_station("main() { while (1); }");
  ASSERT_TRUE(plant);
  const uint16_t hours = plant->stations()[0]->drive().parameters().table().find("015")->index;
  plant->run_until(60 * runtime::kSecond - ms(2));
  EXPECT_EQ(plant->stations()[0]->read(hours), 0);
  plant->run_until(60 * runtime::kSecond);
  EXPECT_EQ(plant->stations()[0]->read(hours), 1);
  plant->run_until(3600 * runtime::kSecond);
  EXPECT_EQ(plant->stations()[0]->read(hours), 60);
  EXPECT_EQ(plant->stations()[0]->machine()->task(1).commands, 3'600'001U);
}

TEST(Sleep, AnInputIsSeenInTheNextTick) {
  const auto plant = make_station("long n; main() { while (1) if (H483 & 4) n = H483; }",
                                  "[station.parameters]\nP938 = 9\n");
  ASSERT_TRUE(plant);
  plant->run_until(ms(3000) + 500'000);
  ASSERT_TRUE(is_asleep(*plant->stations()[0]));
  plant->stations()[0]->inputs().line(2).set = 1;
  EXPECT_EQ(plant->next_time(), ms(3001));
  plant->run_until(ms(3001));
  EXPECT_EQ(value(*plant, "n"), 4);
}

// A receiver that sleeps is not told of telegrams that bring nothing new; whatever changes its variables ends
// that.
TEST(Sleep, ATelegramThatBringsNothingNewIsTakenWhenItDoesAgain) {
  const std::string units =
      "[[bus]]\nname = \"can\"\nkind = \"can\"\nbaud = 500000\n"
      "[[station]]\nname = \"sends\"\nunit = \"mdxb\"\nprogram = \"S.IPC\"\nsbus = \"can\"\n"
      "[[station]]\nname = \"hears\"\nunit = \"mdxb\"\nprogram = \"R.IPC\"\nsbus = \"can\"\n"
      "[station.parameters]\nP881 = 2\n";
  const std::string sender =
      "main() { d1 = 7; Tr.ObjectNo = 1100; Tr.CycleTime = 10; Tr.Format = 8; Tr.DPointer = numof(d1);"
      "_SBusCommDef(SCD_TRCYCL, Tr); _SBusCommOn(); _Wait(6000); d1 = 8; while (1); }";
  const std::string receiver =
      "main() { Re.ObjectNo = 1100; Re.Format = 8; Re.DPointer = numof(r1);"
      "_SBusCommDef(SCD_REC, Re); _SBusCommOn(); while (1); }";
  const auto plant =
      make_plant(units, {{"S.IPC", kWaitingHead + sender}, {"R.IPC", kWaitingHead + receiver}}, std::nullopt, {});
  ASSERT_TRUE(plant);
  runtime::Station& hears = *plant->stations()[1];
  const uint32_t r1 = *signals::find_variable(hears, "r1");
  plant->run_until(ms(3002));
  ASSERT_TRUE(is_asleep(hears));
  EXPECT_EQ(hears.variable(r1), 7);
  const auto written = hears.drive().parameters().execute(runtime::ParameterService::WriteVolatile,
                                                          static_cast<uint16_t>(11000 + r1), 5);
  ASSERT_TRUE(written);
  EXPECT_EQ(hears.variable(r1), 5);
  plant->run_until(ms(3013));
  EXPECT_EQ(hears.variable(r1), 7);
  plant->run_until(ms(5999));
  EXPECT_TRUE(is_asleep(hears));
  plant->run_until(ms(6020));
  EXPECT_EQ(hears.variable(r1), 8);
}

// A sender that sleeps leaves its telegrams to the line. Each comes when it is due, with the values of that millisecond,
// whenever somebody writes one, and none twice.
TEST(Sleep, ATelegramThatWasLeftToTheLineComesInItsMillisecondWithItsValue) {
  const std::string units =
      "[[bus]]\nname = \"can\"\nkind = \"can\"\nbaud = 500000\n"
      "[[station]]\nname = \"sends\"\nunit = \"mdxb\"\nprogram = \"S.IPC\"\nsbus = \"can\"\n"
      "[[station]]\nname = \"hears\"\nunit = \"mdxb\"\nsbus = \"can\"\n[station.parameters]\nP881 = 2\n";
  const std::string sender =
      "#include <constb.h>\nSCTRCYCL T10, T30; long d1, d2; main() { d1 = 7;\n"
      "T10.ObjectNo = 1100; T10.CycleTime = 10; T10.Format = 4; T10.DPointer = numof(d1); _SBusCommDef(SCD_TRCYCL, T10);\n"
      "T30.ObjectNo = 1101; T30.CycleTime = 30; T30.Format = 4; T30.DPointer = numof(d2); _SBusCommDef(SCD_TRCYCL, T30);\n"
      "_SBusCommOn(); while (1); }";
  struct Frames final : runtime::CanObserver {
    void on_frame(const runtime::CanLine&, const runtime::FrameRecord& record) override {
      seen[record.frame.id].emplace_back(record.start / runtime::kMillisecond, record.frame.data[3]);
    }
    void on_line_event(const runtime::CanLine&, const runtime::LineEvent&) override {}
    std::map<uint32_t, std::vector<std::pair<Time, int>>> seen;
  };
  const auto plant = make_plant(units, {{"S.IPC", sender}}, std::nullopt, {});
  ASSERT_TRUE(plant);
  Frames frames;
  plant->add_observer(frames);
  runtime::Station& sends = *plant->stations()[0];
  const uint32_t d1 = *signals::find_variable(sends, "d1"), d2 = *signals::find_variable(sends, "d2");
  plant->run_until(ms(3000));
  ASSERT_TRUE(is_asleep(sends));
  const auto first = [&](uint32_t id, Time cycle) { return frames.seen[id].front().first % cycle; };
  const Time begin10 = first(1100, 10), begin30 = first(1101, 30);
  std::map<Time, std::pair<int, int>> written;  // from this millisecond on, both
  written[0] = {7, 0};
  for (Time at = 3000; at < 5000; at += 37 + at % 101) {  // at any place within a cycle, also in the moment of a telegram
    plant->run_until(ms(at) - (at % 2 == 0 ? 1 : 0));
    const int low = static_cast<int>(at % 120), high = static_cast<int>(at % 50);
    const auto write = [&](uint32_t variable, int value) {
      ASSERT_TRUE(sends.drive().parameters().execute(runtime::ParameterService::WriteVolatile,
                                                     static_cast<uint16_t>(11000 + variable), value));
    };
    write(d1, low);
    write(d2, high);
    written[at % 2 == 0 ? at : at + 1] = {low, high};  // the telegram of a millisecond that is over has gone
  }
  plant->run_until(ms(6000));
  EXPECT_TRUE(is_asleep(sends));
  for (const auto& [id, cycle, begin] : {std::tuple(1100U, Time{10}, begin10), std::tuple(1101U, Time{30}, begin30)}) {
    Time due = frames.seen[id].front().first;
    for (const auto& [at, value] : frames.seen[id]) {
      ASSERT_EQ(at, due) << id;
      if (at >= 3000) {
        const auto& values = std::prev(written.upper_bound(at))->second;
        ASSERT_EQ(value, id == 1100 ? values.first : values.second) << id << " at " << at;
      }
      due += cycle;
    }
    EXPECT_EQ(begin, frames.seen[id].back().first % cycle);
    EXPECT_GT(due, 5970) << "to the end";
  }
}

TEST(Sleep, WhoStaysAwakeLeavesOutNothing) {
  const auto plant = make_station("main() { while (1); }");
  ASSERT_TRUE(plant);
  plant->run_until(ms(3000));
  ASSERT_TRUE(is_asleep(*plant->stations()[0]));
  plant->stations()[0]->use_pace(runtime::Pace::InTurn);
  plant->run_until(ms(3100));
  EXPECT_FALSE(is_asleep(*plant->stations()[0]));
  EXPECT_EQ(plant->next_time(), ms(3101));
}

// The programs themselves write no variable that the station follows, so it does not look what they have
// written. What a system function or a telegram writes there must act all the same, and in its millisecond.
class WrittenByOthers : public ::testing::TestWithParam<const char*> {};

TEST_P(WrittenByOthers, ActsInTheSameMillisecond) {
  const std::string text =
      "[[bus]]\nname = \"can\"\nkind = \"can\"\nbaud = 500000\n"
      "[[station]]\nname = \"u\"\nunit = \"mdxb\"\nprogram = \"U.IPC\"\nsbus = \"can\"\n"
      "[station.parameters]\nP881 = 1\nP130 = 200\nP160 = 100600\nP620 = 21\nP938 = 9\n"
      "[station.inputs]\nDI00 = 1\nDI01 = 1\nDI03 = 1\nDI04 = 1\n"
      "[[station]]\nname = \"v\"\nunit = \"mdxb\"\nprogram = \"V.IPC\"\nsbus = \"can\"\n"
      "[station.parameters]\nP881 = 2\n";
  const std::map<std::string, std::string> sources = {
      {"U.IPC", std::string("#include <constb.h>\nSCREC Re; long n; main() {\n") + GetParam()},
      {"V.IPC",
       "#include <constb.h>\nSCTRCYCL Tr; long d; main() { Tr.ObjectNo = 1100; Tr.CycleTime = 10;\n"
       "Tr.Format = 4; Tr.DPointer = numof(d); _SBusCommDef(SCD_TRCYCL, Tr); _SBusCommOn();\n"
       "_Wait(1503); d = 2; while (1) ; }"}};
  const auto expected = make_plant(text, sources, std::nullopt, in_turn()), plant = make_plant(text, sources);
  ASSERT_TRUE(expected && plant);
  const runtime::Station& station = *plant->stations()[0];
  constexpr uint16_t kDo01 = 2;
  bool was_steady = false, steady = false;
  int64_t acted = 0;
  for (int64_t n = 1; n <= 2500; ++n) {
    steady = is_steady(station);
    expected->run_until(ms(n));
    plant->run_until(ms(n));
    ASSERT_EQ(picture(*plant), picture(*expected)) << "after " << n << " ms";
    EXPECT_TRUE(n != 1490 || steady);
    if (acted == 0 && n > 1000 && (station.outputs() & kDo01) != 0) {
      acted = n;
      was_steady = steady;
    }
  }
  EXPECT_GE(acted, 1500) << "DO01 follows H481";
  EXPECT_FALSE(was_steady) << "the tick of the output itself is one in full";
}

INSTANTIATE_TEST_SUITE_P(
    Course, WrittenByOthers,
    ::testing::Values("_Wait(1500); _GetSys(H481, GS_ACTSPEED); while (1) n++; }",
                      "Re.ObjectNo = 1100; Re.Format = 4; Re.DPointer = 481; _SBusCommDef(SCD_REC, Re);\n"
                      "_SBusCommOn(); while (1) n++; }"));

}  // namespace
}  // namespace ipos::tests
