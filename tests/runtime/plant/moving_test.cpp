// Ticks in which a unit does nothing but move are done many at once (runtime/unit/moving_ticks.hpp): a plant whose axes travel
// is at every moment what one is that executes each tick in its turn. That one is the expected value.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <random>
#include <set>
#include <sstream>
#include <vector>

#include "runtime/plant/trace_hash.hpp"
#include "tests/harness/proves.hpp"
#include "tests/runtime/plant/machine_code.hpp"
#include "tests/runtime/plant/picture.hpp"
#include "tests/runtime/plant/plant_rig.hpp"
#include "tests/runtime/plant/travelling_plant.hpp"

namespace ipos::tests {
namespace {

using runtime::Drive;
using runtime::Plant;
using runtime::Station;
using runtime::Time;

bool moves(const Station& station) { return station.mode() == runtime::ManyTicks::Mode::Moving; }

// What the drives decide and how fast they turn, tick by tick.
struct Decided final : runtime::DriveWatcher {
  explicit Decided(Plant& plant) {
    for (const auto& station : plant.stations()) station->add_watcher(*this);
  }
  void on_decided(const Drive& drive, Time tick) override {
    text += fmt::format("{} {} {} {} {:x} {:x}\n", tick, drive.speed(), drive.axis_setpoint(), drive.position(),
                        drive.status_word_1(), drive.outputs());
  }
  std::string text;
};

std::unique_ptr<Plant> lazy_plant(TravellingPlant& random) {
  runtime::Execution execution;
  execution.fast = random.pick(0, 5) != 0;
  if (random.pick(0, 1) == 0) execution.compiler = machine_code;
  return make_plant(random.text(), random.sources(), std::nullopt, execution);
}

TEST(Moving, RandomPlantsAreTheSameAsInTurn) {
  uint64_t moving = 0, behind = 0, looked = 0, faults = 0;
  for (uint64_t seed = first_plant(); seed <= plant_count(200); ++seed) {
    TravellingPlant random(seed);
    auto all = make_plant(random.text(), random.sources(), std::nullopt, in_turn()), some = lazy_plant(random);
    ASSERT_TRUE(all && some) << random.text();
    Watched expected(std::move(all)), skipping(std::move(some));
    const bool often = random.pick(0, 4) == 0;  // each tick is looked at, as a trace does
    Time now = 0;
    while (now < 3 * runtime::kSecond) {
      now += often ? ms(1) : random.pick(0, 3) == 0 ? random.pick(1, 5'000'000) : ms(random.pick(1, 300));
      expected.plant->run_until(now);
      skipping.plant->run_until(now);
      for (const auto& station : skipping.plant->stations()) {
        if (often) break;
        moving += moves(*station) ? 1 : 0;
        behind += moves(*station) && station->behind() ? 1 : 0;
        ++looked;
      }
      if (!often && random.pick(0, 2) == 0) continue;  // nobody looks
      if (often) {
        for (size_t n = 0; n < expected.plant->stations().size(); ++n) {
          const Station &a = *skipping.plant->stations()[n], &b = *expected.plant->stations()[n];
          ASSERT_EQ(a.drive().state().position(), b.drive().state().position()) << seed << " at " << now << random.text();
          ASSERT_EQ(a.drive().state().speed(), b.drive().state().speed()) << seed << " at " << now << random.text();
          ASSERT_EQ(a.status_word_1(), b.status_word_1()) << seed << " at " << now << random.text();
        }
        if (random.pick(0, 200) != 0) continue;
      }
      std::string programs;
      for (const auto& [name, text] : random.sources()) programs += "--- " + name + text;
      ASSERT_NO_FATAL_FAILURE(
          expect_same(skipping, expected, fmt::format("seed {} at {}\n{}{}", seed, now, random.text(), programs)));
    }
    for (const auto& entry : expected.plant->journal().entries()) faults += entry.weight == runtime::Weight::Fault ? 1 : 0;
  }
  EXPECT_GT(faults, 40U);
  EXPECT_GT(moving * 10, looked) << "of " << looked << " looks at a station " << moving << " found it moving";
  EXPECT_GT(behind * 20, looked) << "of " << looked << " looks at a station " << behind << " found it moving and behind";
}

// Who watches the drives is told of each millisecond of the motion, by its own time.
TEST(Moving, WatchersAreToldTheSame) {
  size_t told = 0;
  for (uint64_t seed = 1001; seed <= 1040; ++seed) {
    TravellingPlant random(seed);
    auto all = make_plant(random.text(), random.sources(), std::nullopt, in_turn()), some = lazy_plant(random);
    ASSERT_TRUE(all && some) << random.text();
    // In turn the ticks are told, too, that only count.
    Decided expected(*all), skipping(*some);
    all->run_until(2 * runtime::kSecond);
    some->run_until(2 * runtime::kSecond);
    for (const auto& station : some->stations()) station->look();
    std::set<std::string> in_turn_lines;
    std::istringstream wanted(expected.text), had(skipping.text);
    for (std::string line; std::getline(wanted, line);) in_turn_lines.insert(line);
    for (std::string line; std::getline(had, line); ++told)
      ASSERT_TRUE(in_turn_lines.contains(line)) << seed << ": " << line << '\n' << random.text();
    ASSERT_EQ(picture(*some), picture(*all)) << seed;
  }
  EXPECT_GT(told, 10'000U);
}

// And so is its hash, of what drives decide as of all that there is.
TEST(Moving, TheHashIsTheSame) {
  for (uint64_t seed = 2001; seed <= 2040; ++seed) {
    TravellingPlant random(seed);
    const Time step = seed % 4 == 0 ? ms(1) : runtime::TraceHash::kStep;
    std::vector<std::string> texts;
    for (const bool turns : {true, false}) {
      const auto plant = turns ? make_plant(random.text(), random.sources(), std::nullopt, in_turn()) : lazy_plant(random);
      ASSERT_TRUE(plant) << random.text();
      runtime::TraceHash hash(*plant, step);
      plant->run_until(2 * runtime::kSecond, [&](Time now) {
        hash.sample(now);
        return true;
      });
      texts.push_back(hash.text());
    }
    EXPECT_EQ(texts[0], texts[1]) << seed << '\n' << random.text();
  }
}

// A program that only looks whether the axis has arrived runs ahead of it, and sees it in its millisecond.
TEST(Moving, TheArrivalIsSeenInItsMillisecond) {
  for (int way = 1000; way < 30'000; way += 1711) {
    const std::string source = fmt::format(
        "#include <constb.h>\nlong n; long k; long z; main() {{ _Wait(300); while (1) {{ _GoAbs(GO_NOWAIT, {}); k = k + 1;\n"
        "while (H473 & 0x80000) n = n + 1; while (!(H473 & 0x80000)) z = z + 1; _GoAbs(GO_NOWAIT, 0);\n"
        "while (H473 & 0x80000) n = n + 1; while (!(H473 & 0x80000)) z = z + 1; }} }}",
        way);
    const std::string unit =
        "[[station]]\nname = \"u\"\nunit = \"mdxb\"\nprogram = \"P.IPC\"\n[station.parameters]\nP700 = 13\nP911 = 500\nP912 = 400\n"
        "[station.inputs]\nDI00 = 1\nDI01 = 1\nDI03 = 1\n";
    const auto expected = make_plant(unit, {{"P.IPC", source}}, std::nullopt, in_turn());
    const auto plant = make_plant(unit, {{"P.IPC", source}});
    ASSERT_TRUE(expected && plant);
    int moving = 0;
    for (const int64_t at : {700, 1000, 1300, 1600, 2000, 5000, 9000}) {
      expected->run_until(ms(at));
      plant->run_until(ms(at));
      moving += moves(*plant->stations()[0]) && plant->stations()[0]->behind() ? 1 : 0;
      ASSERT_EQ(picture(*plant), picture(*expected)) << way << " at " << at;
    }
    EXPECT_GT(moving, 0) << way;
    EXPECT_GT(value(*plant, "k"), 1);
  }
}

// No output tells of it, and no program asks: a fault in the middle of a ramp is told with its millisecond.
TEST(Moving, AFaultOnARampIsToldWithItsMillisecond) {
  for (int delay = 100; delay < 200; delay += 30) {
    const std::string unit = fmt::format(
        "[[station]]\nname = \"u\"\nunit = \"mdxb\"\nprogram = \"P.IPC\"\n"
        "[station.parameters]\nP620 = 0\nP621 = 0\nP130 = 200\nP137 = 2000\nP160 = 1500000\nP303 = 110000\nP500 = 3\nP501 = {}\n"
        "[station.inputs]\nDI00 = 1\nDI01 = 1\nDI03 = 1\nDI04 = 1\n[station.load]\ninertia = 3000\n",
        delay);
    const std::map<std::string, std::string> sources = {{"P.IPC", "long n; main() { while (1) n = n + 1; }"}};
    const auto expected = make_plant(unit, sources, std::nullopt, in_turn()), plant = make_plant(unit, sources);
    ASSERT_TRUE(expected && plant);
    bool moving = false;
    for (int64_t at = 20; at < 1200; at += 7) {
      plant->run_until(ms(at));
      moving = moving || (moves(*plant->stations()[0]) && plant->stations()[0]->behind());
    }
    expected->run_until(ms(1200));
    plant->run_until(ms(1200));
    EXPECT_TRUE(moving);
    EXPECT_TRUE(told(*plant, "F08")) << picture(*plant);
    ASSERT_EQ(picture(*plant), picture(*expected)) << delay;
  }
}

// An axis that ends to travel is left to what its program and its speed make of it.
TEST(Moving, ARampThatEndsBecomesSteady) {
  const auto plant = make_station("long n; main() { while (1) n = n + 1; }",
                                  "[station.parameters]\nP130 = 2000\nP160 = 1000000\n"
                                  "[station.inputs]\nDI00 = 1\nDI01 = 1\nDI03 = 1\nDI04 = 1\n");
  ASSERT_TRUE(plant);
  plant->run_until(ms(600));
  EXPECT_TRUE(moves(*plant->stations()[0]));
  plant->run_until(ms(1500));
  EXPECT_FALSE(moves(*plant->stations()[0]));
  EXPECT_TRUE(runs_ahead(*plant->stations()[0]));
}

}  // namespace
}  // namespace ipos::tests
