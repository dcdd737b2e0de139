// Frames of lines on which MOVILINK, CANopen or both are spoken.
#include "runtime/bus/words/can_words.hpp"

#include <gtest/gtest.h>

#include "tests/runtime/bus/canopen/fake_unit.hpp"

namespace ipos::tests {
namespace {

const Frame kRequest{523, 8, {0x31, 0, 0x20, 0x7E}};   // 8 * 1 + 515 (1053 1610 p. 38)
const Frame kUpload{0x605, 8, {0x40, 0x7E, 0x20, 0}};  // of 207Eh = 8318, page 55 of 11264926
const Frame kStarted{0x000, 2, {0x01, 5}};

runtime::UnitNames unit_at_1() {
  runtime::UnitNames unit;
  unit.name = "feed";
  unit.unit = stdlib::find_unit("md60a");
  unit.settings.address = 1;
  return unit;
}

TEST(CanWords, BothOnOneLine) {
  runtime::CanNames names;
  names.lines["can0"].movilink.units = {unit_at_1()};
  names.lines["can0"].nodes = {{5, "saw", &mdxb(), {}, {}}};
  names.lines["can1"].movilink.units = {unit_at_1()};
  runtime::CanWords words(names);
  EXPECT_EQ(words.describe("can0", kRequest).text, "20B read 8318 Speed -> feed");
  EXPECT_EQ(words.describe("can0", kUpload).text, "605 SDO read 207Eh P000 Speed -> saw");
  EXPECT_EQ(words.describe("can0", kStarted).text, "000 NMT start -> saw");
  // No node is on the other one.
  EXPECT_EQ(words.describe("can1", kStarted).text, "000 sync telegram");  // P817, P885 = 0
  EXPECT_EQ(words.describe("can1", kRequest).text, "20B read 8318 Speed -> feed");
}

// What a node was told on one line does not change that of the same number on another.
TEST(CanWords, EachLineIsListenedToByItself) {
  runtime::CanNames names;
  names.canopen = true;
  runtime::CanWords words(names);
  const Frame mapped{0x605, 8, {0x23, 0x00, 0x18, 0x01, 0x23, 0x01, 0, 0}};  // TPDO1 with 123h
  EXPECT_EQ(words.describe("a", mapped).text, "605 SDO write 1800h:1 TPDO1 COB-ID = 00000123h -> node 5");
  EXPECT_EQ(words.describe("a", {0x585, 8, {0x60, 0x00, 0x18, 0x01}}).text,
            "585 SDO written 1800h:1 TPDO1 COB-ID <- node 5");
  EXPECT_TRUE(words.describe("a", {0x123, 6, {}}).known);
  EXPECT_FALSE(words.describe("b", {0x185, 6, {}}).text.empty());
  EXPECT_EQ(words.describe("b", {0x123, 6, {}}).text, "123 00 00 00 00 00 00");
}

// A page looks the names up again now and then; a mapping that was heard stays known.
TEST(CanLineWords, TakeNewNamesAndKeepWhatWasHeard) {
  runtime::CanLineNames names;
  names.nodes = {{5, "saw", &mdxb(), {}, {}}};
  runtime::CanLineWords words(names);
  words.describe({0x605, 8, {0x23, 0x00, 0x18, 0x01, 0x23, 0x01, 0, 0}});  // TPDO1 with 123h
  words.describe({0x585, 8, {0x60, 0x00, 0x18, 0x01}});
  const std::string before = words.describe({0x123, 6, {}}).text;
  EXPECT_NE(before.find("TPDO1"), std::string::npos) << before;
  names.nodes[0].name = "lift";
  names.movilink.units = {unit_at_1()};
  EXPECT_TRUE(words.is_canopen(kRequest));
  words.use(names);
  EXPECT_FALSE(words.is_canopen(kRequest));
  EXPECT_EQ(words.describe(kRequest).text, "20B read 8318 Speed -> feed");
  EXPECT_EQ(words.describe({0x123, 6, {}}).text, before.substr(0, before.size() - 3) + "lift");
}

// A station may become a node while somebody listens.
TEST(CanLineWords, NodesMayComeLater) {
  runtime::CanLineWords words{{}};
  EXPECT_EQ(words.describe(kStarted).text, "000 01 05");
  words.use({{}, {{5, "saw", &mdxb(), {}, {}}}});
  EXPECT_EQ(words.describe(kStarted).text, "000 NMT start -> saw");
}

// A thousand names in a log do not make a thousand dictionaries.
TEST(CanWords, ManyNamesAreOneLine) {
  runtime::CanNames names;
  names.canopen = true;
  runtime::CanWords words(names);
  for (int n = 0; n < 1000; ++n)
    EXPECT_EQ(words.describe("line" + std::to_string(n), kStarted).text, "000 NMT start -> node 5");
}

}  // namespace
}  // namespace ipos::tests
