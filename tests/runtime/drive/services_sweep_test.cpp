// Every parameter of every list x every service x (minimum, minimum - step, maximum, maximum + step, off the
// grid, default): the value or exactly the right return code. The rules are computed here from the cells of
// the lists.
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/harness/proves.hpp"
#include "tests/runtime/drive/fake_drive.hpp"
#include "tests/runtime/drive/service_rules.hpp"

namespace ipos::runtime {
namespace {

using namespace tests;  // NOLINT: the rules

TEST(ServicesSweep, EveryParameterEveryServiceEveryLimit) {
  PROVES("PAR-01", "PAR-04", "PAR-05", "PAR-11", "PAR-14", "PAR-21", "PAR-39", "MLK-02", "M07-PAR-02",
         "M07-PAR-09", "M07-PAR-11");
  long cases = 0;
  for (const UnitLists& unit : kUnits) {
    const stdlib::UnitType& type = tests::unit(unit.unit);
    const bool m07 = type.family == stdlib::Family::Movitrac07;
    tests::FakeDrive drive;
    ParameterStore fresh(type);
    fresh.connect(drive);
    for (const auto& [index, p] : tests::listed(unit.files, unit.option_cards))
      for (int service = 0; service <= 15; ++service) {
        if (service == 8) continue;  // own test
        for (const int64_t value : probes(p)) {
          ParameterStore store = fresh;
          ++cases;
          const Expected want = expected_of(p, m07, service, value);
          const ParameterReply got = store.execute(static_cast<uint8_t>(service), index, bits(value));
          const uint32_t code = got ? kOk : got.error().packed();
          ASSERT_EQ(code, want.code) << unit.unit << " index " << index << " service " << service << " value "
                                     << value;
          ASSERT_EQ(got.value_or(0), code == kOk ? bits(want.value) : 0) << unit.unit << " index " << index;
          // A refused or reading service leaves the value; a write is read back, unless it was an order.
          const bool order = index == 8596 || index == 8617;
          const bool wrote = code == kOk && (service == 2 || service == 3) && !order;
          ASSERT_EQ(store.value(index), bits(wrote ? value : p.default_value))
              << unit.unit << " index " << index;
          // Only Write, only of N parameters, survives power-off.
          store.power_cycle();
          const bool kept = wrote && service == 2 && p.has("N");
          ASSERT_EQ(store.value(index), bits(kept ? value : p.default_value))
              << unit.unit << " index " << index;
          ASSERT_EQ(store.eeprom_writes(index), kept ? 1U : 0U);
        }
      }
  }
  std::printf("service cases: %ld\n", cases);
  RecordProperty("cases", static_cast<int>(cases));
}

// P802 itself needs an unlocked unit.
void start_factory_setting(ParameterStore& store) {
  const int32_t lock = store.value(8595);
  ASSERT_TRUE(store.preset(8595, 0));
  ASSERT_TRUE(store.execute(ParameterService::Write, 8594, 1));
  ASSERT_TRUE(store.preset(8595, lock));
}

// Writes of the default in each state of the drive: which state refuses which parameter, with which code.
TEST(ServicesSweep, EveryParameterInEveryState) {
  PROVES("PAR-12", "PAR-13", "PAR-16", "PAR-17", "M07-PAR-12", "M07-PAR-19");
  long cases = 0;
  for (const UnitLists& unit : kUnits) {
    const stdlib::UnitType& type = tests::unit(unit.unit);
    for (const auto& [index, p] : tests::listed(unit.files, unit.option_cards))
      for (const bool inhibited : {true, false})
        for (const bool stage_on : {true, false})
          for (const bool locked : {true, false})
            for (const bool factory : {true, false})
              for (const bool cards : {true, false}) {
                tests::FakeDrive drive;
                ParameterStore store(type, {cards, cards, cards, true});
                store.connect(drive);
                ASSERT_TRUE(store.preset(8595, locked ? 1 : 0));
                if (factory) start_factory_setting(store);
                drive.inhibited = inhibited;
                drive.stage_on = stage_on;
                const ParameterReply got = store.execute(2, index, bits(p.default_value));
                uint32_t want = kOk;
                if (!p.has("RW"))
                  want = refusal(0x12);
                else if (factory)
                  want = refusal(0x14);
                else if (!cards && !p.cells.at("option").empty())
                  want = refusal(0x17);
                else if (locked && !p.has("S"))
                  want = refusal(0x13);
                else if (!inhibited && p.has("R"))
                  want = refusal(0x1C);
                else if (stage_on && p.has("E"))
                  want = refusal(0x20);
                ++cases;
                ASSERT_EQ(got ? kOk : got.error().packed(), want)
                    << unit.unit << " index " << index << " inhibited " << inhibited << " stage " << stage_on
                    << " locked " << locked << " factory " << factory << " cards " << cards;
              }
  }
  std::printf("state cases: %ld\n", cases);
  RecordProperty("cases", static_cast<int>(cases));
}

TEST(ServicesSweep, AttributesWalkTheList) {
  PROVES("PAR-06");
  for (const UnitLists& unit : kUnits) {
    ParameterStore store(tests::unit(unit.unit));
    uint16_t index = 8300;
    for (const auto& [listed_index, p] : tests::listed(unit.files, unit.option_cards)) {
      ASSERT_EQ(index, listed_index) << unit.unit;
      const ParameterReply reply = store.execute(ParameterService::ReadAttribute, index);
      ASSERT_TRUE(reply);
      const auto word = static_cast<uint32_t>(*reply);
      EXPECT_EQ((word >> 0) & 1, p.has("RW") ? 1U : 0U) << index;
      EXPECT_EQ((word >> 1) & 1, p.has("N") ? 1U : 0U) << index;
      EXPECT_EQ((word >> 2) & 1, p.has("RW") ? 1U : 0U)
          << index << ": the factory setting, of the working value";
      EXPECT_EQ((word >> 3) & 1, p.has("RW") && p.has("N") ? 1U : 0U) << index << ": and of the stored one";
      EXPECT_EQ((word >> 4) & 1, p.has("N") ? 1U : 0U) << index << ": valid after power-on";
      EXPECT_EQ((word >> 5) & 1, p.has("R") ? 0U : 1U) << index;
      index = static_cast<uint16_t>(word >> 16);
    }
    EXPECT_EQ(index, 0) << "the last index has no next one";
  }
}

// All 65536 indices with each read service: a value, or 10h outside the areas, or 11h inside.
TEST(ServicesSweep, EveryIndex) {
  PROVES("PAR-07", "PAR-15", "M07-PAR-16");
  for (const UnitLists& unit : kUnits) {
    const stdlib::UnitType& type = tests::unit(unit.unit);
    const auto list = tests::listed(unit.files, unit.option_cards);
    const IndexAreas areas = index_areas(unit);
    const ParameterStore fresh(type);
    ParameterStore store = fresh;
    for (int index = 0; index <= 0xFFFF; ++index) {
      const bool inside = IndexAreas::any(areas.windows, index) || IndexAreas::any(areas.parameters, index);
      const ParameterReply reply = store.execute(ParameterService::Read, static_cast<uint16_t>(index));
      const uint32_t want = list.count(static_cast<uint16_t>(index)) ? kOk : refusal(inside ? 0x11 : 0x10);
      ASSERT_EQ(reply ? kOk : reply.error().packed(), want) << unit.unit << " index " << index;
    }
  }
}

}  // namespace
}  // namespace ipos::runtime
