// Single rules of the parameter services, with figures from the manuals.
#include "runtime/drive/parameters.hpp"

#include <gtest/gtest.h>

#include "runtime/drive/drive.hpp"
#include "tests/harness/proves.hpp"
#include "tests/runtime/drive/drive_rig.hpp"
#include "tests/runtime/drive/service_rules.hpp"

namespace ipos::runtime {
namespace {

namespace codes = stdlib::return_codes;
using stdlib::ReturnCode;

constexpr auto kRead = ParameterService::Read;
constexpr auto kWrite = ParameterService::Write;
constexpr auto kVolatile = ParameterService::WriteVolatile;
constexpr auto kDefault = ParameterService::ReadDefault;

ReturnCode refused(const ParameterReply& reply) { return reply ? codes::kNoError : reply.error(); }

class Md60a : public ::testing::Test {
 protected:
  Md60a() { store.connect(drive); }
  int32_t ask(ParameterService service, uint16_t index, int32_t value = 0) {
    const ParameterReply reply = store.execute(service, index, value);
    EXPECT_TRUE(reply) << index << ": " << stdlib::return_code_meaning(refused(reply));
    return reply.value_or(-1);
  }
  tests::FakeDrive drive;
  ParameterStore store{tests::unit("md60a")};
};

TEST_F(Md60a, WriteSurvivesPowerOffVolatileWriteDoesNot) {
  PROVES("PAR-02");
  ask(kWrite, 8470, 2500);
  store.power_cycle();
  EXPECT_EQ(ask(kRead, 8470), 2500);
  ask(kWrite, 8470, 2000);
  ask(kVolatile, 8470, 3000);
  EXPECT_EQ(ask(kRead, 8470), 3000);
  store.power_cycle();
  EXPECT_EQ(ask(kRead, 8470), 2000);
}

TEST_F(Md60a, EepromWritesAreCounted) {
  for (int32_t i = 0; i < 5; ++i) ask(kWrite, 8470, 1000 + 100 * i);
  for (int32_t i = 0; i < 5; ++i) ask(kVolatile, 8470, 1000 + 100 * i);
  EXPECT_EQ(store.eeprom_writes(8470), 5U);
  EXPECT_EQ(store.eeprom_writes(8471), 0U);
  EXPECT_EQ(store.eeprom_writes(9999), 0U);
}

TEST_F(Md60a, CountersSurviveDisplaysDoNot) {
  PROVES("PAR-10");  // the letters: ParameterTable.AccessLetters
  store.set_display(8328, 77);
  store.set_display(8318, 1000000);
  store.power_cycle();
  EXPECT_EQ(ask(kRead, 8328), 77);
  EXPECT_EQ(ask(kRead, 8318), 0);
}

TEST_F(Md60a, PrintedDefaultsAndLimits) {
  PROVES("PAR-32", "PAR-31", "PAR-30", "PAR-35", "PAR-34");
  for (const PrintedRow& row : kPrintedRows) {
    EXPECT_EQ(ask(kRead, row.index), row.default_value) << row.index;
    EXPECT_EQ(ask(kDefault, row.index), row.default_value) << row.index;
    EXPECT_EQ(ask(ParameterService::ReadMinimum, row.index), row.minimum) << row.index;
    EXPECT_EQ(ask(ParameterService::ReadMaximum, row.index), row.maximum) << row.index;
    EXPECT_EQ(refused(store.execute(kWrite, row.index, row.maximum + 1)), codes::kTooLarge) << row.index;
  }
  EXPECT_EQ(refused(store.execute(kWrite, 8602, 105)), codes::kIncorrectValue);
  ask(kWrite, 8602, 110);
  for (int32_t code = 0; code <= 7; ++code) ask(kWrite, 8609, code);
  for (int32_t code = 0; code <= 12; ++code) ask(kWrite, 8304, code);
  for (int32_t code = 0; code <= 11; ++code) ask(kWrite, 8307, code);
  for (int32_t code = 0; code <= 10; ++code) ask(kWrite, 8461, code);
  for (int32_t code = 0; code <= 3; ++code) ask(kWrite, 8462, code);
}

TEST_F(Md60a, GridOfTheRamp) {
  EXPECT_EQ(refused(store.execute(kWrite, 8470, 1005)), codes::kIncorrectValue);
  for (const int32_t value : {1000, 1100, 11000, 110000}) EXPECT_EQ(ask(kWrite, 8470, value), value);
  // The sync identifier is coded times 1000 (1053 1610 p. 81).
  EXPECT_EQ(ask(kWrite, 8604, 128000), 128000);
  EXPECT_EQ(refused(store.execute(kWrite, 8604, 128500)), codes::kIncorrectValue);
  EXPECT_EQ(store.value(8604), 128000);
}

TEST_F(Md60a, UnsignedParameters) {
  const auto bits = [](uint32_t value) { return static_cast<int32_t>(value); };
  EXPECT_EQ(ask(kWrite, 8502, bits(3'999'999'999U)), bits(3'999'999'999U));
  EXPECT_EQ(refused(store.execute(kWrite, 8502, bits(4'000'000'000U))), codes::kTooLarge);
  EXPECT_EQ(refused(store.execute(kWrite, 8502, -1)), codes::kTooLarge);
  EXPECT_EQ(refused(store.execute(kWrite, 8502, 0)), codes::kTooSmall);
}

TEST_F(Md60a, GapBetweenTwoRanges) {
  EXPECT_EQ(refused(store.execute(kWrite, 8505, 0)), codes::kIncorrectValue);  // -99999999..-10, 10..99999999
  EXPECT_EQ(ask(kWrite, 8505, -10), -10);
}

TEST_F(Md60a, InhibitLockAndOutputStage) {
  drive.inhibited = false;
  EXPECT_EQ(refused(store.execute(kWrite, 8461, 10)), codes::kInhibitRequired);
  EXPECT_EQ(store.value(8461), 0);
  drive.inhibited = true;
  EXPECT_EQ(ask(kWrite, 8461, 10), 10);

  ask(kWrite, 8595, 1);
  EXPECT_EQ(refused(store.execute(kWrite, 8470, 2500)), codes::kParameterLock);
  for (const uint16_t index : std::initializer_list<uint16_t>{8622, 8606, 8617, 8453, 8454})
    ask(kWrite, index, 0);
  EXPECT_EQ(store.explain(2, 8470, 2500, codes::kParameterLock),
            "P130 Ramp t11 UP CW := 2.500 s: parameter lock is active (P803 = ON)");
  ask(kWrite, 8595, 0);
  ask(kWrite, 8470, 2500);

  drive.stage_on = true;
  EXPECT_EQ(refused(store.execute(kWrite, 8523, 0)), codes::kOutputStageEnabled);
}

TEST_F(Md60a, LeadingRowsServeTheirViews) {
  PROVES("PAR-27");
  const auto& table = store.table();
  for (const auto& [view, setting, count] :
       {std::tuple{31, 600, 5}, std::tuple{40, 610, 8}, std::tuple{51, 620, 2}, std::tuple{60, 630, 8}})
    for (int i = 0; i < count; ++i) {
      const auto* shown = table.find("P0" + std::to_string(view + i));
      const auto* set = table.find("P" + std::to_string(setting + i));
      ASSERT_TRUE(shown && set) << setting + i;
      EXPECT_EQ(shown->index, set->index);
      ask(kWrite, set->index, 0);
      EXPECT_EQ(ask(kRead, shown->index), 0);
    }
  EXPECT_EQ(ask(kWrite, table.find("P600")->index, 9), 9);
  EXPECT_EQ(ask(kRead, table.find("P031")->index), 9);
}

TEST_F(Md60a, DoubtfulRows) {
  PROVES("PAR-29");
  EXPECT_EQ(ask(kDefault, 8891), 0);
  EXPECT_EQ(refused(store.execute(kRead, 8840)), codes::kNotImplemented);
  EXPECT_EQ(refused(store.execute(kWrite, 8334, 1)), codes::kReadOnly);
  EXPECT_EQ(ask(kDefault, 8772), 0x696D2F31);  // "1/mi"
}

TEST_F(Md60a, OptionsOfUnits) {
  EXPECT_EQ(ask(kDefault, 8509), 10000);
  ParameterStore compact(tests::unit("compact"));
  EXPECT_EQ(refused(compact.execute(kRead, 8509)), codes::kNotImplemented);
  ParameterStore bare(tests::unit("md60a"), {.drs = false});
  EXPECT_EQ(refused(bare.execute(kWrite, 8502, 1)), codes::kOptionMissing);
  EXPECT_TRUE(bare.execute(kRead, 8502));
}

TEST_F(Md60a, FactorySetting) {
  ask(kWrite, 8470, 2500);
  ask(kWrite, 8600, 5);
  store.set_display(8328, 77);
  ask(kWrite, 8594, 1);
  EXPECT_TRUE(store.factory_setting_running());
  EXPECT_EQ(refused(store.execute(kWrite, 8470, 3000)), codes::kFactorySetting);
  EXPECT_EQ(refused(store.execute(kWrite, 8594, 1)), codes::kFactorySettingStarted);
  EXPECT_EQ(ask(kRead, 8470), 2500);
  store.finish_factory_setting();
  EXPECT_FALSE(store.factory_setting_running());
  for (const stdlib::Parameter* p : store.table().by_index())
    EXPECT_TRUE(!p->writable || store.value(p->index) == static_cast<int32_t>(p->default_value)) << p->index;
  EXPECT_EQ(store.value(8328), 77);
  store.power_cycle();
  EXPECT_EQ(store.value(8600), 0) << "the EEPROM has the factory setting too";
}

// It ends with the power: what the unit had is there again, and nothing is set back later.
TEST_F(Md60a, FactorySettingEndsWithThePower) {
  ask(kWrite, 8470, 2500);
  ask(kWrite, 8594, 1);
  store.power_cycle();
  EXPECT_FALSE(store.factory_setting_running());
  EXPECT_EQ(ask(kRead, 8470), 2500);
  EXPECT_EQ(ask(kWrite, 8470, 3000), 3000) << "parameters can be written";

  tests::DriveRig rig("md60a");
  rig.set("P130", 2500);
  ASSERT_EQ(rig.write("P802", 1), 0);
  rig.run_ms(1'000);
  rig.parameters.power_cycle();
  rig.drive.power_cycle();
  rig.run_ms(5'000);
  EXPECT_EQ(rig.value("P130"), 2500);
}

// P802 writes what differs, once; what has its factory value already is not worn.
TEST_F(Md60a, FactorySettingWearsOnlyWhatItChanges) {
  ask(kWrite, 8470, 2500);
  ask(kWrite, 8600, 5);
  ask(kWrite, 8601, 7);
  ask(kWrite, 8601, 0);  // back again
  const auto before = store.eeprom_writes();
  ask(kWrite, 8594, 1);
  store.finish_factory_setting();
  for (const stdlib::Parameter* p : store.table().by_index()) {
    const auto found = before.find(p->index);
    const uint32_t was = found == before.end() ? 0 : found->second;
    if (p->index == 8594) continue;  // the order itself
    EXPECT_EQ(store.eeprom_writes(p->index), was + (p->index == 8470 || p->index == 8600 ? 1 : 0))
        << p->index;
  }
}

// Displays that are kept (counters, error memory) have what the drive once counted: no range of a setting holds
// for them. A setting out of its range is dropped.
TEST_F(Md60a, WhatWasKeptComesBack) {
  size_t displays = 0, settings = 0;
  for (const stdlib::Parameter* p : store.table().by_index()) {
    if (!p->nonvolatile) continue;
    for (const int32_t value : {INT32_MIN, -1, 0, INT32_MAX}) {
      const std::pair<uint16_t, int32_t> kept[] = {{p->index, value}};
      const std::vector<uint16_t> dropped = store.restore(kept);
      const bool fits = p->number_of(value) >= p->minimum() && p->number_of(value) <= p->maximum();
      if (!p->writable) {
        EXPECT_TRUE(dropped.empty()) << p->index;
        EXPECT_EQ(store.value(p->index), value) << p->index;
        displays += !fits;
      } else if (!fits) {
        EXPECT_EQ(dropped, std::vector<uint16_t>{p->index});
        EXPECT_EQ(store.value(p->index), static_cast<int32_t>(p->default_value)) << p->index;
        ++settings;
      }
    }
  }
  EXPECT_GT(displays, 0U);
  EXPECT_GT(settings, 100U);
}

TEST_F(Md60a, ResetStatistics) {
  store.set_display(8330, 5);
  store.set_display(8328, 6);
  store.set_display(8329, 7);
  ask(kWrite, 8596, 2);
  EXPECT_EQ(ask(kRead, 8330), 0);
  EXPECT_EQ(ask(kRead, 8328), 6);
  ask(kWrite, 8596, 3);
  EXPECT_EQ(ask(kRead, 8328), 0);
  EXPECT_EQ(ask(kRead, 8329), 0);
  EXPECT_EQ(ask(kRead, 8596), 0) << "an order, not a setting";
}

// Areas that exist and hold nothing here are refused by name (docs/reference/limits.md).
TEST_F(Md60a, AreasThatAreNotSimulated) {
  struct Area {
    uint16_t first, count;
    std::string name;
  };
  for (const Area& area : {Area{10'000, 100, "error response "}, {10'300, 40, "motor current "}, {10'600, 40, "motor flux "}})
    for (const int n : {0, area.count - 1}) {
      const auto index = static_cast<uint16_t>(area.first + n);
      for (const auto service : {kRead, kWrite, kVolatile}) {
        const ParameterReply reply = store.execute(service, index, 1);
        ASSERT_EQ(refused(reply), codes::kNotImplemented) << index;
        const std::string why = store.explain(static_cast<uint8_t>(service), index, 1, reply.error());
        EXPECT_TRUE(why.starts_with(area.name + std::to_string(n))) << why;
        EXPECT_NE(why.find("not simulated"), std::string::npos) << why;
      }
    }
}

TEST_F(Md60a, Windows) {
  tests::FakeWindow variables(512);
  tests::FakeWindow curve(513);
  store.plug(IndexArea::Variables, variables);
  store.plug(IndexArea::CurvePoints, curve);
  variables.words[20] = 0x11223344;
  EXPECT_EQ(ask(kRead, 11020), 0x11223344);
  ask(kWrite, 11511, -7);
  ask(kVolatile, 11000, 9);
  EXPECT_EQ(variables.words[511], -7);
  EXPECT_EQ(variables.words[0], 9);
  EXPECT_EQ(variables.stores, 1);
  EXPECT_EQ(refused(store.execute(kRead, 11512)), codes::kInvalidIndex);
  ask(kWrite, 20512, 5);
  EXPECT_EQ(ask(kRead, 20512), 5);
  EXPECT_EQ(ask(kRead, 20000), 0);
  EXPECT_EQ(refused(store.execute(kRead, 20513)), codes::kInvalidIndex);
  EXPECT_EQ(ask(ParameterService::ReadMinimum, 11000), INT32_MIN);
  EXPECT_EQ(ask(ParameterService::ReadMaximum, 11000), INT32_MAX);
  EXPECT_EQ(ask(kDefault, 11020), 0);
  EXPECT_EQ(ask(ParameterService::ReadAttribute, 11000) >> 16, 11001);
  EXPECT_EQ(ask(ParameterService::ReadAttribute, 11511) >> 16, 0);
  // Bits 0 writable, 1 stored, 4 valid after power-on, 5 needs no inhibit.
  EXPECT_EQ(ask(ParameterService::ReadAttribute, 11127) & 0xFFFF, 0b110011);
  EXPECT_EQ(ask(ParameterService::ReadAttribute, 11128) & 0xFFFF, 0b100001);
  EXPECT_EQ(refused(store.execute(kRead, 16000)), codes::kNotImplemented);  // nothing plugged in
  // The lock is about parameters, not about variables; the factory setting stops both.
  ask(kWrite, 8595, 1);
  ask(kWrite, 11001, 1);
  ask(kWrite, 8595, 0);
  ask(kWrite, 8594, 1);
  EXPECT_EQ(refused(store.execute(kWrite, 11001, 2)), codes::kFactorySetting);
}

TEST_F(Md60a, Presets) {
  drive.inhibited = false;
  EXPECT_EQ(store.preset(8461, 10), 10);  // needs no inhibit before power-on
  EXPECT_EQ(refused(store.preset(8600, 64)), codes::kTooLarge);
  EXPECT_EQ(refused(store.preset(8318, 1)), codes::kReadOnly);
  EXPECT_EQ(refused(store.preset(9500, 1)), codes::kInvalidIndex);
  store.power_cycle();
  EXPECT_EQ(store.value(8461), 10);
}

TEST_F(Md60a, EffectsAreTold) {
  ask(kWrite, 8600, 3);
  ask(kVolatile, 8617, 1);
  EXPECT_EQ(drive.written, (std::vector<uint16_t>{8600, 8617}));
  store.execute(kWrite, 8600, 64);
  EXPECT_EQ(drive.written.size(), 2U);
  EXPECT_EQ(store.explain(2, 8600, 64, codes::kTooLarge),
            "P813 SBus address := 64: parameter value too large (0..63)");
  EXPECT_EQ(store.explain(1, 9500, 0, codes::kInvalidIndex), "index 9500: invalid parameter index");
  EXPECT_EQ(store.explain(1, 9500, 0, {8, 0, 0x99}), "index 9500: return code 08 00 00 99");
}

class Mc07 : public Md60a {
 protected:
  Mc07() { m07.connect(drive); }
  ParameterStore m07{tests::unit("mc07")};
};

TEST_F(Mc07, FreshUnit) {
  PROVES("M07-PD-15", "M07-PD-16", "M07-SETP-03", "M07-PAR-31", "M07-MON-02", "M07-PAR-29");
  const std::pair<uint16_t, int32_t> printed[] = {
      {8304, 9},      {8305, 1},       {8306, 0},      {8307, 6},       {8308, 1},
      {8309, 2},      {8489, 150000},  {8490, 750000}, {8491, 1500000}, {8492, 150000},
      {8493, 750000}, {8494, 1500000}, {8518, 150000}, {8523, 1},       {8524, 0},
      {8525, 0},      {8526, 100},     {8527, 0},      {8602, 0},       {8350, 1},
      {8351, 5},      {0x2267, 2000},  {0x2268, 2000}, {0x2269, 20000}, {8517, 1500000}};
  for (const auto& [index, value] : printed) EXPECT_EQ(m07.execute(kRead, index), value) << index;
  EXPECT_EQ(m07.execute(kDefault, 8517), 1500000);
  for (const uint16_t index : std::initializer_list<uint16_t>{0x2116, 0x2117, 0x2126})
    EXPECT_EQ(refused(m07.execute(kRead, index)), codes::kInvalidIndex) << index;
}

TEST_F(Mc07, Codes) {
  PROVES("M07-PD-12", "M07-PD-13", "M07-CW-27", "M07-SETP-01", "M07-PAR-28", "M07-PAR-33");
  const struct {
    uint16_t index;
    std::vector<int32_t> accepted, refused;
    int32_t fresh;
  } rows[] = {{8304, {0, 1, 5, 8, 9, 10, 11, 12, 13}, {2, 3, 4, 6, 7, 14}, 9},
              {8307, {0, 1, 2, 3, 6, 8, 9, 10}, {4, 5, 7, 11}, 6},
              {8462, {0, 1, 3, 4}, {2, 5}, 0},
              {8461, {1, 2, 4, 6, 7, 10, 11}, {0, 3, 5, 8, 9, 12}, 1},
              {8336, {0, 1, 2, 3, 4, 5, 6, 9, 10, 11, 12, 16, 20, 32}, {7, 26, 33}, 3},
              {8337, {}, {26}, 1},
              {8338, {}, {26}, 4},
              {8339, {26}, {27, 33}, 5},
              {8609, {2, 4}, {3}, 4},
              {8620, {0, 1, 2, 3}, {4}, 0},
              {8597, {0, 99}, {100}, 0},
              {8598, {100, 199}, {99, 200}, 100},
              {8599, {0, 650000}, {650010, 5}, 0}};
  for (const auto& row : rows) {
    EXPECT_EQ(m07.execute(kRead, row.index), row.fresh) << row.index;
    for (const int32_t code : row.accepted)
      EXPECT_EQ(m07.execute(kWrite, row.index, code), code) << row.index;
    for (const int32_t code : row.refused)
      EXPECT_FALSE(m07.execute(kWrite, row.index, code)) << row.index << " " << code;
  }
  EXPECT_EQ(refused(m07.execute(kWrite, 8609, 3)), codes::kIncorrectValue);
  EXPECT_EQ(stdlib::parameter_text(*m07.table().find("P860"), 2), "12 kHz");
}

TEST_F(Mc07, LogodriveCodes) {
  PROVES("M07-PD-14");
  ParameterStore standard(tests::unit("mc07"), {.logodrive = false});
  for (const auto& [index, code] : {std::pair{8304, 10}, {8305, 12}, {8307, 9}}) {
    EXPECT_TRUE(m07.execute(kWrite, static_cast<uint16_t>(index), code)) << index;
    EXPECT_EQ(refused(standard.execute(kWrite, static_cast<uint16_t>(index), code)), codes::kIncorrectValue)
        << index;
  }
}

TEST_F(Mc07, DisplaysAndKeypadSettings) {
  PROVES("M07-PAR-22", "M07-PAR-34");
  for (const auto& [index, conversion] : {std::pair{8318, 66},
                                          {8319, -3},
                                          {8321, -3},
                                          {8322, -3},
                                          {8325, -3},
                                          {8326, -3},
                                          {8327, 0},
                                          {8331, -3},
                                          {8301, 0},
                                          {8361, -3},
                                          {8300, 0}}) {
    const auto at = static_cast<uint16_t>(index);
    EXPECT_TRUE(m07.execute(kRead, at)) << index;
    EXPECT_EQ(refused(m07.execute(kWrite, at, 1)), codes::kReadOnly) << index;
    EXPECT_EQ(m07.table().find(at)->conversion, conversion) << index;
  }
  EXPECT_EQ(m07.execute(kRead, 8637), 0);
  for (const char* number : {"P931", "P932"}) {
    ASSERT_NE(m07.table().find(number), nullptr);
    EXPECT_EQ(m07.table().find(number)->index, 0) << "no index printed";
  }
  EXPECT_EQ(refused(m07.execute(kRead, 0)), codes::kInvalidIndex);
}

TEST_F(Mc07, AreasOfTheProgram) {
  tests::FakeWindow variables(512), program(1024);
  m07.plug(IndexArea::Variables, variables);
  m07.plug(IndexArea::Program, program);
  EXPECT_EQ(m07.execute(kWrite, 11020, 5), 5);
  EXPECT_EQ(variables.words[20], 5);
  EXPECT_EQ(refused(m07.execute(kRead, 11512)), codes::kInvalidIndex);
  program.words[0] = 0x1234;
  EXPECT_EQ(m07.execute(kRead, 16000), 0x1234);
  EXPECT_EQ(refused(m07.execute(kRead, 17024)), codes::kInvalidIndex);
}

TEST(Mdxb, HasMoreVariables) {
  ParameterStore store(tests::unit("mdxb"));
  tests::FakeWindow variables(1024);
  store.plug(IndexArea::Variables, variables);
  EXPECT_TRUE(store.execute(kWrite, 12023, 1));
  EXPECT_EQ(variables.words[1023], 1);
  EXPECT_EQ(refused(store.execute(kRead, 12024)), codes::kInvalidIndex);
  const uint16_t rate = store.table().find("P884")->index;
  for (int32_t code = 0; code <= 3; ++code) EXPECT_TRUE(store.execute(kWrite, rate, code));
  EXPECT_FALSE(store.execute(kWrite, rate, 4));
}

}  // namespace
}  // namespace ipos::runtime
