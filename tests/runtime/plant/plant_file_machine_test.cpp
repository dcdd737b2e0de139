// [station.machine] of the plant file and the light barriers of [[switch]]: what they say arrives, and each mistake is
// told once, at its place.
#include "tests/runtime/plant/plant_file_texts.hpp"

namespace ipos::runtime {
namespace {

using tests::expect_mistakes;
using tests::read_plant;

const std::string kDriver = "[[station]]\nname = 'u'\nunit = 'mdxb'\n";
const std::string kMachineHead = kDriver + "[station.machine]\n";
const std::string kConveyor = kMachineHead + "kind = 'conveyor'\nunit = 'mm'\nper_turn = 200\nfrom = 0\nto = 2000\n";

DrivenMachine driven_of(const std::string& text) {
  const auto machine = read_plant(kMachineHead + text).stations.at(0).driven;
  EXPECT_TRUE(machine) << text;
  return machine.value_or(DrivenMachine{});
}

TEST(PlantFileMachine, OfEveryKind) {
  const std::pair<const char*, MachineKind> rows[] = {
      {"axis", MachineKind::Axis},           {"hoist", MachineKind::Hoist},   {"conveyor", MachineKind::Conveyor},
      {"turntable", MachineKind::Turntable}, {"winder", MachineKind::Winder}, {"fan", MachineKind::Fan}};
  EXPECT_EQ(machine_kinds().size(), std::size(rows));
  for (const auto& [word, kind] : rows) {
    const std::string head = "kind = '" + std::string(word) + "'\n";
    const DrivenMachine whole = driven_of(head + "unit = 'mm'\nper_turn = 40\nfrom = 0\nto = 2000\n");
    EXPECT_EQ(std::tuple(whole.kind, whole.unit, whole.per_turn), std::tuple(kind, "mm", 40.0)) << word;
    EXPECT_EQ(std::tuple(whole.travel->from, whole.travel->to), std::tuple(0.0, 2000.0)) << word;
    // A turn of the shaft is a turn, or 360 degrees of a turntable.
    const DrivenMachine bare = driven_of(head);
    const bool table = kind == MachineKind::Turntable;
    EXPECT_EQ(std::tuple(bare.kind, bare.unit, bare.per_turn),
              table ? std::tuple(kind, "deg", 360.0) : std::tuple(kind, "turns", 1.0));
    EXPECT_FALSE(bare.travel) << word;
    EXPECT_FALSE(bare.carries()) << word;
  }
  EXPECT_FALSE(read_plant(kDriver).stations.at(0).driven);
}

TEST(PlantFileMachine, NumbersWithAndWithoutAPoint) {
  const DrivenMachine machine =
      driven_of("kind = 'conveyor'\nunit = 'mm'\nper_turn = -12.5\nfrom = -0.5\nto = 1e3\nparts = [0, 10.5]\n"
                 "part_length = 3\nfeed = 7.25\n");
  EXPECT_EQ(std::tuple(machine.per_turn, machine.travel->from, machine.travel->to, machine.part_length, machine.feed),
            std::tuple(-12.5, -0.5, 1000.0, 3.0, 7.25));
  EXPECT_EQ(machine.parts, (std::vector<double>{0, 10.5}));
  EXPECT_TRUE(machine.carries());
  EXPECT_EQ(machine.place.line, 4U);
  EXPECT_EQ(driven_of("kind = 'turntable'\nper_turn = 36\n").unit, "deg");
}

TEST(PlantFileMachine, Mistakes) {
  expect_mistakes(kDriver, {{"machine = ^5\n", "write [station.machine]"}, {"machine = ^{}\n", "[station.machine] needs kind"}});
  expect_mistakes(kMachineHead, {
                                {"kind = ^'lift'\n", "unknown kind 'lift' of a machine; known are axis, hoist, conveyor, "
                                                     "turntable, winder, fan"},
                                {"kind = ^5\n", "kind must be a text in quotes"},
                                {"kind = 'axis'\n^speed = 5\n", "unknown key 'speed' in [station.machine]"},
                                {"kind = 'axis'\nunit = ^5\nper_turn = 1\n", "unit must be a text in quotes"},
                                {"kind = 'axis'\nunit = ^'mm'\n", "unit needs per_turn"},
                                {"kind = 'axis'\nunit = ^'millimetres....'\nper_turn = 1\n", "unit has at most 12"},
                                {"kind = 'fan'\nper_turn = ^5\n", "per_turn needs unit"},
                                {"kind = 'axis'\nunit = 'mm'\nper_turn = ^0\n", "per_turn must not be 0"},
                                {"kind = 'axis'\nunit = 'mm'\nper_turn = ^'40'\n", "per_turn must be a number"},
                                {"kind = 'axis'\nunit = 'mm'\nper_turn = ^nan\n", "per_turn is -"},
                                {"kind = 'axis'\nunit = 'mm'\nper_turn = ^1e7\n", "per_turn is -"},
                                {"kind = 'axis'\nfrom = ^5\n", "from and to belong together"},
                                {"kind = 'axis'\nto = ^5\n", "from and to belong together"},
                                {"kind = 'axis'\nfrom = 5\nto = ^5\n", "to is not above from"},
                                {"kind = 'axis'\nfrom = 0\nto = ^inf\n", "to is -"},
                                {"kind = 'axis'\nfrom = ^true\nto = 5\n", "from must be a number"},
                            });
}

TEST(PlantFileMachine, MistakesOfParts) {
  expect_mistakes(kMachineHead + "kind = 'axis'\n", {{"parts = ^[]\n", "parts is of a conveyor"},
                                                 {"part_length = ^5\n", "part_length is of a conveyor"},
                                                 {"feed = ^5\n", "feed is of a conveyor"}});
  expect_mistakes(kConveyor, {
                                 {"part_length = 5\nparts = ^5\n", "parts must be a list of places"},
                                 {"part_length = 5\nparts = ^['5']\n", "parts must be a list of places"},
                                 {"part_length = 5\nparts = [0, ^2001]\n", "a part lies from 0 to 2000"},
                                 {"part_length = 5\nparts = [^-1, 2000]\n", "a part lies from 0 to 2000"},
                                 {"parts = ^[5]\n", "parts need part_length"},
                                 {"feed = ^5\n", "parts need part_length"},
                                 {"part_length = 0\nfeed = ^5\n", "parts need part_length, which is above 0"},
                                 {"part_length = ^-1\nfeed = 5\n", "part_length is 0 to"},
                                 {"part_length = 5\nfeed = ^4.9\n", "feed is not below part_length"},
                                 {"part_length = 1\nfeed = ^1.9\n", "at most 1000 parts"},
                             });
  expect_mistakes(kMachineHead + "kind = 'conveyor'\npart_length = 5\n", {{"feed = ^5\n", "parts need from and to"}});
}

TEST(PlantFileMachine, LightBarriers) {
  const PlantFile plant = read_plant(kConveyor + "feed = 100\npart_length = 50\n" + R"(
[[station]]
name = 'gate'
unit = 'mdxb'
[[switch]]
station = 'u'
input = 'DI10'
part_at = 1200.5
active = 'low'
[[switch]]
station = 'gate'
input = 'DI17'
part_at = 0
belt = 'u'
)");
  EXPECT_TRUE(plant.switches.empty());
  ASSERT_EQ(plant.barriers.size(), 2U);
  const auto facts = [](const LightBarrier& row) {
    return std::tuple(row.input.station, row.input.name, row.input.line, row.belt, row.at, row.active_high);
  };
  EXPECT_EQ(facts(plant.barriers[0]), std::tuple("u", "DI10", 8, "u", 1200.5, false));
  EXPECT_EQ(facts(plant.barriers[1]), std::tuple("gate", "DI17", 15, "u", 0.0, true));
}

TEST(PlantFileMachine, MistakesOfLightBarriers) {
  const std::string begin = kConveyor + "feed = 100\npart_length = 50\n";
  const std::string head = "[[switch]]\nstation = 'u'\ninput = 'DI10'\n";
  const std::string other = "[[station]]\nname = 'v'\nunit = 'mdxb'\n";
  expect_mistakes(
      begin + other + head,
      {
          {"part_at = ^'5'\n", "part_at must be a number"},
          {"part_at = ^2001\n", "the belt of 'u' goes from 0 to 2000"},
          {"part_at = 5\nfrom = ^5\n", "a [[switch]] sees the axis (from, to) or parts (part_at)"},
          {"from = 5\nbelt = ^'u'\n", "belt needs part_at"},
          {"part_at = 5\nbelt = ^'v'\n", "'v' has no [station.machine] with kind = \"conveyor\""},
          {"part_at = 5\nbelt = ^'w'\n", "there is no station 'w'"},
          {"part_at = 5\nactive = ^'no'\n", "active is \"high\" or \"low\""},
      });
  expect_mistakes(begin, {{"^" + head + "part_at = 5\n[[wire]]\nfrom = 'u.DO01'\nto = 'u.DI10'\n",
                           "DI10 of u has a wire or switch already"}});
  expect_mistakes(kConveyor, {{head + "part_at = ^5\n", "the conveyor of 'u' has neither parts nor feed"}});
}

}  // namespace
}  // namespace ipos::runtime
