// The table of units: traits, names in messages, classes of SBus objects, and how a unit at a port is recognised.
#include "stdlib/unit_types.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "stdlib/parameters.hpp"
#include "stdlib/unit_names.hpp"

namespace ipos::stdlib {
namespace {

TEST(UnitTypes, NamesInTheOrderOfTheTable) {
  std::string all, programs, second_bus;
  for (const UnitType& unit : unit_types()) {
    const std::string name(unit.name);
    all += (all.empty() ? "" : ", ") + name;
    if (unit.tasks != 0) programs += (programs.empty() ? "" : ", ") + name;
    if (unit.has(Trait::Sbus2)) second_bus += (second_bus.empty() ? "" : ", ") + name;
  }
  EXPECT_EQ(unit_names(), all);
  EXPECT_EQ(program_unit_names(), programs);
  EXPECT_EQ(unit_names(Trait::Sbus2), second_bus);
  EXPECT_EQ(no_unit_text("nope"), "'nope' is no unit type; known are " + all);
  EXPECT_EQ(usual_unit().name, "md60a");
  EXPECT_EQ(unit_with(Trait::Sbus2).name, "mdxb");
}

// A unit as delivered answers to the indices of its list.
TEST(UnitTypes, EachIsRecognisedByItsOwnSigns) {
  std::set<std::string_view> recognised;
  for (const UnitType& unit : unit_types()) {
    const ParameterTable& table = parameter_table(unit);
    for (const UnitSigns& signs : unit_signs()) {
      bool all = true;
      for (const uint16_t index : signs.indices) all &= table.find(index) != nullptr;
      if (!all) continue;
      EXPECT_EQ(signs.unit, unit.name);
      recognised.insert(unit.name);
      break;
    }
  }
  for (const UnitSigns& signs : unit_signs()) EXPECT_TRUE(recognised.contains(signs.unit)) << signs.unit;
  for (const UnitType& unit : unit_types()) EXPECT_EQ(recognised.contains(unit.name), unit.runs_programs()) << unit.name;
}

// Cycle times and offsets as printed: 1053 1610 p. 54, MOVITRAC 07 chapter 5.2, IPOSplus p. 232.
TEST(UnitTypes, CyclesAndOffsetsAsPrinted) {
  for (const UnitType& unit : unit_types())
    for (int32_t cycle = -10; cycle <= 65'600; ++cycle) {
      const bool tens = cycle >= 10 && cycle <= 65'530 && cycle % 10 == 0;
      const bool fast = cycle >= 1 && cycle <= 9;
      bool expected = false;
      switch (unit.family) {
        case Family::MovidriveA:
        case Family::MovidriveB: expected = tens || fast; break;
        case Family::Movitrac07: expected = tens; break;
        case Family::MovitracB: expected = cycle >= 1 && cycle <= 255; break;
        case Family::Movitrac31: break;
      }
      ASSERT_EQ(unit.objects_of(cycle) != nullptr, expected) << unit.name << " " << cycle;
    }
  const auto offset_allowed = [](const char* unit, int32_t offset, int32_t cycle) {
    return find_unit(unit)->objects_of(cycle)->has_offset(offset, cycle);
  };
  for (int32_t offset = -10; offset <= 65'600; ++offset) {
    const bool tens = offset >= 0 && offset <= 65'530 && offset % 10 == 0;
    for (const char* older : {"md60a", "compact", "mc07"})
      for (const int32_t cycle : {10, 65'530}) ASSERT_EQ(offset_allowed(older, offset, cycle), tens) << offset;
    ASSERT_EQ(offset_allowed("md60a", offset, 5), offset >= 0 && offset <= 65'534) << offset;
    ASSERT_EQ(offset_allowed("mdxb", offset, 5), offset >= 0 && offset < 5) << offset;
    ASSERT_EQ(offset_allowed("mdxb", offset, 9), offset >= 0 && offset <= 8) << offset;
    ASSERT_EQ(offset_allowed("mdxb", offset, 500), tens && offset < 500) << offset;
    for (const int32_t cycle : {1, 100, 254, 255})
      ASSERT_EQ(offset_allowed("mc07b", offset, cycle), offset >= 0 && offset + cycle <= 255) << offset << " " << cycle;
  }
}

}  // namespace
}  // namespace ipos::stdlib
