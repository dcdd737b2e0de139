// Parts on a conveyor, against calculation by hand: where they are, when they come and go, and which light barriers they
// cover, in the class and in a plant that runs.
#include "runtime/plant/belt.hpp"

#include <gtest/gtest.h>

#include "runtime/plant/trace_hash.hpp"
#include "tests/runtime/plant/plant_rig.hpp"

namespace ipos::runtime {
namespace {

using Fronts = std::vector<double>;

// 4.096 mm a turn: an increment is a thousandth of a millimetre.
DrivenMachine belt_of_100_mm() {
  DrivenMachine machine;
  machine.kind = MachineKind::Conveyor;
  machine.unit = "mm";
  machine.per_turn = 4.096;
  machine.travel = {0, 100};
  machine.part_length = 5;
  return machine;
}

TEST(Belt, PartsRideOnAndFallOffBehindTheEnd) {
  DrivenMachine machine = belt_of_100_mm();
  machine.parts = {10, 90.5};
  Belt belt(machine);
  belt.move(1'000'000);  // wherever the shaft is at first
  EXPECT_EQ(belt.fronts(), (Fronts{10, 90.5}));
  belt.move(1'014'500);
  EXPECT_EQ(belt.fronts(), (Fronts{24.5, 105})) << "its rear lies on the last millimetre";
  belt.move(1'014'501);
  EXPECT_EQ(belt.fronts().size(), 1U);
  belt.move(1'000'000);
  EXPECT_EQ(belt.fronts(), Fronts{10}) << "what has fallen off does not come back";
  belt.move(985'000);
  EXPECT_EQ(belt.fronts(), Fronts{-5});
  belt.move(984'999);
  EXPECT_TRUE(belt.fronts().empty()) << "at the beginning it falls off, too";
}

TEST(Belt, PartsComeWhereTheBeltHasMovedOn) {
  DrivenMachine machine = belt_of_100_mm();
  machine.feed = 20;
  Belt belt(machine);
  belt.move(0);
  EXPECT_EQ(belt.fronts(), Fronts{0});
  belt.move(19'999);
  EXPECT_EQ(belt.fronts().size(), 1U);
  belt.move(20'000);
  EXPECT_EQ(belt.fronts(), (Fronts{20, 0}));
  belt.move(63'000);  // two at once: at 40 mm and at 60 mm
  EXPECT_EQ(belt.fronts(), (Fronts{63, 43, 23, 3}));
  belt.move(60'500);
  belt.move(61'000);
  EXPECT_EQ(belt.fronts(), (Fronts{61, 41, 21, 1})) << "a belt that went back brings no new ones";
}

TEST(Belt, GoesBackwardsWithANegativeWayATurn) {
  DrivenMachine machine = belt_of_100_mm();
  machine.per_turn = -4.096;
  machine.parts = {50};
  Belt belt(machine);
  belt.move(0);
  belt.move(10'000);
  EXPECT_EQ(belt.fronts(), Fronts{40});
  belt.move(-10'000);
  EXPECT_EQ(belt.fronts(), Fronts{60});
}

TEST(Belt, TheCountOfTheShaftWrapsAndTheBeltGoesOn) {
  DrivenMachine machine = belt_of_100_mm();
  machine.parts = {50};
  Belt belt(machine);
  belt.move(INT32_MAX - 999);
  belt.move(INT32_MIN);
  EXPECT_EQ(belt.fronts(), Fronts{51});
}

TEST(Belt, ABarrierIsCoveredFromTheFrontToTheRear) {
  DrivenMachine machine = belt_of_100_mm();
  machine.travel = {-20, 80};
  machine.parts = {30};
  Belt belt(machine);
  belt.move(0);
  EXPECT_EQ(belt.way_to(-20), 0);
  EXPECT_EQ(belt.way_to(30.0006), 50'001) << "rounded to increments";
  const int64_t at = belt.way_to(40);
  const std::pair<int32_t, bool> rows[] = {{9'999, false}, {10'000, true}, {15'000, true}, {15'001, false}};
  for (const auto& [shaft, covered] : rows) {
    belt.move(shaft);
    EXPECT_EQ(belt.covers(at), covered) << shaft;
  }
}

// n11 = 1500 rpm at DI04 (the belt's), and an empty program in front of its inputs.
constexpr const char* kPlantWithABelt = R"(
[[station]]
name = "u"
unit = "mdxb"
[station.parameters]
P130 = "200 ms"
P160 = 1500000
[station.inputs]
DI00 = 1
DI01 = 1
DI03 = 1
DI04 = 1
[station.machine]
kind = "conveyor"
unit = "mm"
per_turn = 4.096
from = 0
to = 100
feed = 20
part_length = 5
[[station]]
name = "gate"
unit = "mdxb"
[[switch]]
station = "u"
input = "DI10"
part_at = 50
[[switch]]
station = "gate"
input = "DI11"
part_at = 52
belt = "u"
active = "low"
)";

// Covered: a part came with every 20 000 increments, and its front is at most 5 mm beyond.
bool covered(int64_t shaft, int64_t at) {
  for (int64_t fed = 0; fed <= shaft; fed += 20'000)
    if (shaft - fed >= at && shaft - fed <= at + 5'000) return true;
  return false;
}

TEST(Belt, InputsOfAPlantSeeTheParts) {
  const auto plant = tests::make_plant(kPlantWithABelt);
  ASSERT_NE(plant, nullptr);
  const Station& belt = *plant->stations()[0];
  const auto level = [&](size_t station, size_t line) {
    return std::as_const(*plant->stations()[station]).inputs().line(line).value() != 0;
  };
  plant->run_until(1);
  EXPECT_FALSE(level(0, 8));
  EXPECT_TRUE(level(1, 9)) << "active low";
  int edges = 0;
  bool last = false;
  for (int64_t at = 1; at < 2000; ++at) {
    const int64_t shaft = belt.shaft_position();
    plant->run_until(tests::ms(at));
    ASSERT_EQ(level(0, 8), covered(shaft, 50'000)) << at << " ms, " << shaft;
    ASSERT_EQ(level(1, 9), !covered(shaft, 52'000)) << at << " ms, " << shaft;
    edges += level(0, 8) && !last ? 1 : 0;
    last = level(0, 8);
  }
  // About 1.6 s at 102.4 increments a millisecond are 164 mm, of which the first 50 mm pass before a part is there.
  EXPECT_GE(edges, 5);
  ASSERT_NE(plant->surroundings().belt_of(belt), nullptr);
  EXPECT_EQ(plant->surroundings().belt_of(*plant->stations()[1]), nullptr);
}

// Without parts a machine is a picture: the plant is the same as without one, and its milliseconds are left out as before.
TEST(Belt, AMachineWithoutPartsChangesNothing) {
  const std::string without = "[[station]]\nname = \"u\"\nunit = \"mdxb\"\n";
  const std::string machine = "[station.machine]\nkind = \"conveyor\"\nunit = \"mm\"\nper_turn = 40\nfrom = 0\nto = 9\n";
  std::string hashes[2];
  int late[2] = {};
  for (const size_t has : {0U, 1U}) {
    const auto plant = tests::make_plant(has != 0 ? without + machine : without);
    TraceHash hash(*plant, tests::ms(100));
    for (int64_t at = 1; at <= 500; ++at) {
      plant->run_until(tests::ms(at));
      late[has] += plant->stations()[0]->behind() ? 1 : 0;
    }
    hash.sample(plant->now());
    hashes[has] = hash.text();
  }
  EXPECT_GT(late[0], 0);
  EXPECT_EQ(late[0], late[1]);
  EXPECT_EQ(hashes[0], hashes[1]);
}

}  // namespace
}  // namespace ipos::runtime
