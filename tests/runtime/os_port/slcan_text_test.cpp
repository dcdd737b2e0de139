// slcan lines: examples worked out from the LAWICEL protocol, round trips, and text that is none.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "runtime/os_port/slcan_text.hpp"

namespace ipos::tests {
namespace {

using namespace ipos::runtime;  // NOLINT: everything here is about the runtime

Frame some_frame() {
  Frame made;
  made.extended = *rc::gen::arbitrary<bool>();
  made.remote = *rc::gen::arbitrary<bool>();
  made.id = *rc::gen::inRange<uint32_t>(0, made.extended ? kExtendedIdLimit : kStandardIdLimit);
  made.length = *rc::gen::inRange<uint8_t>(0, 9);
  for (uint8_t& byte : made.data) byte = *rc::gen::arbitrary<uint8_t>();
  return canonical(made);
}

TEST(SlcanText, FramesAsTheProtocolWritesThem) {
  // "t1002113300AA" style: identifier 100h, 2 bytes 11h 33h.
  EXPECT_EQ(slcan_text({0x100, 2, {0x11, 0x33}, false, false}), "t10021133\r");
  EXPECT_EQ(slcan_text({0x12ABCDEF, 2, {0xAA, 0x55}, true, false}), "T12ABCDEF2AA55\r");
  EXPECT_EQ(slcan_text({0x7FF, 0, {}, false, false}), "t7FF0\r");
  EXPECT_EQ(slcan_text({0x100, 8, {}, false, true}), "r1008\r");
  EXPECT_EQ(slcan_text({0x1, 3, {}, true, true}), "R000000013\r");
  EXPECT_EQ(slcan_text({0x100, 1, {0xFF}, false, false}, 59'999), "t1001FFEA5F\r");
}

TEST(SlcanText, RoundTrip) {
  EXPECT_TRUE(rc::check([] {
    const Frame made = some_frame();
    std::optional<uint16_t> stamp;
    if (*rc::gen::arbitrary<bool>()) stamp = *rc::gen::inRange<uint16_t>(0, kSlcanStampPeriod);
    const std::string text = slcan_text(made, stamp);
    const auto parsed = parse_slcan(std::string_view(text).substr(0, text.size() - 1));
    RC_ASSERT(parsed.has_value());
    RC_ASSERT(parsed->frame == made);
    RC_ASSERT(parsed->stamp == stamp);
  }));
}

TEST(SlcanText, LowerCaseDigitsAreTaken) {
  const auto parsed = parse_slcan("t7ab1ff");
  ASSERT_TRUE(parsed);
  EXPECT_EQ(parsed->frame.id, 0x7ABU);
  EXPECT_EQ(parsed->frame.data[0], 0xFF);
}

TEST(SlcanText, WhatIsNoFrame) {
  for (const char* line : {"",
                           "t",
                           "t10",
                           "t100",
                           "t1009",
                           "t100A",
                           "t8000",
                           "T200000000",
                           "t1001F",
                           "t1001FG",
                           "t1001FF0",
                           "t1001FFEA60",
                           "t1001FF00000",
                           "r100",
                           "r1008112233",
                           "T1001",
                           "x1000",
                           " t1000",
                           "t1000 ",
                           "t-100",
                           "O",
                           "z"})
    EXPECT_FALSE(parse_slcan(line)) << line;
}

// CANDapter's x, and stamps of eight digits; both only from an adapter.
TEST(SlcanText, FramesOfOtherAdapters) {
  const Frame extended(0x12ABCDEF, 2, {0xAA, 0x55}, true, false);
  EXPECT_EQ(parse_adapter_slcan("x12ABCDEF2AA55")->frame, extended);
  EXPECT_EQ(parse_adapter_slcan("x12ABCDEF2AA55EA5F")->stamp, 59'999);
  EXPECT_EQ(parse_adapter_slcan("T12ABCDEF2AA5500ABCDEF")->frame, extended);
  EXPECT_EQ(parse_adapter_slcan("T12ABCDEF2AA5500ABCDEF")->stamp, std::nullopt);
  EXPECT_EQ(parse_adapter_slcan("t1001FFFFFFFFFF")->frame, (Frame{0x100, 1, {0xFF}}));
  EXPECT_EQ(parse_adapter_slcan("r100800000000")->frame, (Frame{0x100, 8, {}, false, true}));
  EXPECT_EQ(parse_adapter_slcan("t1001FF0001")->stamp, 1);
  for (const char* line : {"", "x", "x1000", "x200000000", "t1001FF0000000", "t1001FF000000000",
                           "t1001FF0000000G", "t1001FF000000000001", "00000000", "z00000000"})
    EXPECT_FALSE(parse_adapter_slcan(line)) << line;
}

TEST(SlcanText, RatesHaveTheirDigits) {
  EXPECT_EQ(slcan_rate_digit(125'000), '4');
  EXPECT_EQ(slcan_rate_digit(250'000), '5');
  EXPECT_EQ(slcan_rate_digit(500'000), '6');
  EXPECT_EQ(slcan_rate_digit(1'000'000), '8');
  EXPECT_EQ(slcan_rate_digit(300'000), std::nullopt);
}

// Any bytes: lines never exceed their limit, a frame that is accepted is written again as the same text, and
// after a CR the next line is read as if nothing had been before.
TEST(SlcanLines, AnyBytes) {
  EXPECT_TRUE(rc::check([] {
    const auto bytes = *rc::gen::container<std::string>(
        rc::gen::weightedOneOf<char>({{6, rc::gen::elementOf(std::string("tTrRzZ0123456789ABCDEFabcdef"))},
                                      {1, rc::gen::elementOf(std::string("\r\a\n"))},
                                      {1, rc::gen::arbitrary<char>()}}));
    SlcanLines lines;
    for (const char c : bytes) {
      const auto kind = lines.push(c);
      if (kind != SlcanLines::Kind::Line) continue;
      RC_ASSERT(lines.line().size() <= 40U);
      if (const auto parsed = parse_slcan(lines.line())) {
        RC_ASSERT(is_valid(parsed->frame));
        std::string again = slcan_text(parsed->frame, parsed->stamp);
        again.pop_back();
        std::string line(lines.line());
        for (size_t n = 1; n < line.size(); ++n) line[n] = static_cast<char>(std::toupper(line[n]));
        RC_ASSERT(again == line);
      }
    }
    lines.push('\r');
    for (const char c : std::string("t7FF0")) RC_ASSERT(!lines.push(c));
    RC_ASSERT(lines.push('\r') == SlcanLines::Kind::Line);
    RC_ASSERT(lines.line() == "t7FF0");
  }));
}

TEST(SlcanLines, TooLongAndRefused) {
  SlcanLines lines;
  for (int n = 0; n < 100'000; ++n) ASSERT_FALSE(lines.push('t'));
  EXPECT_EQ(lines.push('\r'), SlcanLines::Kind::TooLong);
  EXPECT_EQ(lines.push('\r'), SlcanLines::Kind::Line);
  EXPECT_TRUE(lines.line().empty());
  lines.push('t');
  EXPECT_EQ(lines.push('\a'), SlcanLines::Kind::Error);
  EXPECT_EQ(lines.push('\r'), SlcanLines::Kind::Line);
  EXPECT_TRUE(lines.line().empty());
}

}  // namespace
}  // namespace ipos::tests
