// What a unit keeps, when it is stored, and what it answers when it cannot be.
#include "runtime/nv_memory/kept/unit_memory.hpp"

#include <gtest/gtest.h>

#include "runtime/drive/error_memory.hpp"
#include "tests/harness/proves.hpp"
#include "tests/runtime/nv_memory/fake_medium.hpp"

namespace ipos::runtime {
namespace {

namespace codes = stdlib::return_codes;
using stdlib::ReturnCode;
using tests::FakeMedium;
using tests::MediumState;

constexpr auto kRead = ParameterService::Read;
constexpr auto kWrite = ParameterService::Write;
constexpr auto kVolatile = ParameterService::WriteVolatile;

ReturnCode refused(const ParameterReply& reply) { return reply ? codes::kNoError : reply.error(); }

using Indices = std::initializer_list<uint16_t>;

struct Unit {
  explicit Unit(std::shared_ptr<MediumState> state = nullptr, std::string_view name = "md60a")
      : parameters(*stdlib::find_unit(name)), memory(parameters) {
    if (state) refusal = memory.open(std::make_unique<FakeMedium>(std::move(state)), "unit1.nv");
  }
  ParameterReply ask(ParameterService service, uint16_t index, int32_t value = 0) {
    return parameters.execute(service, index, value);
  }
  std::vector<std::string> told() {
    std::vector<std::string> texts;
    for (const UnitMemory::Message& message : memory.take_messages()) texts.push_back(message.text);
    return texts;
  }
  ParameterStore parameters;
  UnitMemory memory;
  std::optional<std::string> refusal;
};

class Memory : public ::testing::Test {
 protected:
  std::shared_ptr<MediumState> state_ = std::make_shared<MediumState>();
};

TEST_F(Memory, AnAnsweredWriteIsOnTheMedium) {
  Unit unit(state_);
  ASSERT_EQ(unit.ask(kWrite, 8470, 2500), 2500);
  ASSERT_EQ(unit.ask(kVolatile, 8471, 2500), 2500);
  // Nothing else happens to `unit`: the power fails.
  Unit found(state_);
  EXPECT_EQ(found.ask(kRead, 8470), 2500);
  EXPECT_EQ(found.ask(kRead, 8471), 2000);
  EXPECT_EQ(found.parameters.eeprom_writes(8470), 1U);
  EXPECT_EQ(found.parameters.eeprom_writes(8471), 0U);
}

TEST_F(Memory, VariablesAndCurvePoints) {
  Unit unit(state_);
  for (const uint16_t index : Indices{11000, 11127, 20000, 20512}) {
    EXPECT_EQ(unit.ask(kWrite, index, index + 1), index + 1);
    EXPECT_EQ(unit.parameters.eeprom_writes(index), 1U) << index;
  }
  EXPECT_EQ(unit.ask(kWrite, 11128, 5), 5) << "can be written, is not kept";
  EXPECT_EQ(unit.ask(kVolatile, 11001, 6), 6);
  EXPECT_EQ(unit.ask(kVolatile, 20001, 7), 7);
  EXPECT_EQ(unit.parameters.eeprom_writes(11128), 0U);
  EXPECT_EQ(unit.ask(kRead, 20001), 7);
  Unit found(state_);
  for (const uint16_t index : Indices{11000, 11127, 20000, 20512})
    EXPECT_EQ(found.ask(kRead, index), index + 1);
  for (const uint16_t index : Indices{11128, 11001, 20001, 20511})
    EXPECT_EQ(found.ask(kRead, index), 0) << index;
  EXPECT_EQ(refused(found.ask(kRead, 20513)), codes::kInvalidIndex);
  // The attributes say so: bit 1 stored, bit 4 restored at power-on.
  EXPECT_EQ(*found.ask(ParameterService::ReadAttribute, 11127) & 0x12, 0x12);
  EXPECT_EQ(*found.ask(ParameterService::ReadAttribute, 11128) & 0x12, 0);
  EXPECT_EQ(*found.ask(ParameterService::ReadAttribute, 20512) & 0x12, 0x12);
}

TEST_F(Memory, WhatTheDriveChangesIsStoredAtTheEndOfTheMillisecond) {
  Unit unit(state_);
  unit.parameters.set_display(8328, 61);
  remember_fault(unit.parameters, 10, 0);
  EXPECT_TRUE(state_->writes.empty());
  unit.memory.tick(kMillisecond);
  EXPECT_EQ(state_->writes.size(), 3U) << "one commit for all, and the magic";
  unit.memory.tick(2 * kMillisecond);
  EXPECT_EQ(state_->writes.size(), 3U) << "nothing has changed";
  unit.parameters.set_display(8318, 1000);  // a display value that is not kept
  unit.memory.tick(3 * kMillisecond);
  EXPECT_EQ(state_->writes.size(), 3U);
  Unit found(state_);
  EXPECT_EQ(found.ask(kRead, 8328), 61);
  EXPECT_EQ(found.ask(kRead, 8366), 10);
  EXPECT_EQ(found.ask(kRead, 8426), 61) << "mains-on time of t-0";
}

TEST_F(Memory, FactorySettingIsStored) {
  Unit unit(state_);
  unit.ask(kWrite, 8470, 2500);
  unit.ask(kWrite, 8594, 1);
  unit.parameters.finish_factory_setting();
  EXPECT_EQ(Unit(state_).ask(kRead, 8470), 2500) << "not yet stored";
  unit.memory.tick(kMillisecond);
  EXPECT_EQ(Unit(state_).ask(kRead, 8470), 2000);
}

TEST_F(Memory, AWriteThatCannotBeStoredIsRefused) {
  PROVES("M07-PAR-13");
  Unit unit(state_, "mc07");
  ASSERT_EQ(unit.ask(kWrite, 8602, 50), 50);
  state_->room = 100;
  EXPECT_EQ(refused(unit.ask(kWrite, 8602, 100)), codes::kNotSaved);
  EXPECT_EQ(unit.ask(kRead, 8602), 100) << "the working value";
  EXPECT_EQ(refused(unit.ask(kWrite, 11000, 5)), codes::kNotSaved);
  EXPECT_EQ(unit.told().front(), "unit1.nv: not stored: no space left");
  EXPECT_EQ(Unit(state_, "mc07").ask(kRead, 8602), 50);
  state_->room = -1;
  EXPECT_EQ(unit.ask(kWrite, 8470 + 337, 100), 100);
  EXPECT_EQ(Unit(state_, "mc07").ask(kRead, 8602), 50) << "what was refused is not stored later";
  EXPECT_EQ(Unit(state_, "mc07").ask(kRead, 11000), 0);

  // The other codes of the row, by their printed numbers. No drive has a reason for 18.
  EXPECT_EQ(codes::kNotSaved.packed(), 0x0800001FU);
  unit.parameters.inject(codes::kSystemError);
  EXPECT_EQ(refused(unit.ask(kWrite, 8602, 60)).packed(), 0x08000018U);
  unit.parameters.inject(std::nullopt);
  EXPECT_EQ(unit.ask(kRead, 8602), 100) << "not carried out";
  EXPECT_EQ(refused(unit.ask(kWrite, 8602, 5)).packed(), 0x0800001DU);
  struct Drive final : DriveLink {
    std::optional<int32_t> live_value(uint16_t) const override { return std::nullopt; }
    bool controller_inhibited() const override { return !running; }
    bool output_stage_on() const override { return running; }
    void on_parameter_written(uint16_t, int32_t) override {}
    bool running = true;
  } drive;
  unit.parameters.connect(drive);
  EXPECT_EQ(refused(unit.ask(kWrite, 8461, 2)).packed(), 0x0800001CU);
  EXPECT_EQ(refused(unit.ask(kWrite, 8523, 0)).packed(), 0x08000020U);
}

TEST_F(Memory, CommitsThatFailAreRepeated) {
  Unit unit(state_);
  state_->sync_fails = true;
  unit.parameters.set_display(8328, 61);
  unit.memory.tick(kMillisecond);
  EXPECT_EQ(unit.told().size(), 1U);
  unit.memory.tick(2 * kMillisecond);
  EXPECT_TRUE(unit.told().empty()) << "not every millisecond";
  EXPECT_FALSE(unit.memory.commit()) << "but at power-off";
  state_->sync_fails = false;
  EXPECT_TRUE(unit.memory.commit());
  EXPECT_EQ(Unit(state_).ask(kRead, 8328), 61);
}

TEST_F(Memory, ForeignAndUnreadableFilesAreRefused) {
  { EXPECT_EQ(*Unit(state_, "mc07").ask(kWrite, 8602, 50), 50); }
  const auto before = state_->bytes;
  Unit unit(state_);
  EXPECT_EQ(unit.refusal, "unit1.nv: the memory of unit type 3");
  unit.ask(kWrite, 8470, 2500);
  EXPECT_EQ(state_->bytes, before) << "it is left alone";
  state_->read_fails = true;
  EXPECT_EQ(Unit(state_).refusal, "unit1.nv: cannot be read: read error");
}

TEST_F(Memory, ADamagedFileGivesFactoryValuesAndAWarning) {
  { EXPECT_EQ(*Unit(state_).ask(kWrite, 8470, 2500), 2500); }
  state_->bytes[20] ^= 1;
  Unit unit(state_);
  EXPECT_EQ(unit.refusal, std::nullopt);
  EXPECT_EQ(unit.told(),
            std::vector<std::string>{"unit1.nv: no state in it is whole: slot 0 at byte 0: wrong "
                                     "checksum: the unit starts with factory values"});
  EXPECT_EQ(unit.ask(kRead, 8470), 2000);
  EXPECT_EQ(unit.memory.fault(), 94);
  unit.memory.tick(0);
  Unit next(state_);
  EXPECT_EQ(next.ask(kRead, 8470), 2000);
  EXPECT_EQ(next.memory.fault(), 0) << "a whole state is there again";
}

// F94 is the state of the memory at this power-on, not at one before.
TEST_F(Memory, TheFaultOfADamagedFileEndsWhenItIsWholeAgain) {
  { EXPECT_EQ(*Unit(state_).ask(kWrite, 8470, 2500), 2500); }
  state_->bytes[20] ^= 1;
  Unit unit(state_);
  ASSERT_EQ(unit.memory.fault(), 94);
  unit.memory.reload();
  EXPECT_EQ(unit.memory.fault(), 94) << "nothing has been stored";
  unit.memory.tick(0);
  unit.memory.reload();
  EXPECT_EQ(unit.memory.fault(), 0);
}

TEST_F(Memory, OneDamagedSlotIsNoFault) {
  {
    Unit unit(state_);
    unit.ask(kWrite, 8470, 2500);
    unit.ask(kWrite, 8470, 2600);
  }
  state_->bytes[kSlotStride + 20] ^= 1;  // the newer one
  Unit unit(state_);
  EXPECT_EQ(unit.memory.fault(), 0);
  EXPECT_EQ(unit.ask(kRead, 8470), 2500);
  EXPECT_EQ(unit.told(), std::vector<std::string>{
                             "unit1.nv: slot 1 at byte 131072: wrong checksum; the other slot is used"});
  state_->bytes[20] ^= 1;
  EXPECT_EQ(Unit(state_).memory.fault(), 94);
  EXPECT_EQ(Unit().memory.fault(), 0) << "kept for the run only";
}

TEST_F(Memory, UnreadableAtPowerOn) {
  Unit unit(state_);
  ASSERT_EQ(unit.ask(kWrite, 8470, 2500), 2500);
  state_->read_fails = true;
  unit.memory.reload();
  EXPECT_EQ(unit.memory.fault(), 25);
  EXPECT_EQ(unit.ask(kRead, 8470), 2000);
}

// A file of another release may hold what this one does not know.
TEST_F(Memory, ValuesTheUnitRefusesAreDropped) {
  {
    FakeMedium medium(state_);
    SlotStore store(medium, 1);
    store.load();
    NvContent content;
    content.values = {{8318, 5}, {8470, 2500}, {8600, 64}, {9999, 1}, {11200, 1}};
    ASSERT_EQ(store.save(content), std::nullopt);
  }
  Unit unit(state_);
  EXPECT_EQ(unit.ask(kRead, 8470), 2500);
  EXPECT_EQ(unit.ask(kRead, 8600), 0);
  const auto texts = unit.told();
  ASSERT_EQ(texts.size(), 4U);
  EXPECT_EQ(texts[1], "unit1.nv: holds a value of index 8600 that this unit refuses; it is dropped");
}

TEST_F(Memory, MemorizeStoresAndLoadsVariables) {
  Unit unit(state_);
  unit.ask(kVolatile, 11005, 7);
  ASSERT_TRUE(unit.memory.memorize(Memorize::Nothing));
  EXPECT_EQ(Unit(state_).ask(kRead, 11005), 0);
  ASSERT_TRUE(unit.memory.memorize(Memorize::StoreData));
  EXPECT_EQ(Unit(state_).ask(kRead, 11005), 7);
  EXPECT_EQ(unit.parameters.eeprom_writes(11005), 1U);
  EXPECT_EQ(unit.parameters.eeprom_writes(11006), 0U) << "it has not changed";
  unit.ask(kVolatile, 11005, 8);
  ASSERT_TRUE(unit.memory.memorize(Memorize::LoadAll));
  EXPECT_EQ(unit.ask(kRead, 11005), 7);
  unit.ask(kVolatile, 11005, 9);
  ASSERT_TRUE(unit.memory.memorize(Memorize::StoreProgram));
  EXPECT_EQ(Unit(state_).ask(kRead, 11005), 7) << "the program only";
  ASSERT_TRUE(unit.memory.memorize(Memorize::StoreAll));
  EXPECT_EQ(Unit(state_).ask(kRead, 11005), 9);
  unit.ask(kVolatile, 11005, 10);
  state_->room = 0;
  EXPECT_FALSE(unit.memory.memorize(Memorize::StoreData));
}

// A program word that was written volatile is kept by the orders for the program and for all, not by that for the data.
TEST_F(Memory, MemorizeStoresTheProgram) {
  for (const Memorize what : {Memorize::Nothing, Memorize::StoreAll, Memorize::LoadAll,
                              Memorize::StoreProgram, Memorize::StoreData}) {
    const auto state = std::make_shared<MediumState>();
    Unit unit(state);
    unit.memory.program().restart(std::vector<uint32_t>{1, 2});
    EXPECT_EQ(unit.ask(kVolatile, 16007, 0xEE), 0xEE);
    EXPECT_TRUE(unit.memory.memorize(what));
    unit.memory.tick(kMillisecond);
    const bool kept = what == Memorize::StoreAll || what == Memorize::StoreProgram;
    EXPECT_EQ(unit.memory.program().kept().has_value(), kept) << static_cast<int>(what);
    EXPECT_EQ(Unit(state).memory.program().kept(), unit.memory.program().kept()) << static_cast<int>(what);
  }
}

// 10 writes of one index within a minute count as cyclic (ours).
TEST(Wear, CyclicWritesAreWarnedOfOnce) {
  Unit unit;
  for (int n = 0; n < 9; ++n) {
    unit.memory.set_time(n * 500 * kMillisecond);
    unit.ask(kWrite, 8470, 1000 + 100 * n);
    unit.ask(kVolatile, 8471, 1000 + 100 * n);
  }
  EXPECT_TRUE(unit.told().empty());
  unit.memory.set_time(4500 * kMillisecond);
  unit.ask(kWrite, 8470, 2000);
  EXPECT_EQ(
      unit.told(),
      std::vector<std::string>{
          "P130 Ramp t11 UP CW was stored 10 times within 4.500 s: the memory lasts about 100000 writes, "
          "at this rate 13.8 h; cyclic values belong into service 3, write volatile"});
  unit.memory.set_time(5000 * kMillisecond);
  unit.ask(kWrite, 8470, 2500);
  EXPECT_TRUE(unit.told().empty()) << "once";
  EXPECT_EQ(unit.parameters.eeprom_writes(8470), 11U);
}

// A program that stores in a loop wears the memory, too; what has not changed does not.
TEST(Wear, MemorizeIsWarnedOf) {
  for (const Memorize what : {Memorize::StoreData, Memorize::StoreAll}) {
    Unit unit;
    for (int n = 1; n <= 10; ++n) {
      EXPECT_TRUE(unit.told().empty()) << n;
      unit.memory.set_time(n * kSecond);
      unit.ask(kVolatile, 11005, n);
      ASSERT_TRUE(unit.memory.memorize(what));
    }
    const std::vector<std::string> told = unit.told();
    ASSERT_EQ(told.size(), 1U) << static_cast<int>(what);
    EXPECT_NE(told[0].find("H5 was stored 10 times within 9.000 s"), std::string::npos) << told[0];
  }
}

// 100 000 writes of the life: every 20 min they are gone after 3.8 years, at two a minute after 34.7 days.
TEST(Wear, LifeOfTheMemory) {
  PROVES("M07-SCOM-11");
  constexpr Time kMinute = 60 * kSecond;
  EXPECT_EQ(memory_life(20 * kMinute), "3.8 years");
  EXPECT_EQ(memory_life(kMinute / 2), "34.7 days");
  EXPECT_EQ(memory_life(kSecond / 2), "13.8 h");
  Unit unit(nullptr, "mc07");
  for (int n = 0; n <= 10; ++n) {
    unit.memory.set_time(n * kMinute / 2);
    unit.ask(kWrite, 8602, 10 * n);
  }
  unit.memory.set_time(5 * kMinute);
  unit.ask(kWrite, 8470 + 337, 100);
  unit.memory.set_time(25 * kMinute);
  unit.ask(kWrite, 8470 + 337, 200);
  unit.ask(kWrite, 8461, 2);  // once
  unit.told();
  unit.memory.report_wear();
  EXPECT_EQ(
      unit.told(),
      (std::vector<std::string>{
          "P815 SBus timeout delay was stored 11 times, every 30.000 s on average: at this rate the memory "
          "lasts 34.7 days",
          "P130 Ramp t11 UP CW was stored 2 times, every 1200.000 s on average: at this rate the memory "
          "lasts "
          "3.8 years"}));
  // The counter of the unit's life, which the memory carries on.
  unit.parameters.restore_writes({{8602, kEepromLife - 2}});
  unit.memory.set_time(60 * kMinute);
  unit.ask(kWrite, 8602, 500);
  EXPECT_TRUE(unit.told().empty());
  unit.memory.set_time(90 * kMinute);
  unit.ask(kWrite, 8602, 510);
  EXPECT_EQ(unit.told(), std::vector<std::string>{"P815 SBus timeout delay has been stored 100000 times: the "
                                                  "non-volatile memory may be worn out"});
}

TEST(Wear, SlowWritesAreNot) {
  WearWatch watch;
  for (uint32_t n = 0; n < 100; ++n)
    EXPECT_EQ(watch.note(n * 7 * kSecond, 8470, n, "P130"), std::nullopt) << "9 in a minute";
  for (uint32_t n = 0; n < 9; ++n) EXPECT_EQ(watch.note(700 * kSecond, 8471, n, "P131"), std::nullopt);
  EXPECT_NE(watch.note(760 * kSecond, 8471, 9, "P131"), std::nullopt) << "the tenth within 60 s";
  EXPECT_EQ(watch.note(2000 * kSecond, 8470, kEepromLife, "P130"),
            "P130 has been stored 100000 times: the non-volatile memory may be worn out");
}

// From two years, two days and one hour on the next greater unit is used; a year has 365.25 days.
TEST(Wear, UnitsOfTheLife) {
  constexpr Time kYear = 36'525 * (24 * 3'600 * (kSecond / 100));  // 365.25 days
  const auto life = [](Time span) { return memory_life(span / kEepromLife); };
  EXPECT_EQ(life(2 * kYear), "2.0 years");
  EXPECT_EQ(life(2 * kYear - kSecond), "730.4 days");
  EXPECT_EQ(life(48 * 3'600 * kSecond), "2.0 days");
  EXPECT_EQ(life(48 * 3'600 * kSecond - kSecond), "47.9 h");
  EXPECT_EQ(life(3'600 * kSecond), "1.0 h");
  EXPECT_EQ(life(3'599 * kSecond), "3599 s");
  EXPECT_EQ(life(100 * kYear - kSecond), "99.9 years");
  EXPECT_EQ(life(kSecond - 1), "0 s");
}

// Ten writes in one moment count as a millisecond, so the life is that of one write every ninth of it: 11 s.
TEST(Wear, WritesOfOneMoment) {
  WearWatch watch;
  std::optional<std::string> told;
  for (uint32_t n = 1; n <= 10; ++n) {
    EXPECT_EQ(told, std::nullopt);
    told = watch.note(5 * kSecond, 8470, n, "P130");
  }
  EXPECT_EQ(told,
            "P130 was stored 10 times within 0.001 s: the memory lasts about 100000 writes, at this rate 11 "
            "s; cyclic "
            "values belong into service 3, write volatile");
}

// Nine steps of 6.666 s: the memory lasts 100 000 of them, 7.7 days.
TEST(Wear, SpansAreToldInMilliseconds) {
  WearWatch watch;
  std::optional<std::string> told;
  for (uint32_t n = 1; n <= 10; ++n) told = watch.note(n * 6'666 * kMillisecond, 8470, n, "P130");
  ASSERT_TRUE(told.has_value());
  EXPECT_NE(told->find("within 59.994 s: "), std::string::npos) << *told;
  EXPECT_NE(told->find("at this rate 7.7 days; "), std::string::npos) << *told;
}

// The last ten count, wherever in the row of all writes they are.
TEST(Wear, TheLastTenWritesCount) {
  for (const uint32_t slow : std::initializer_list<uint32_t>{1, 5, 9, 10, 13, 27}) {
    WearWatch watch;
    Time now = 0;
    for (uint32_t n = 1; n <= slow; ++n)
      EXPECT_EQ(watch.note(now += 3'600 * kSecond, 8470, n, "P130"), std::nullopt);
    // Nine more make ten with the last slow one: from it 60 s and a nanosecond are too long, 60 s are not.
    for (const Time late : std::initializer_list<Time>{1, 0}) {
      WearWatch copy = watch;
      for (uint32_t n = 1; n <= 8; ++n)
        EXPECT_EQ(copy.note(now + n * kSecond, 8470, slow + n, "P130"), std::nullopt) << slow;
      EXPECT_EQ(copy.note(now + 60 * kSecond + late, 8470, slow + 9, "P130").has_value(), late == 0) << slow;
    }
  }
}

TEST(Wear, UsesAreCountedFromTheFirstToTheLast) {
  WearWatch watch;
  for (uint32_t n = 0; n < 25; ++n) watch.note((n * n + 100) * kSecond, 8470, n, "P130");
  watch.note(7 * kSecond, 8471, 1, "P131");  // once
  watch.note(7 * kSecond, 8469, 1, "P132");
  watch.note(10 * kSecond, 8469, 2, "P132");
  const auto uses = watch.uses();
  ASSERT_EQ(uses.size(), 2U);
  EXPECT_EQ(uses[0].index, 8469);
  EXPECT_EQ(uses[0].writes, 2U);
  EXPECT_EQ(uses[0].interval, 3 * kSecond);
  EXPECT_EQ(uses[1].index, 8470);
  EXPECT_EQ(uses[1].writes, 25U);
  EXPECT_EQ(uses[1].interval, 24 * kSecond) << "24 * 24 s in 24 steps";
}

TEST(Wear, IntervalsAreToldInMilliseconds) {
  Unit unit;
  unit.ask(kWrite, 8470, 1000);
  unit.memory.set_time(7'045 * kMillisecond);
  unit.ask(kWrite, 8470, 1100);
  unit.memory.report_wear();
  // 704 500 s are 8.15 days.
  EXPECT_EQ(unit.told(), std::vector<std::string>{
                             "P130 Ramp t11 UP CW was stored 2 times, every 7.045 s on average: at this rate "
                             "the memory lasts 8.1 days"});
}

}  // namespace
}  // namespace ipos::runtime
