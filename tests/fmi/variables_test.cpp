// What variables signals become: every unit type, every parameter.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "runtime/fmi/variables.hpp"
#include "runtime/signals/collector.hpp"
#include "stdlib/parameters.hpp"
#include "tests/fmi/functions.hpp"

namespace ipos::tests {
namespace {

using fmi::Causality;
using fmi::Type;
using fmi::Variable;

const Variable& find(const Resources& resources, const std::string& name) {
  return resources.variables().all.at(resources.reference(name) - 1);
}

TEST(FmiVariables, OfEveryUnitHaveUnitsRangesAndWords) {
  for (const stdlib::UnitType& unit : stdlib::unit_types()) {
    if (unit.name == "gateway") continue;
    const Resources resources("[[station]]\nname = 'u'\nunit = '" + std::string(unit.name) + "'\n", "",
                              {{}, {"P*", "status.*", "PO1.*"}});
    std::set<std::string> names;
    std::set<std::string> units;
    for (const auto& each : resources.variables().units) EXPECT_TRUE(units.insert(each.name).second) << each.name;
    for (const Variable& variable : resources.variables().all) {
      const auto& signal = variable.signal;
      EXPECT_TRUE(names.insert(variable.name).second) << variable.name;
      EXPECT_EQ(variable.type == Type::Real, units.contains(variable.unit)) << variable.name;
      if (!signal.unit.empty() && signal.unit != "ascii" && signal.unit != "firmware") {
        EXPECT_NE(signals::find_physical_unit(signal.unit), nullptr) << variable.name << " in " << signal.unit;
        EXPECT_TRUE(variable.type == Type::Real || variable.type == Type::Enumeration) << variable.name << ": or each value has words";
      }
      const int64_t now = signal.read();
      if (variable.range) {
        EXPECT_LE(variable.range->first, now) << variable.name;
        EXPECT_GE(variable.range->second, now) << variable.name;
      }
      if (variable.type == Type::Integer) {
        EXPECT_EQ(static_cast<int32_t>(now), now) << variable.name;
      }
      if (variable.is_settable()) {
        EXPECT_NE(signal.put, nullptr) << variable.name;
      }
    }
    for (const fmi::Enumeration& type : resources.variables().enumerations) {
      std::set<std::string> texts;
      std::set<int32_t> values;
      for (const auto& [value, text] : type.items) {
        EXPECT_TRUE(texts.insert(text).second) << type.name << " " << text;
        EXPECT_TRUE(values.insert(value).second) << type.name << " " << value;
      }
    }
  }
}

TEST(FmiVariables, HaveTheCausalityOfWhatTheyAre) {
  const std::string plant = R"([[bus]]
name = "sbus"
kind = "can"
[[station]]
name = "u"
unit = "mdxb"
program = "P.IPC"
sbus = "sbus"
[[station]]
name = "driven"
unit = "mdxb"
[station.load]
driven = true
[[wire]]
from = "u.DO01"
to = "u.DI03"
)";
  const Resources resources(plant, "long lCount; main() { lCount = 1; }\n", {{}, {"u.lCount", "u.H7", "u.PO1.3"}});
  const struct {
    const char* name;
    Causality causality;
    Type type;
    const char* unit;
  } rows[] = {{"u.DI01", Causality::Input, Type::Boolean, ""},
              {"u.DI03", Causality::Local, Type::Boolean, ""},  // hangs on a wire
              {"u.AI1", Causality::Input, Type::Real, "V"},
              {"u.load_torque", Causality::Input, Type::Real, "Nm"},
              {"u.shaft_speed", Causality::Output, Type::Real, "rad/s"},
              {"u.shaft_angle", Causality::Output, Type::Real, "rad"},
              {"u.torque", Causality::Output, Type::Real, "Nm"},
              {"driven.shaft_speed", Causality::Input, Type::Real, "rad/s"},
              {"driven.load_torque", Causality::Output, Type::Real, "Nm"},
              {"u.speed", Causality::Output, Type::Real, "rpm"},
              {"u.fault", Causality::Output, Type::Enumeration, ""},
              {"u.status", Causality::Output, Type::Integer, ""},
              {"u.DB00", Causality::Output, Type::Boolean, ""},
              {"u.PI1", Causality::Output, Type::Integer, ""},
              {"u.P130", Causality::Parameter, Type::Real, "s"},
              {"u.P100", Causality::Parameter, Type::Enumeration, ""},
              {"u.lCount", Causality::Output, Type::Integer, ""},  // chosen
              {"u.H7", Causality::Output, Type::Integer, ""},
              {"u.'PO1.3'", Causality::Output, Type::Boolean, ""},
              {"u.ActPos_Mot", Causality::Local, Type::Integer, ""},
              {"u.task1.state", Causality::Local, Type::Enumeration, ""},
              {"sbus.load", Causality::Output, Type::Real, "%"}};
  for (const auto& row : rows) {
    const Variable& variable = find(resources, row.name);
    EXPECT_EQ(variable.causality, row.causality) << row.name;
    EXPECT_EQ(variable.type, row.type) << row.name;
    EXPECT_EQ(variable.unit, row.unit) << row.name;
  }
  EXPECT_TRUE(find(resources, "u.load_torque").is_continuous);
  EXPECT_FALSE(find(resources, "u.speed").is_continuous);
}

TEST(FmiVariables, AChoiceThatNamesNothingSaysWhatThereIs) {
  std::vector<runtime::PlantError> errors;
  runtime::Plant plant(runtime::read_plant_file("[[station]]\nname = 'u'\nunit = 'mdxb'\n").plant, {std::nullopt}, {}, errors);
  EXPECT_EQ(fmi::variables_of(plant, {{"v"}, {}}).error(), "there is no station 'v'; the plant has u");
  EXPECT_TRUE(fmi::variables_of(plant, {{}, {"u.sped"}}).error().starts_with("station 'u' has no signal 'sped'"));
}

}  // namespace
}  // namespace ipos::tests
