// Nodes of CANopen in the plan of a line.
#include <gtest/gtest.h>

#include "runtime/bus_plan/plan.hpp"
#include "tests/runtime/bus_plan/plant_rig.hpp"

namespace ipos::tests {
namespace {

std::string node(const std::string& name, int address) {
  return station_text(name, "P880 = 1\nP886 = " + std::to_string(address) + "\n", "mdxb");
}

const PlannedIdentifier* identifier(const LinePlan& line, uint32_t id) {
  for (const PlannedIdentifier& planned : line.identifiers)
    if (planned.id == id) return &planned;
  return nullptr;
}

// The pre-defined connection set of node 5, and TPDO1 at each SYNC, whose distance is assumed.
TEST(CanopenPlan, IdentifiersAndTelegrams) {
  PlantRig rig(bus_text() + node("saw", 5) + node("feed", 6));
  const BusPlan plan = make_plan(rig.get(), {});
  const LinePlan& line = plan.lines.at(0);
  EXPECT_EQ(line.stations, 2U);
  for (const uint32_t id : {0x085U, 0x185U, 0x205U, 0x585U, 0x605U, 0x705U}) {
    const PlannedIdentifier* planned = identifier(line, id);
    ASSERT_NE(planned, nullptr) << id;
    ASSERT_EQ(planned->uses.size(), 1U) << id;
    EXPECT_EQ(planned->uses[0].station, "saw");
    EXPECT_EQ(planned->uses[0].transmits, id != 0x205 && id != 0x605) << id;
  }
  for (const uint32_t id : {0x000U, 0x080U}) ASSERT_EQ(identifier(line, id)->uses.size(), 2U);  // to both
  EXPECT_EQ(identifier(line, 0x285), nullptr);                                                  // off
  std::vector<uint32_t> sent;
  for (const PlannedTelegram& telegram : line.telegrams)
    if (telegram.rhythm == Rhythm::Cyclic) {
      sent.push_back(telegram.id);
      EXPECT_EQ(telegram.bytes, 6);
      EXPECT_EQ(telegram.period, 10 * kMillisecond);
    }
  EXPECT_EQ(sent, (std::vector<uint32_t>{0x185, 0x186}));
  EXPECT_FALSE(plan.has_errors());
}

// SYNC has no bytes, a heartbeat one (CiA 301), and each PDO the three words of the unit.
TEST(CanopenPlan, WhatAMasterSends) {
  PlantRig rig(
      bus_text() + node("saw", 5) +
      "[[control]]\nname = 'plc'\nkind = 'canopen'\nsbus = 'sbus'\ncycle = '4ms'\nheartbeat = '20ms'\n"
      "node = 100\n[[control.target]]\naddress = 5\n");
  const BusPlan plan = make_plan(rig.get(), {});
  std::vector<std::tuple<uint32_t, std::string, int, Time>> cyclic;
  for (const PlannedTelegram& telegram : plan.lines.at(0).telegrams)
    if (telegram.rhythm == Rhythm::Cyclic)
      cyclic.emplace_back(telegram.id, telegram.sender, telegram.bytes, telegram.period / kMillisecond);
  EXPECT_EQ(cyclic,
            (decltype(cyclic){
                {0x080, "plc", 0, 4}, {0x185, "saw", 6, 4}, {0x205, "plc", 6, 4}, {0x764, "plc", 1, 20}}));
}

TEST(CanopenPlan, OneAddressTwice) {
  PlantRig rig(bus_text() + node("saw", 5) + node("feed", 5));
  const BusPlan plan = make_plan(rig.get(), {});
  ASSERT_TRUE(plan.has_errors());
  EXPECT_EQ(plan.findings.at(0).kind, FindingKind::DoubleAddress);
  EXPECT_EQ(plan.findings.at(0).text, "saw and feed both have CANopen address 5");
}

// MOVILINK beside it, on the other SBus of the unit.
TEST(CanopenPlan, TwoProtocolsInOneUnit) {
  PlantRig rig(bus_text() + "[[bus]]\nname = \"can\"\nkind = \"can\"\n" +
               station_text("saw", "P881 = 3\nP890 = 1\nP896 = 7\n", "mdxb", "", "sbus2 = \"can\"\n"));
  const BusPlan plan = make_plan(rig.get(), {});
  ASSERT_EQ(plan.lines.size(), 2U);
  EXPECT_NE(identifier(plan.lines[0], 8 * 3 + 515), nullptr);  // parameter request (1053 1610 p. 38)
  EXPECT_EQ(identifier(plan.lines[0], 0x607), nullptr);
  EXPECT_NE(identifier(plan.lines[1], 0x607), nullptr);
  EXPECT_EQ(identifier(plan.lines[1], 8 * 3 + 515), nullptr);
}

}  // namespace
}  // namespace ipos::tests
