// PROFIBUS frames in the log of serial lines, written and read back. The frames are those that were captured of an S7
// with an ET 200S (profibus/frame_test.cpp).
#include "runtime/bus/log/profibus_log.hpp"

#include <gtest/gtest.h>

#include <sstream>

#include "runtime/clock/event_queue.hpp"

namespace ipos::tests {
namespace {

using namespace ipos::runtime;  // NOLINT

const profibus::Octets kDiagOctets = {0x68, 0x05, 0x05, 0x68, 0x88, 0x81, 0x6D, 0x3C, 0x3E, 0xF0, 0x16};
const std::string kDiagText = "68 05 05 68 88 81 6D 3C 3E F0 16";
const std::string kDiagMeaning = "1 -> 8 Slave_Diag, SRD high, FCB 1 (first)";
const std::string kTimes = "0.003455 12.003653 dp ";

TEST(ProfibusLog, OneLineAFrame) {
  EventQueue queue;
  const profibus::Line line(queue, 0, "dp", 1'500'000);
  std::ostringstream text;
  ProfibusLog log(text);
  const Time start = 3'455 * kMicrosecond, end = 12 * kSecond + 3'653 * kMicrosecond;
  log.on_frame(line, 0, reception_of(kDiagOctets, start, end, std::nullopt));
  log.on_frame(line, 0, reception_of(kDiagOctets, start, end, profibus::FrameError::Parity));
  log.on_frame(line, 0, reception_of({0x10, 0x03}, start, end, std::nullopt));
  EXPECT_EQ(text.str(), kTimes + kDiagText + " | " + kDiagMeaning + "\n" +  //
                            kTimes + kDiagText + " | void frame: parity error\n" + kTimes +
                            "10 03 | void frame: wrong number of octets\n");
}

TEST(ProfibusLog, ALineIsReadBack) {
  const auto entry = parse_profibus_line(kTimes + kDiagText + " | " + kDiagMeaning + "\r");
  ASSERT_TRUE(entry.has_value());
  EXPECT_EQ(entry->line, "dp");
  EXPECT_EQ(entry->reception.start, 3'455 * kMicrosecond);
  EXPECT_EQ(entry->reception.end, 12 * kSecond + 3'653 * kMicrosecond);
  EXPECT_EQ(entry->reception.octets, kDiagOctets);
  ASSERT_TRUE(entry->reception.frame.has_value());
  EXPECT_EQ(reception_text(entry->reception), kDiagMeaning);
}

TEST(ProfibusLog, ABareFrameHasNoTime) {
  for (const std::string& text : {kDiagText, " \t" + kDiagText + " \r", kDiagText + " | a word 1.5"}) {
    const auto entry = parse_profibus_line(text);
    ASSERT_TRUE(entry.has_value()) << text;
    EXPECT_EQ(entry->line, "");
    EXPECT_EQ(entry->reception.start, 0);
    EXPECT_EQ(entry->reception.end, 0);
    EXPECT_EQ(entry->reception.octets, kDiagOctets);
  }
  // It begins a frame, but is none: the reason comes from the octets.
  const auto cut = parse_profibus_line("68 05 05 68 88");
  ASSERT_TRUE(cut.has_value());
  EXPECT_EQ(cut->reception.frame.error(), profibus::FrameError::Size);
  EXPECT_EQ(parse_profibus_line("e5")->reception.octets, profibus::Octets{0xE5});
}

// The receiver also sees what is not in the octets.
TEST(ProfibusLog, TheReasonOfAVoidFrameComesFromTheLog) {
  for (const char* reason : {"parity error", "address or access point not valid"})
    for (const char* end : {"", "\r", " \t"}) {
      const auto entry = parse_profibus_line(kTimes + kDiagText + " | void frame: " + reason + end);
      ASSERT_TRUE(entry.has_value()) << reason;
      ASSERT_FALSE(entry->reception.frame.has_value());
      EXPECT_EQ(reception_text(entry->reception), std::string("void frame: ") + reason);
    }
  EXPECT_TRUE(parse_profibus_line(kTimes + "99 | void frame: no start delimiter").has_value())
      << "a void frame begins with anything";
  EXPECT_FALSE(parse_profibus_line(kTimes + kDiagText + " | void frame: something else").has_value());
  EXPECT_TRUE(parse_profibus_line(kDiagText + " | void frame: something else").has_value())
      << "not of the log";
}

// On a line of MOVILINK noise may look like a frame of PROFIBUS.
TEST(ProfibusLog, AVoidTelegramOfAnotherLineIsNoFrame) {
  for (const std::string octets : {"E5", "DC 01 02", "10 08 01 49 52 16"}) {
    const std::string bytes = kTimes + octets;
    EXPECT_TRUE(parse_profibus_line(bytes + " | 1 -> 8 anything")) << octets;
    EXPECT_TRUE(parse_profibus_line(bytes + " | void frame: parity error")) << octets;
    EXPECT_FALSE(parse_profibus_line(bytes + " | void: character delay exceeded")) << octets;
    EXPECT_TRUE(parse_profibus_line(octets + " | void: a word of a person")) << "not of a log: " << octets;
  }
}

TEST(ProfibusLog, LinesOfOtherKinds) {
  const std::string bad[] = {
      "",
      "| void frame: parity error",
      "02 01 05 00 06 3A 98 01 F4 57",                     // MOVILINK
      kTimes + "02 01 05 00 06 3A 98 01 F4 57 | request",  // MOVILINK
      kTimes + "68 05 05 68 88 | cut off",  // a frame of the log is whole, or the log says why not
      kTimes + "| nothing",
      "68 5 05",
      "68 005 05",
      "68 0G 05",
      "G8 05 05",
      "0.003455",
      "0.003455 12.003653",
      "0.003455 12 dp " + kDiagText,
      "0 12.003653 dp " + kDiagText + " | 1.5",
      "0.00345 12.003653 dp " + kDiagText,
      "0.0034550 12.003653 dp " + kDiagText,
      "0.003455 12.00365x dp " + kDiagText,
      "0.003455 1x.003653 dp " + kDiagText,
      "0.003455 .003653 dp " + kDiagText,
      "-1.003455 12.003653 dp " + kDiagText,
      "-0.003455 12.003653 dp " + kDiagText,
      "0.-03455 12.003653 dp " + kDiagText,
      "0.-00000 12.003653 dp " + kDiagText,
      "0.003455 9000000000.003653 dp " + kDiagText,
      "0.003455 99999999999999999999.003653 dp " + kDiagText,
  };
  for (const std::string& text : bad) EXPECT_FALSE(parse_profibus_line(text).has_value()) << text;
  EXPECT_EQ(parse_profibus_line("8999999999.000001 8999999999.999999 dp E5")->reception.end,
            8'999'999'999'999'999'000);
}

}  // namespace
}  // namespace ipos::tests
