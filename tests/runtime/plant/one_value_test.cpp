// A named value is found by its name, by its group and by its number, and is the same each time; what can be written says
// its limits; what is forced says by whom and until when.
#include <set>

#include "runtime/plant/actions.hpp"
#include "runtime/signals/find.hpp"
#include "stdlib/unit_types.hpp"
#include "tests/runtime/plant/plain_plant.hpp"

namespace ipos::runtime {
namespace {

using signals::Group;
using signals::Signal;
using tests::PlainPlant;

constexpr Group kGroups[] = {Group::Drive,       Group::State, Group::Input,    Group::Output,         Group::Analog,
                             Group::ProcessData, Group::Task,  Group::Variable, Group::SystemVariable, Group::Parameter};

std::string only_unit(std::string_view unit) {
  return "[[station]]\nname = 'u'\nunit = '" + std::string(unit) + "'\n";
}

TEST(OneValue, EachNameNumberAndGroupLeadsToTheSame) {
  for (const stdlib::UnitType& unit : stdlib::unit_types()) {
    if (unit.name == "gateway") continue;
    const PlainPlant plant(only_unit(unit.name));
    ASSERT_TRUE(plant.errors.empty()) << unit.name;
    for (const Group group : kGroups)
      for (const Signal& signal : signals::signals_of(plant.station(), group)) {
        const std::string name(signal.own_name());
        const auto by_name = signals::find_in_group(plant.station(), group, name);
        ASSERT_TRUE(by_name) << unit.name << ' ' << name;
        EXPECT_EQ(by_name->number, signal.number) << name;
        EXPECT_EQ(by_name->read(), signal.read()) << name;
        if (signal.put == nullptr) continue;
        const Group numbered = signal.is_variable() ? Group::Variable : group;
        const auto by_number = signals::signal_at(plant.station(), numbered, signal.number);
        ASSERT_TRUE(by_number) << unit.name << ' ' << name;
        EXPECT_TRUE(by_number->same_as(signal)) << name;
      }
  }
}

// The names that the compiler tells are those that the plant hides.
TEST(OneValue, TheCompilerAndThePlantKnowTheSameNames) {
  for (const stdlib::UnitType& unit : stdlib::unit_types()) {
    if (unit.name == "gateway") continue;
    const PlainPlant plant(only_unit(unit.name));
    for (const Signal& signal : signals::station_signals(plant.station())) {
      const std::string name(signal.own_name());
      if (name.find('.') != std::string::npos || name.ends_with("_value") || signal.number == UINT32_MAX) continue;
      EXPECT_TRUE(signals::is_unit_value(unit, name)) << unit.name << ' ' << name;
    }
    EXPECT_FALSE(signals::is_unit_value(unit, "lCount"));
    EXPECT_FALSE(signals::is_unit_value(unit, "PO11"));
  }
}

TEST(OneValue, OnlyWhatCanBeWrittenIs) {
  const PlainPlant plant(only_unit("mdxb"));
  const std::set<Group> written = {Group::Input, Group::Analog, Group::Variable, Group::SystemVariable, Group::Parameter};
  for (const Group group : kGroups)
    for (const Signal& signal : signals::signals_of(plant.station(), group)) {
      const bool output_word = signal.own_name().starts_with("PO") && signal.own_name().size() == 3;
      const bool load = group == Group::Drive && signal.own_name() == "load_torque";
      const bool mains = group == Group::State && signal.own_name() == "mains";
      EXPECT_EQ(signal.put != nullptr, written.contains(group) || output_word || load || mains) << signal.name;
      if (signal.put != nullptr) continue;
      EXPECT_EQ(signal.write(0), std::string(signal.own_name()) + " can only be read");
    }
  for (const char* name : {"u.H300", "u.DI03", "u.P130", "u.PO1", "u.D*"})
    EXPECT_TRUE(signals::find_signals(*plant, name)->front().owner != nullptr) << name;
  const Signal looked_at = signals::find_station_signals(std::as_const(plant.station()), "DI03").front();
  EXPECT_FALSE(looked_at.is_writable()) << "found in a station that is only looked at";
}

TEST(OneValue, TextsAndLimits) {
  const PlainPlant plant(only_unit("mdxb"));
  const auto one = [&](std::string_view name) { return signals::find_station_signals(plant.station(), name).front(); };
  EXPECT_EQ(one("DI03").parse("on")->sample, 1);
  EXPECT_EQ(one("DI03").check(2), "2 is out of range for an input: 0..1");
  EXPECT_EQ(one("PO1").check(65'536), "65536 is out of range for a process word: -32768..65535");
  EXPECT_EQ(one("PO1").parse("0x1F")->sample, 31);
  EXPECT_EQ(one("H200").parse("-5")->sample, -5);
  EXPECT_FALSE(one("H200").parse("five"));
  EXPECT_EQ(one("P130").parse("2.5 s")->sample, 2'500);
  EXPECT_EQ(one("P130").words(2'500), "2.500 s");
  EXPECT_EQ(one("AI1").parse("5 V")->sample, 5'000);
  EXPECT_EQ(one("AI1").parse("12 mA")->number, one("AI1_current").number) << "the other line of the terminal";
  EXPECT_EQ(one("speed").words(300'000), "300.000 rpm");
  EXPECT_EQ(signals::find_in_group(plant.station(), Group::State, "speed")->unit, "rpm");
}

TEST(OneValue, WhatIsForcedSaysByWhomAndUntilWhen) {
  const PlainPlant plant(only_unit("mdxb"));
  plant->run_until(5 * kMillisecond);
  PlantActions person(*plant, "a person");
  const auto one = [&](std::string_view name) { return signals::find_station_signals(plant.station(), name).front(); };
  EXPECT_EQ(person.force(one("H200"), 7), std::nullopt);
  EXPECT_EQ(person.force(one("DI03"), 1, 20 * kMillisecond), std::nullopt);
  EXPECT_EQ(person.force(one("DI03"), 2), "2 is out of range for an input: 0..1");
  const signals::Holds& holds = plant->surroundings().holds();
  ASSERT_NE(holds.find(one("DI03")), nullptr);
  EXPECT_EQ(holds.find(one("DI03"))->by, "a person");
  EXPECT_EQ(holds.find(one("DI03"))->until, 25 * kMillisecond);
  EXPECT_EQ(holds.find(one("H200"))->until, kNever);
  EXPECT_EQ(one("H200").write(9), std::nullopt);
  plant->run_until(10 * kMillisecond);
  EXPECT_EQ(one("H200").read(), 7);
  plant->run_until(30 * kMillisecond);
  EXPECT_FALSE(person.is_forced(one("DI03"))) << "its time is over";
  EXPECT_EQ(one("DI03").read(), 0);
  one("DI05").line().forced = 1;  // as a debugger does
  EXPECT_TRUE(person.is_forced(one("DI05")));
  person.release(one("DI05"));
  person.release(one("H200"));
  EXPECT_FALSE(person.is_forced(one("DI05")) || person.is_forced(one("H200")));
  EXPECT_TRUE(holds.empty());
}

}  // namespace
}  // namespace ipos::runtime
