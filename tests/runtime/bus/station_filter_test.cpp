// Which telegrams concern a station, and RS-485 telegrams in words and units.
#include "runtime/bus/movilink/station_filter.hpp"

#include <gtest/gtest.h>

#include <array>

#include "runtime/bus/movilink/describe_serial.hpp"

namespace ipos::tests {
namespace {

using namespace ipos::runtime;  // NOLINT

TelegramNames two_units() {
  TelegramNames names;
  UnitNames unit;
  unit.unit = stdlib::find_unit("md60a");
  unit.output = {9, 1, 0};
  unit.input = {6, 1, 2};
  unit.name = "unit1";
  unit.settings = {1, 4, 0};
  unit.variables = {{20, "lSpeed"}};
  names.units.push_back(unit);
  unit.name = "unit2";
  unit.settings = {2, 5, 7};
  names.units.push_back(unit);
  ObjectNames object;
  object.id = 1024;
  object.format = {4, VariableLayout::Motorola};
  object.station = "unit1";
  object.sent = true;
  names.objects.push_back(object);
  object.station = "unit2";
  object.sent = false;
  names.objects.push_back(object);
  object.id = 1025;
  names.objects.push_back(object);
  return names;
}

std::vector<uint32_t> passing(const StationFilter& filter) {
  std::vector<uint32_t> ids;
  for (uint32_t id = 0; id < 2048; ++id)
    if (filter.passes(Frame{id, 0, {}, false, false})) ids.push_back(id);
  return ids;
}

// Identifiers by 1053 1610 p. 38: 8 a + 3, 4, 5 and 515, 516, 517, 519; 8 g + 6 and 518.
TEST(StationFilter, ByNameAllThatConcernsTheUnit) {
  StationFilter filter;
  EXPECT_EQ(passing(filter).size(), 2048U) << "without a station everything";
  ASSERT_TRUE(filter.add(two_units(), "unit1"));
  const std::vector<uint32_t> first = {0, 11, 12, 13, 38, 523, 524, 525, 527, 550, 1024};
  EXPECT_EQ(passing(filter), first);
  StationFilter other;
  ASSERT_TRUE(other.add(two_units(), "unit2"));
  EXPECT_EQ(passing(other), (std::vector<uint32_t>{7, 19, 20, 21, 46, 531, 532, 533, 535, 558, 1024, 1025}));
  StationFilter same;
  ASSERT_TRUE(same.add(two_units(), "1")) << "a known address brings the rest along";
  EXPECT_EQ(passing(same), first);
  ASSERT_TRUE(same.add(two_units(), "60")) << "and an unknown one only itself";
  EXPECT_EQ(passing(same).size(), first.size() + 7);
  EXPECT_TRUE(same.passes(Frame{8 * 60 + 515, 8, {}, false, false}));
  EXPECT_FALSE(same.passes(Frame{11, 0, {}, true, false})) << "29 bits";
  EXPECT_FALSE(same.passes(Frame{11, 0, {}, false, true})) << "remote frame";
}

TEST(StationFilter, WhatIsNoStation) {
  StationFilter filter;
  for (const char* text : {"", "unit3", "-1", "256", "1x", "unit"})
    EXPECT_FALSE(filter.add(two_units(), text)) << text;
  EXPECT_EQ(passing(filter).size(), 2048U);
  EXPECT_TRUE(filter.add({}, "63"));
  EXPECT_EQ(passing(filter), (std::vector<uint32_t>{507, 508, 509, 1019, 1020, 1021, 1023}));
}

TEST(StationFilter, IdentifiersByThemselves) {
  StationFilter filter;
  filter.add(300);
  filter.add(2000);
  EXPECT_EQ(passing(filter), (std::vector<uint32_t>{300, 2000}));
  EXPECT_FALSE(filter.passes(SerialTelegram{false, 37, {}, {}, {}}));
  StationFilter closed;
  closed.close();
  EXPECT_TRUE(passing(closed).empty());
  ASSERT_TRUE(closed.add(two_units(), "2")) << "by its address, with its group and objects";
  EXPECT_EQ(passing(closed), (std::vector<uint32_t>{7, 19, 20, 21, 46, 531, 532, 533, 535, 558, 1024, 1025}));
  TelegramNames names = two_units();
  names.units[1].settings.synchronous = false;
  StationFilter no_sync;
  ASSERT_TRUE(no_sync.add(names, "unit2"));
  EXPECT_FALSE(no_sync.passes(Frame{7, 0}));
  // Two units of one name, each on its own.
  names.units[1].name = "unit1";
  StationFilter both;
  ASSERT_TRUE(both.add(names, "unit1"));
  EXPECT_TRUE(both.passes(Frame{11, 0}) && both.passes(Frame{19, 0}));
}

TEST(StationFilter, NumbersOfStations) {
  EXPECT_EQ(station_number("0"), 0);
  EXPECT_EQ(station_number("255"), 255);
  for (const char* text : {"", "256", "-1", "+1", " 1", "1 ", "0x1", "a"})
    EXPECT_EQ(station_number(text), std::nullopt) << text;
}

SerialTelegram serial(uint8_t address, int format, ProcessWords words = {}, bool response = false) {
  return {response, address, *telegram_format(format), {}, words};
}

TEST(StationFilter, OnRs485) {
  TelegramNames names = two_units();
  names.units[0].settings.group = 104;
  StationFilter filter;
  ASSERT_TRUE(filter.add(names, "unit1"));
  for (int address = 0; address < 256; ++address) {
    const bool mine = address == 1 || address == 104 || address == 254 || address == 255;
    EXPECT_EQ(filter.passes(serial(static_cast<uint8_t>(address), 5)), mine) << address;
  }
}

TEST(DescribeSerial, PartnersAndParts) {
  TelegramNames names = two_units();
  names.units[0].settings.group = 104;
  const auto words = [&](const SerialTelegram& telegram) { return describe(names, telegram); };
  EXPECT_EQ(words(serial(1, 5, {6, 5000, 1})),
            "3PD cyclic, PO CTRL. WORD 1 0006h (enable), SPEED 1000.0 rpm, 0001h -> unit1");
  EXPECT_EQ(words(serial(1, 0x81, {6, 5000, 1})), "1PD acyclic, PO CTRL. WORD 1 0006h (enable) -> unit1");
  EXPECT_EQ(words(serial(1, 3, {7, 5011, 0}, true)),
            "2PD cyclic, PI STATUS WORD1 0007h (ready, output stage on, PO data on; state 0 not ready), "
            "SPEED 1002.2 rpm <- unit1");
  EXPECT_EQ(words(serial(3, 1, {6, 0, 0})), "1PD cyclic, PO 0006h -> address 3");
  EXPECT_EQ(words(serial(104, 1, {6, 0, 0})), "1PD cyclic, PO CTRL. WORD 1 0006h (enable) -> group 104");
  EXPECT_EQ(words(serial(105, 1, {6, 0, 0})), "1PD cyclic, PO 0006h -> group 105");
  EXPECT_EQ(words(serial(255, 1, {6, 0, 0})), "1PD cyclic, PO 0006h -> all units");
  EXPECT_EQ(words(serial(254, 1, {6, 0, 0})), "1PD cyclic, PO 0006h -> any one unit (254)");
  SerialTelegram parameter = serial(1, 0x86);
  parameter.parameter = decode_parameter({0x31, 0, 0x20, 0x7E, 0, 0, 0, 0});
  EXPECT_EQ(words(parameter), "PARAM acyclic, read 8318 Speed -> unit1");
  parameter.response = true;
  parameter.parameter = decode_parameter({0x71, 0, 0x20, 0x7E, 0, 0x0F, 0x42, 0x40});
  EXPECT_EQ(words(parameter), "PARAM acyclic, read 8318 Speed = 1000.000 rpm, handshake 1 <- unit1");
  parameter.parameter = decode_parameter({0x31, 0, 0x2B, 0x0C, 0, 0, 0, 5});  // 11020
  EXPECT_EQ(words(parameter), "PARAM acyclic, read 11020 lSpeed = 5 <- unit1");
  parameter.format = *telegram_format(4);
  parameter.words = {7, 5011, 0};
  parameter.parameter = decode_parameter({0xB2, 0, 0x20, 0x7E, 8, 0, 0, 0x12});
  EXPECT_EQ(words(parameter),
            "PARAM + 3PD cyclic, write 8318 Speed refused: class 8 code 0 additional 12h: read access only, "
            "PI STATUS WORD1 0007h (ready, output stage on, PO data on; state 0 not ready), SPEED 1002.2 "
            "rpm, OUTP. CURRENT 0.0 % In <- unit1");
}

TEST(DescribeSerial, WhatIsNoTelegram) {
  SerialReceiver receiver;
  std::optional<Reception> reception;
  Time at = kSecond;
  constexpr std::array<uint8_t, 10> kBytes = {0x02, 0x01, 0x05, 0x00, 0x06, 0x13, 0x88, 0x0B, 0xB8, 0x29};
  for (const uint8_t byte : kBytes) {
    reception = receiver.take({at, at + kMillisecond, byte, false, false});
    at += kMillisecond;
  }
  ASSERT_TRUE(reception);
  EXPECT_EQ(describe({}, *reception), "void, BCC incorrect: 02 01 05 00 06 13 88 0B B8 29");
}

}  // namespace
}  // namespace ipos::tests
