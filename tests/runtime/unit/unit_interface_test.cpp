// The drive of a unit as telegrams see it: why process data have no effect, told once for each bus, the slaves of
// master/slave operation, and the speed of the tasks.
#include "runtime/unit/unit_interface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "stdlib/unit_types.hpp"

namespace ipos::runtime {
namespace {

struct Served {
  explicit Served(const char* unit = "mdxb") : server(*stdlib::find_unit(std::string_view(unit))) {}
  void set(const char* number, int32_t value) {
    const auto refused = server.set_parameter(number, value);
    EXPECT_FALSE(refused) << refused.value_or("");
  }
  // How many of the reasons contain this.
  static size_t count(const std::vector<std::string>& reasons, std::string_view text) {
    return static_cast<size_t>(std::count_if(reasons.begin(), reasons.end(), [&](const std::string& reason) {
      return reason.find(text) != std::string::npos;
    }));
  }
  UnitInterface server;
};

constexpr uint16_t kEnable[] = {6, 1000, 0};

// A bus, and its codes in P100 and P101 (1053 1610 p. 72).
struct BusRow {
  const char* name;
  int32_t setpoint, control;
  std::function<void(UnitInterface&)> send;
};
std::vector<BusRow> bus_rows() {
  return {
      {"SBus", 10, 3, [](UnitInterface& s) { s.take_output(0, OutputChannel::Single, kEnable); }},
      {"SBus 2", 10, 3, [](UnitInterface& s) { s.take_sbus2(kEnable); }},
      {"RS-485", 2, 1, [](UnitInterface& s) { s.rs485_data().take_output(0, OutputChannel::Single, kEnable); }},
      {"fieldbus", 3, 2, [](UnitInterface& s) { s.take_fieldbus(kEnable); }}};
}

TEST(Obstacles, EverySettingThatKeepsProcessDataAway) {
  for (const BusRow& bus : bus_rows())
    for (const int32_t p100 : {0, 1, 2, 3, 10})
      for (const int32_t p101 : {0, 1, 2, 3})
        for (const int32_t p876 : {0, 1})
          for (const bool control_word : {false, true}) {
            SCOPED_TRACE(testing::Message() << bus.name << ", P100 " << p100 << ", P101 " << p101 << ", P876 "
                                            << p876 << ", control word " << control_word);
            Served unit;
            unit.set("100", p100);
            unit.set("101", p101);
            unit.set("876", p876);
            if (!control_word) unit.set("870", 1);
            EXPECT_FALSE(unit.server.has_reasons());
            bus.send(unit.server);
            bus.send(unit.server);
            const bool controls = p101 == bus.control, sets = p100 == bus.setpoint;
            EXPECT_EQ(unit.server.has_control_word(), control_word);
            EXPECT_EQ(unit.server.has_reasons(), p876 == 0 || !controls || !sets || !control_word);
            const auto told = unit.server.take_obstacles();
            EXPECT_EQ(Served::count(told, "PO data have no effect: P876"), p876 == 0 ? 1U : 0U);
            EXPECT_EQ(Served::count(told, "the control word has no effect: P101"), controls ? 0U : 1U);
            EXPECT_EQ(Served::count(told, "the setpoints have no effect: P100"), sets ? 0U : 1U);
            EXPECT_EQ(Served::count(told, "no PO word is a control word"),
                      controls && !control_word ? 1U : 0U);
            EXPECT_FALSE(unit.server.has_reasons());
            bus.send(unit.server);
            EXPECT_TRUE(unit.server.take_obstacles().empty()) << "each is told once";
          }
}

// SBus 1 and 2 have the same settings, so they tell once together; the others tell for themselves.
TEST(Obstacles, EachBusTellsItsOwn) {
  Served unit;
  std::vector<size_t> told;
  for (const BusRow& bus : bus_rows()) {
    unit.set("100", 1);
    unit.set("101", 0);
    bus.send(unit.server);
    told.push_back(unit.server.take_obstacles().size());
  }
  EXPECT_EQ(told, (std::vector<size_t>{2, 0, 2, 2}));
}

TEST(Obstacles, WhatIsWantedIsNamed) {
  Served unit;
  unit.set("101", 0);
  unit.set("100", 1);
  unit.server.take_fieldbus(kEnable);
  const auto told = unit.server.take_obstacles();
  ASSERT_EQ(told.size(), 2U);
  const auto text = [&](const char* number, int32_t value) {
    return stdlib::parameter_text(*unit.server.parameters().table().find(number), value);
  };
  EXPECT_NE(told[0].find(" is " + text("101", 0) + ", not " + text("101", 2)), std::string::npos) << told[0];
  EXPECT_NE(told[1].find(" is " + text("100", 1) + ", not " + text("100", 3)), std::string::npos) << told[1];
}

// MDX60B/61B p. 29: a slave has only parameters over its fieldbus card; what the group telegram of its master brings
// needs no P101.
TEST(Obstacles, OfASlave) {
  for (const int32_t master : {8, 9}) {
    Served unit;
    unit.set("100", master);
    unit.set("101", 0);
    EXPECT_TRUE(unit.server.is_slave());
    EXPECT_EQ(unit.server.follows_sbus_master(), master == 8);
    unit.server.take_fieldbus(kEnable);
    unit.server.take_fieldbus(kEnable);
    const auto told = unit.server.take_obstacles();
    ASSERT_EQ(told.size(), 1U);
    EXPECT_NE(told[0].find("slave of master/slave operation"), std::string::npos) << told[0];
    EXPECT_EQ(unit.server.state().po()[0], 0) << "and nothing is taken";
    unit.server.take_output(0, OutputChannel::Group, kEnable);
    EXPECT_EQ(unit.server.take_obstacles().empty(), master == 8);
  }
  Served free;
  EXPECT_FALSE(free.server.is_slave());
}

// P751 scales what a slave takes of its master (MDX60B/61B p. 29): over SBus the words of the group telegram alone.
TEST(Slaves, TakeTheirShareOfTheSetpoint) {
  for (const bool group : {false, true})
    for (const int32_t p100 : {8, 10}) {
      Served unit;
      unit.set("100", p100);
      unit.set("751", 2000);
      const uint16_t words[] = {6, 1000, 77};
      unit.server.take_output(0, group ? OutputChannel::Group : OutputChannel::Single, words);
      const bool scaled = group && p100 == 8;
      EXPECT_EQ(unit.server.state().po(), (DriveWords{6, static_cast<uint16_t>(scaled ? 2000 : 1000), 77}));
    }
  Served serial;
  serial.set("100", 9);
  serial.set("751", 500);
  serial.server.setpoint_received(0, {6, 1000, 77});
  EXPECT_EQ(serial.server.state().po(), (DriveWords{6, 500, 77}));
  serial.server.link_lost(0);
  EXPECT_EQ(serial.server.state().fault(), 43);
  EXPECT_TRUE(serial.server.state().error()) << "whatever P833 says (p. 30)";
}

TEST(Slaves, WhatTheSerialLineHasToKnow) {
  Served unit;
  unit.set("810", 17);
  unit.set("811", 133);
  unit.set("750", 3);
  unit.set("100", 9);
  const SerialParameters serial = unit.server.serial_parameters();
  EXPECT_EQ(serial.address, 17);
  EXPECT_EQ(serial.group, 133);
  EXPECT_EQ(serial.slave_setpoint, 3);
  EXPECT_EQ(serial.setpoint_source, 9);
}

// P841 of MOVITRAC 31 stands for P100, P101 and P876 (its PROFIBUS manual, 2.9).
TEST(Obstacles, OfMovitrac31) {
  for (const int32_t p841 : {0, 1}) {
    Served unit("mc31");
    unit.set("841", p841);
    unit.server.take_fieldbus(kEnable);
    const auto told = unit.server.take_obstacles();
    EXPECT_EQ(told.size(), p841 == 1 ? 0U : 1U);
    EXPECT_EQ(Served::count(told, "PO data have no effect: P841"), told.size());
  }
}

// Words of a speed (P870 to P872): SPEED and SPEED [%].
TEST(UnitInterface, KnowsItsSpeedWord) {
  for (int32_t assignment = 0; assignment <= 12; ++assignment)
    for (const char* number : {"870", "871", "872"}) {
      Served unit("md60a");
      for (const char* other : {"870", "871", "872"}) unit.set(other, 0);
      EXPECT_FALSE(unit.server.has_speed_word());
      EXPECT_FALSE(unit.server.has_control_word());
      unit.set(number, assignment);
      EXPECT_EQ(unit.server.has_speed_word(), assignment == 1 || assignment == 11) << number << assignment;
      EXPECT_EQ(unit.server.has_control_word(), assignment == 9 || assignment == 10) << number << assignment;
    }
}

// Commands a millisecond: task 1 has 1 + P938, task 2 has 2 + P939, and both together add 9 at most (IPOSplus p. 44).
TEST(UnitInterface, RatesOfTheTasks) {
  Served unit;
  for (int32_t first = 0; first <= 9; ++first)
    for (int32_t second = 0; second <= 9; ++second) {
      unit.set("938", first);
      unit.set("939", second);
      const vm::Rates& rates = unit.server.rates();
      EXPECT_EQ(rates.commands[0], static_cast<uint32_t>(1 + first));
      EXPECT_EQ(rates.commands[1], static_cast<uint32_t>(2 + std::min(second, 9 - first))) << first << second;
    }
}

TEST(UnitInterface, SetsParametersBeforePowerOn) {
  Served unit;
  EXPECT_EQ(unit.server.set_parameter("P9999", 1).value_or(""), "unit mdxb has no parameter P9999");
  for (const char* name : {"P302", "302"}) {
    EXPECT_FALSE(unit.server.set_parameter(name, 1'000'000));
    EXPECT_EQ(unit.server.value(name), 1'000'000);
    EXPECT_FALSE(unit.server.set_parameter(name, 2'000'000));
  }
  EXPECT_EQ(unit.server.value("9999"), 0);
  const auto refused = unit.server.set_parameter("302", -1);
  ASSERT_TRUE(refused);
  EXPECT_NE(refused->find("P302"), std::string::npos) << *refused;
}

// Byte 1 of the channel is the subindex of MOVIDRIVE B; on others it is reserved, told once and without effect.
TEST(UnitInterface, TheReservedByteIsIgnored) {
  for (const char* name : {"md60a", "mdxb"}) {
    Served unit(name);
    const bool told = name == std::string_view("md60a");
    EXPECT_EQ(unit.server.has_subindices(), !told);
    constexpr uint8_t kSubindices[] = {0, 1, 1};
    for (size_t n = 0; n < 3; ++n) {
      EXPECT_EQ(unit.server.serve(0, {Service::Read, 8470, kSubindices[n], 0}), 2000) << name;
      const auto reasons = unit.server.take_obstacles();
      EXPECT_EQ(reasons.size(), told && n == 1 ? 1U : 0U) << name;
      EXPECT_EQ(Served::count(reasons, "byte 1"), reasons.size());
    }
  }
}

TEST(UnitInterface, CountsSyncTelegrams) {
  Served unit;
  EXPECT_EQ(unit.server.syncs(), 0U);
  for (uint32_t n = 1; n <= 3; ++n) {
    unit.server.synchronize(0);
    EXPECT_EQ(unit.server.syncs(), n);
  }
}

}  // namespace
}  // namespace ipos::runtime
