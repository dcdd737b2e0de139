// Process data of PROFIBUS-DP in words: divided by the configuration that the master has sent, named by the drive, or by the
// drives behind a gateway.
#include <gtest/gtest.h>

#include "runtime/bus/profibus/card.hpp"
#include "runtime/bus/words/bus_words.hpp"
#include "stdlib/unit_types.hpp"

namespace ipos::tests {
namespace {

using profibus::Octets;
using runtime::DpLineWords;
using runtime::DpSlaveNames;

// The master 1 and a slave; access points 62 for both are Chk_Cfg (EN 50170 volume 2).
profibus::Reception frame(uint8_t destination, uint8_t source, uint8_t control, Octets data, bool chk_cfg = false) {
  profibus::FdlFrame made;
  made.kind = profibus::Delimiter::SD2;
  made.destination = destination;
  made.source = source;
  made.control = control;
  if (chk_cfg) made.dsap = made.ssap = 62;
  made.data = std::move(data);
  const Octets octets = encode(made);
  return {profibus::decode(octets), octets, 0, 0};
}
profibus::Reception request(uint8_t slave, Octets data) { return frame(slave, 1, 0x7D, std::move(data)); }
profibus::Reception answer(uint8_t slave, Octets data) { return frame(1, slave, 0x08, std::move(data)); }
profibus::Reception configuration(uint8_t slave, Octets cfg) { return frame(slave, 1, 0x5D, std::move(cfg), true); }

DpSlaveNames movitrac31() {
  DpSlaveNames slave;
  slave.address = 8;
  slave.name = "belt";
  slave.accepts = profibus::option_type(profibus::OptionKind::Ffp31).accepts;
  slave.own_numbers = true;
  runtime::UnitNames unit;
  unit.name = "belt";
  unit.unit = stdlib::find_unit("mc31");
  unit.output = {9, 1, 8};
  unit.input = {6, 1, 2};
  unit.first_index = 1000;
  slave.drives = {unit};
  return slave;
}

TEST(DpWords, NobodyKnownIsHexadecimal) {
  DpLineWords words;
  EXPECT_EQ(words.describe(request(8, {0, 6, 5, 0xDC, 0, 0})), "1 -> 8 Data_Exchange, SRD high, FCB 1: 00 06 05 DC 00 00");
}

// 1500 digits of 0.2 rpm are 300 rpm; index 1025 is 25 of the list, T11, in hundredths of a second as BCD (MOVITRAC 31
// PROFIBUS, 3.7.5, and the program example of this manual).
TEST(DpWords, TheConfigurationOfTheMasterDividesTheData) {
  DpLineWords words({movitrac31()});
  EXPECT_EQ(words.describe(request(8, {0, 6, 5, 0xDC})), "1 -> 8 Data_Exchange, SRD high, FCB 1: 00 06 05 DC")
      << "nobody has said how they are divided";
  words.describe(configuration(8, {0xF1}));
  EXPECT_EQ(words.describe(request(8, {0, 6, 5, 0xDC})),
            "1 -> 8 Data_Exchange, SRD high, FCB 1: PO CTRL. WORD 1 0006h (enable), SPEED 300.0 rpm -> belt");
  words.describe(configuration(8, {0xF3, 0xF2}));
  EXPECT_EQ(words.describe(request(8, {0x72, 0, 4, 1, 0, 0, 2, 0, 0, 6, 5, 0xDC, 0, 0})),
            "1 -> 8 Data_Exchange, SRD high, FCB 1: write 1025 T11 ramp UP = 2.00 s, PO CTRL. WORD 1 0006h (enable), SPEED "
            "300.0 rpm, RAMP 0 ms -> belt");
  const std::string answered = words.describe(answer(8, {0, 0, 0, 0, 0, 0, 0, 0, 0x02, 0x07, 0x0B, 0xB8, 0, 0}));
  EXPECT_EQ(answered.rfind("8 -> 1 Data_Exchange answer, DL: no service, PI STATUS WORD1 0207h", 0), 0U) << answered;
  EXPECT_NE(answered.find("SPEED 600.0 rpm"), std::string::npos) << answered;
  EXPECT_TRUE(answered.ends_with(" <- belt")) << answered;
  // What has another length is no data exchange of this configuration.
  EXPECT_EQ(words.describe(request(8, {0, 6})), "1 -> 8 Data_Exchange, SRD high, FCB 1: 00 06");
  // Other names change nothing of what was heard.
  DpSlaveNames other = movitrac31();
  other.name = "mill";
  words.use({other});
  const std::string renamed = words.describe(request(8, {0x72, 0, 4, 1, 0, 0, 2, 0, 0, 6, 5, 0xDC, 0, 0}));
  EXPECT_NE(renamed.find("RAMP 0 ms -> mill"), std::string::npos) << renamed;
}

TEST(DpWords, APlannedConfigurationCountsUntilAnotherIsHeard) {
  DpSlaveNames slave = movitrac31();
  const Octets planned{0xF2};
  slave.configuration = profibus::find_configuration(planned, slave.accepts);
  DpLineWords words({slave});
  const std::string text = words.describe(request(8, {0, 6, 5, 0xDC, 0, 0}));
  EXPECT_NE(text.find("SPEED 300.0 rpm"), std::string::npos) << text;
  words.describe(configuration(8, {0xF1}));
  EXPECT_EQ(words.describe(request(8, {0, 6, 5, 0xDC, 0, 0})).find("SPEED"), std::string::npos);
  // One that the card does not take is none.
  words.describe(configuration(8, {0x77}));
  EXPECT_NE(words.describe(request(8, {0, 6, 5, 0xDC})).find("SPEED"), std::string::npos);
}

// Byte 1 of the channel is the address of the drive; each has three words, in the order of the addresses. P302 of a
// MOVITRAC 07 is the "Maximum speed", without a number.
TEST(DpWords, AGatewayHasAChannelForAllAndThreeWordsForEach) {
  DpSlaveNames slave;
  slave.address = 10;
  slave.name = "gateway";
  slave.gateway = true;
  slave.accepts = profibus::option_type(profibus::OptionKind::Gateway).accepts;
  for (const auto& [name, address] : {std::pair("pump", 2), {"fan", 5}}) {
    runtime::UnitNames unit;
    unit.name = name;
    unit.unit = stdlib::find_unit("mc07");
    unit.settings.address = static_cast<uint8_t>(address);
    unit.output = {9, 1, 8};
    slave.drives.push_back(unit);
  }
  DpLineWords words({slave});
  words.describe(configuration(10, {0xF3, 0xF2, 0xF2}));
  const Octets data{0x72, 5, 0x21, 0x45, 0, 0x0F, 0x42, 0x40, 0, 6, 5, 0xDC, 0, 0, 0, 6, 0x0B, 0xB8, 0, 0};
  EXPECT_EQ(words.describe(request(10, data)),
            "1 -> 10 Data_Exchange, SRD high, FCB 1: write 8517 Maximum speed = 1000.000 rpm of fan, pump PO CTRL. WORD 1 "
            "0006h (enable), SPEED 300.0 rpm, RAMP 0 ms, fan PO CTRL. WORD 1 0006h (enable), SPEED 600.0 rpm, RAMP 0 ms -> "
            "gateway");
  Octets nobody = data;
  nobody[1] = 7;
  EXPECT_NE(words.describe(request(10, nobody)).find(" of address 7, "), std::string::npos);
}

// A log may name no line, or another one than the plant; one line is meant then.
TEST(DpWords, ALogWithoutNamesHasTheOnlyLine) {
  runtime::BusNames names;
  names.dp.lines["dp"] = {movitrac31()};
  runtime::BusWords one(names);
  one.describe("", configuration(8, {0xF1}));
  EXPECT_NE(one.describe("", request(8, {0, 6, 5, 0xDC})).find("-> belt"), std::string::npos);
  names.dp.lines["other"] = {};
  runtime::BusWords two(names);
  two.describe("dp", configuration(8, {0xF1}));
  EXPECT_NE(two.describe("dp", request(8, {0, 6, 5, 0xDC})).find("-> belt"), std::string::npos);
  EXPECT_EQ(two.describe("third", request(8, {0, 6, 5, 0xDC})).find("-> belt"), std::string::npos);
}

}  // namespace
}  // namespace ipos::tests
