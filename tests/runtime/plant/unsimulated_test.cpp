// Every writable parameter is read by the simulation, or stdlib/unsimulated.def says that it is not.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "runtime/drive/settings.hpp"
#include "runtime/positioning/settings.hpp"
#include "runtime/positioning/synchronous.hpp"
#include "runtime/station/sbus_port.hpp"
#include "runtime/unit/unit_interface.hpp"
#include "stdlib/faults.hpp"
#include "stdlib/unsimulated.hpp"

namespace ipos::tests {
namespace {

using namespace ipos::runtime;  // NOLINT
using stdlib::Parameter;
using stdlib::Unsimulated;

// Read where no settings are kept that could be compared; their effects are shown by the tests of those
// parts.
const std::set<std::string_view> kReadElsewhere = {
    "260", "263", "264", "265", "266", "271", "276", "284", "285",  // PID block
    "751",                                                          // setpoint of a slave
    "802", "803", "804", "840",                                     // what ParameterStore carries out
};

// What the parts of a unit make of its parameters.
struct Reading {
  Settings drive;
  std::vector<int32_t> positioning;
  std::vector<int64_t> buses;
  bool operator==(const Reading&) const = default;
};

Reading read(const UnitInterface& unit) {
  Reading reading;
  reading.drive = SettingsReader(unit.parameters()).read(unit.parameters());
  if (unit.unit().has(stdlib::Trait::Positioning))
    reading.positioning = {
#define POSITIONING_SETTING(member, number, absent) unit.value(number),
#include "runtime/positioning/settings.def"
    };
  if (unit.unit().has(stdlib::Trait::OptionCards)) {
#define SYNCHRONOUS_SETTING(member, number, absent) reading.positioning.push_back(unit.value(number));
#include "runtime/positioning/synchronous.def"
  }
  for (const int sbus : {1, 2}) {
    if (sbus == 2 && !unit.unit().has(stdlib::Trait::Sbus2)) continue;
    const SbusSettings s = sbus_settings(unit, sbus);
    for (const int64_t value : {int64_t{s.slave.address}, int64_t{s.slave.group}, int64_t{s.slave.sync_id},
                                int64_t{s.slave.second_channel}, int64_t{s.slave.group_output},
                                int64_t{s.baud}, int64_t{s.movilink}, int64_t{s.canopen_address}})
      reading.buses.push_back(value);
  }
  const SerialParameters serial = unit.serial_parameters();
  for (const int64_t value : {int64_t{serial.address}, int64_t{serial.group}, int64_t{serial.slave_setpoint},
                              int64_t{serial.setpoint_source}})
    reading.buses.push_back(value);
  for (const uint32_t commands : unit.rates().commands) reading.buses.push_back(commands);
  return reading;
}

// Legal values other than the factory setting.
std::vector<int64_t> other_values(const Parameter& parameter) {
  std::vector<int64_t> values;
  for (const stdlib::ValueText& text : parameter.texts) values.push_back(text.value);
  for (const stdlib::ValueRange& range : parameter.ranges) {
    values.insert(values.end(), {range.minimum, range.maximum});
    if (range.maximum - range.minimum >= range.step) values.push_back(range.minimum + range.step);
  }
  if (values.empty()) values = {1, 2};
  std::erase(values, parameter.default_value);
  return values;
}

bool is_read(const stdlib::UnitType& type, const Parameter& parameter) {
  if (kReadElsewhere.count(parameter.number) > 0) return true;
  if (parameter.name.starts_with("Scope")) return true;  // when the scope starts (tests/runtime/drive/scope_test.cpp)
  for (const stdlib::FaultRow& fault : stdlib::fault_table())
    if (const Parameter* found = stdlib::response_parameter(stdlib::parameter_table(type), fault);
        found != nullptr && found->number == parameter.number)
      return true;
  UnitInterface unit(type);
  const Reading before = read(unit);
  for (const int64_t value : other_values(parameter))
    if (unit.parameters().preset(parameter.index, static_cast<int32_t>(value)) && !(read(unit) == before))
      return true;
  return false;
}

TEST(Unsimulated, EveryWritableParameterIsReadOrNamed) {
  size_t looked = 0;
  for (const stdlib::UnitType& type : stdlib::unit_types())
    for (const Parameter* parameter : stdlib::parameter_table(type).by_index()) {
      if (!parameter->writable) continue;
      if (other_values(*parameter).empty()) continue;  // all others are refused
      ++looked;
      const auto rows = stdlib::unsimulated(type, parameter->index);
      const bool named = std::any_of(rows.begin(), rows.end(), [&](const Unsimulated& one) {
        return one.parameter == parameter && one.values.empty() &&
               one.row->scope != stdlib::UnsimulatedScope::Ideal &&  // read, and told without control = "real"
               one.row->scope != stdlib::UnsimulatedScope::Uncoupled;  // or without X42 of [station.encoders]
      });
      EXPECT_NE(is_read(type, *parameter) && !((type.name == "compact" &&
                                                (parameter->number == "819" || parameter->number == "831")) ||
                                               parameter->number == "835"),
                named)
          << type.name << " P" << parameter->number << " " << parameter->name
          << (named ? ": read, but named as without effect" : ": neither read nor in stdlib/unsimulated.def");
    }
  EXPECT_GT(looked, 700U);
}

// A row reaches parameters on each unit it is for, and its codes are values of all of them.
TEST(Unsimulated, RowsFitTheLists) {
  std::set<const stdlib::UnsimulatedRow*> used;
  for (const stdlib::UnitType& type : stdlib::unit_types())
    for (const Unsimulated& one : stdlib::unsimulated(type)) {
      used.insert(one.row);
      ASSERT_EQ(stdlib::parameter_table(type).find(one.parameter->index), one.parameter);
      EXPECT_FALSE(one.row->text.empty());
      for (const stdlib::ValueRange& range : one.values)
        for (int64_t value = range.minimum; value <= range.maximum; ++value)
          EXPECT_TRUE(
              UnitInterface(type).parameters().preset(one.parameter->index, static_cast<int32_t>(value)))
              << type.name << " P" << one.parameter->number << " = " << value;
    }
  EXPECT_EQ(used.size(), stdlib::unsimulated_rows().size());
}

// What is told without a master encoder alone.
TEST(Unsimulated, OfUncoupledSlavesIsToldThereOnly) {
  DriveOptions coupled;
  coupled.master_encoder = true;
  size_t rows = 0;
  for (const stdlib::UnitType& type : stdlib::unit_types())
    for (const Unsimulated& one : stdlib::unsimulated(type)) {
      if (one.row->scope != stdlib::UnsimulatedScope::Uncoupled) continue;
      for (const int64_t value : other_values(*one.parameter)) {
        if (!one.applies(static_cast<int32_t>(value))) continue;
        ++rows;
        UnitInterface alone(type), follower(type, {}, coupled);
        for (UnitInterface* unit : {&alone, &follower})
          ASSERT_TRUE(unit->parameters().preset(one.parameter->index, static_cast<int32_t>(value)));
        EXPECT_EQ(alone.parameters().tell_settings(), std::vector{one.text(static_cast<int32_t>(value))});
        EXPECT_TRUE(follower.parameters().tell_settings().empty()) << one.text(static_cast<int32_t>(value));
        break;
      }
    }
  EXPECT_GT(rows, 60U);
}

// What only ideal control leaves out is told without control = "real" alone.
TEST(Unsimulated, OfIdealControlIsToldThereOnly) {
  size_t rows = 0;
  for (const stdlib::UnsimulatedRow& row : stdlib::unsimulated_rows()) rows += row.scope == stdlib::UnsimulatedScope::Ideal;
  EXPECT_GT(rows, 5U);
  DriveOptions real;
  real.real_control = true;
  for (const stdlib::UnitType& type : stdlib::unit_types())
    for (const Unsimulated& one : stdlib::unsimulated(type)) {
      for (const int64_t value : other_values(*one.parameter)) {
        if (!one.applies(static_cast<int32_t>(value))) continue;
        UnitInterface ideal_unit(type), real_unit(type, {}, real);
        for (UnitInterface* unit : {&ideal_unit, &real_unit})
          if (!unit->parameters().preset(one.parameter->index, static_cast<int32_t>(value))) continue;
        const auto tells = [&](UnitInterface& unit) {
          const std::vector<std::string> told = unit.parameters().tell_settings();
          return std::find(told.begin(), told.end(), one.text(static_cast<int32_t>(value))) != told.end();
        };
        EXPECT_TRUE(tells(ideal_unit)) << one.text(static_cast<int32_t>(value));
        EXPECT_EQ(tells(real_unit), one.row->scope != stdlib::UnsimulatedScope::Ideal) << one.text(static_cast<int32_t>(value));
        break;
      }
    }
}

// The factory setting says nothing; a setting and a write say it once each reason.
TEST(Unsimulated, ToldOncePerParameter) {
  for (const stdlib::UnitType& type : stdlib::unit_types()) {
    EXPECT_TRUE(UnitInterface(type).parameters().tell_settings().empty()) << type.name;
    for (const Unsimulated& one : stdlib::unsimulated(type)) {
      int32_t value = 0;
      for (const int64_t other : other_values(*one.parameter))
        if (one.applies(static_cast<int32_t>(other)) &&
            UnitInterface(type).parameters().preset(one.parameter->index, static_cast<int32_t>(other)))
          value = static_cast<int32_t>(other);
      ASSERT_TRUE(one.applies(value)) << type.name << " P" << one.parameter->number;
      const std::vector<std::string> said{one.text(value)};

      UnitInterface preset(type);
      ASSERT_TRUE(preset.parameters().preset(one.parameter->index, value));
      EXPECT_EQ(preset.parameters().tell_settings(), said);
      EXPECT_TRUE(preset.parameters().tell_settings().empty());

      UnitInterface written(type);
      ParameterStore& parameters = written.parameters();
      for (int n = 0; n < 2; ++n) {
        ASSERT_TRUE(parameters.execute(ParameterService::Write, one.parameter->index, value))
            << type.name << " P" << one.parameter->number << " = " << value;
        EXPECT_EQ(parameters.has_news(), n == 0);
        std::vector<std::string> news = parameters.take_news();
        std::erase_if(news,
                      [](const std::string& text) { return text.find(" was changed: ") < text.size(); });
        EXPECT_EQ(news, n == 0 ? said : std::vector<std::string>{});
      }
    }
  }
}

TEST(Unsimulated, TextOfASetting) {
  const stdlib::UnitType& type = *stdlib::find_unit("md60a");
  const auto text = [&](uint16_t index, int32_t value) {
    std::string found;
    for (const Unsimulated& one : stdlib::unsimulated(type, index))
      if (one.applies(value)) found += one.text(value) + "\n";
    return found;
  };
  EXPECT_EQ(text(8794, 1), "P138 Ramp limit is YES: the ramps are not limited\n");
  EXPECT_EQ(text(8794, 0), "");
  EXPECT_EQ(text(8574, 12), "") << "torque control";
}

// MDX60B/61B: after a change of P870..P875 no process data are taken until P876 is written ON again. Writing
// the value it has changes nothing, and the units whose manuals say nothing of it stay as they are (ours).
TEST(ProcessDataDescription, ChangeBlocksProcessData) {
  for (const char* name : {"md60a", "mc07", "mdxb"}) {
    UnitInterface unit(*stdlib::find_unit(std::string_view(name)));
    ParameterStore& parameters = unit.parameters();
    const bool newer = std::string_view(name) == "mdxb";
    for (uint16_t index = 8304; index <= 8309; ++index) {
      ASSERT_TRUE(parameters.execute(ParameterService::Write, index, parameters.value(index)));
      EXPECT_EQ(unit.value("876"), 1) << index;
      EXPECT_FALSE(parameters.has_news());
      ASSERT_TRUE(parameters.execute(ParameterService::Write, index, parameters.value(index) == 1 ? 0 : 1));
      EXPECT_EQ(unit.value("876"), newer ? 0 : 1) << index;
      EXPECT_EQ(parameters.take_news().size(), newer ? 1U : 0U);
      ASSERT_TRUE(parameters.execute(ParameterService::Write, 8622, 1));
      EXPECT_EQ(unit.value("876"), 1);
    }
  }
  // On a follower the firmware sets the assignments, so a write changes nothing (MDX60B/61B p. 29).
  UnitInterface follower(*stdlib::find_unit("mdxb"));
  ASSERT_FALSE(follower.set_parameter("P100", 8).has_value());
  ASSERT_TRUE(follower.parameters().execute(ParameterService::Write, 8305, 0));
  EXPECT_EQ(follower.value("871"), 1);
  EXPECT_EQ(follower.value("876"), 1);
  // Power off and on: the stored ON counts again (ours).
  UnitInterface unit(*stdlib::find_unit("mdxb"));
  ASSERT_TRUE(unit.parameters().execute(ParameterService::Write, 8306, 1));
  unit.parameters().power_cycle();
  EXPECT_EQ(unit.value("876"), 1);
}

}  // namespace
}  // namespace ipos::tests
