// The log of serial lines: what is written, what is read back, and where a line is wrong. The telegram is the test
// vector of 1053 1610 p. 25.
#include "runtime/bus/log/serial_log.hpp"

#include <gtest/gtest.h>

#include <sstream>

#include "runtime/bus/rs485/line.hpp"

namespace ipos::tests {
namespace {

using namespace ipos::runtime;  // NOLINT

constexpr uint8_t kExampleBytes[] = {0x02, 0x01, 0x05, 0x00, 0x06, 0x3A, 0x98, 0x01, 0xF4, 0x57};
const std::string kExampleText = "02 01 05 00 06 3A 98 01 F4 57";
const std::string kExampleMeaning = "request to 1, 3PD cyclic, PO 0006 3A98 01F4";

TEST(SerialLog, TimesHaveSixDigitsOfMicroseconds) {
  EXPECT_EQ(serial_time_text(0), "0.000000");
  EXPECT_EQ(serial_time_text(999), "0.000000");
  EXPECT_EQ(serial_time_text(3'455'999), "0.003455");
  EXPECT_EQ(serial_time_text(kSecond), "1.000000");
  EXPECT_EQ(serial_time_text(12 * kSecond + 999'999'999), "12.999999");
  EXPECT_EQ(serial_time_text(100'000 * kSecond + 7 * kMicrosecond), "100000.000007");
}

TEST(SerialLog, WritesTelegramsOfEachLineWithBeginAndEnd) {
  EventQueue queue;
  const Rs485Line first(queue, 0, "line1", 9600);
  const Rs485Line second(queue, 1, "line2", 9600);
  std::ostringstream text;
  SerialLog log(text);
  // A character takes 11 bits, 1145.833 us at 9600 baud; here a round millisecond.
  for (size_t n = 0; n < std::size(kExampleBytes); ++n) {
    Character character;
    character.data = kExampleBytes[n];
    character.start = 3'455 * kMicrosecond + static_cast<Time>(n) * kMillisecond;
    character.end = character.start + kMillisecond;
    log.on_character(first, 0, character);
    if (n < 4) log.on_character(second, 0, character);
  }
  const std::string whole = "0.003455 0.013455 line1 " + kExampleText + " | " + kExampleMeaning + "\n";
  EXPECT_EQ(text.str(), whole) << "the other line has its own receiver";
  log.finish();
  const std::string cut = "0.003455 0.007455 line2 02 01 05 00 | void: character delay exceeded\n";
  EXPECT_EQ(text.str(), whole + cut);
  log.finish();
  EXPECT_EQ(text.str(), whole + cut) << "told once";
}

TEST(SerialLog, ALineIsReadBack) {
  const auto entry =
      parse_serial_line("0.003455 12.014913 line1 " + kExampleText + " | " + kExampleMeaning + "\r", 3);
  ASSERT_TRUE(entry.has_value()) << entry.error().message;
  EXPECT_EQ(entry->time, 3'455 * kMicrosecond);
  EXPECT_EQ(entry->reception.start, 3'455 * kMicrosecond);
  EXPECT_EQ(entry->reception.end, 12 * kSecond + 14'913 * kMicrosecond);
  EXPECT_EQ(entry->line, "line1");
  ASSERT_TRUE(entry->reception.telegram.has_value());
  EXPECT_EQ(describe(*entry->reception.telegram), kExampleMeaning);
  EXPECT_EQ(serial_log_line(entry->line, entry->reception),
            "0.003455 12.014913 line1 " + kExampleText + " | " + kExampleMeaning);
}

TEST(SerialLog, ABareTelegramHasNoTime) {
  for (const char* text : {"02 01 05 00 06 3A 98 01 F4 57", "  0201050006 3a9801f457\t\r",
                           "02\t01 05 00 06 3A 98 01 F4 57 | a word"}) {
    const auto entry = parse_serial_line(text);
    ASSERT_TRUE(entry.has_value()) << text << entry.error().message;
    EXPECT_EQ(entry->time, std::nullopt);
    EXPECT_EQ(entry->line, "");
    ASSERT_TRUE(entry->reception.telegram.has_value()) << text;
    EXPECT_EQ(describe(*entry->reception.telegram), kExampleMeaning);
  }
  const auto wrong = parse_serial_line("02 01 05 00 06 3A 98 01 F4 58");
  ASSERT_TRUE(wrong.has_value());
  EXPECT_EQ(wrong->reception.telegram.error(), SerialError::BlockCheck);
}

// The bytes of a void telegram may look like a good one: what the log says counts.
TEST(SerialLog, TheReasonOfAVoidTelegramComesFromTheLog) {
  for (size_t n = 0; n < kSerialErrors; ++n) {
    const auto error = static_cast<SerialError>(n);
    const std::string reason(serial_error_text(error));
    for (const char* end : {"", "\r", " \t"}) {
      const auto entry =
          parse_serial_line("1.000000 2.000000 x " + kExampleText + " | void: " + reason + end);
      ASSERT_TRUE(entry.has_value()) << reason;
      ASSERT_FALSE(entry->reception.telegram.has_value()) << reason;
      EXPECT_EQ(entry->reception.telegram.error(), error);
      EXPECT_EQ(reception_text(entry->reception), "void: " + reason);
    }
  }
  const auto unknown = parse_serial_line("1.000000 2.000000 x " + kExampleText + " | void: something else");
  ASSERT_TRUE(unknown.has_value());
  EXPECT_TRUE(unknown->reception.telegram.has_value()) << "no reason of ours: the bytes tell";
  EXPECT_TRUE(parse_serial_line("1.000000 2.000000 x | void: parity error").has_value()) << "without a byte";
}

TEST(SerialLog, HexadecimalDigitsOfBothCases) {
  const auto entry = parse_serial_line("0123456789ABCDEFabcdef");
  ASSERT_TRUE(entry.has_value()) << entry.error().message;
  const std::vector<uint8_t> expected = {0x01, 0x23, 0x45, 0x67, 0x89, 0xAB, 0xCD, 0xEF, 0xAB, 0xCD, 0xEF};
  const auto bytes = entry->reception.bytes.span();
  EXPECT_EQ(std::vector<uint8_t>(bytes.begin(), bytes.end()), expected);
}

TEST(SerialLog, ErrorsAreLocated) {
  struct Case {
    const char* text;
    size_t column;
    const char* message;
  };
  const Case cases[] = {
      {"", 1, "bytes of a telegram expected"},
      {"| void: parity error", 1, "bytes of a telegram expected"},
      {".5 1.000000 x 02", 1, "time in seconds expected"},
      {"-1.000000 1.000000 x 02", 1, "time in seconds expected"},
      {"9000000001.000000 1.000000 x 02", 1, "time in seconds expected"},
      {"99999999999999999999.000000 1.000000 x 02", 1, "time in seconds expected"},
      {"1.00000 1.000000 x 02", 3, "six digits of microseconds expected"},
      {"1.0000000 1.000000 x 02", 3, "six digits of microseconds expected"},
      {"1.-00001 1.000000 x 02", 3, "six digits of microseconds expected"},
      {"1.-00000 1.000000 x 02", 3, "six digits of microseconds expected"},
      {"1. 000000 1.000000 x 02", 3, "six digits of microseconds expected"},
      {"1.000000x 1.000000 x 02", 9, "blank expected"},
      {"1.000000", 9, "blank expected"},
      {"1.000000 ", 10, "time in seconds expected"},
      {"1.000000 2 x 02", 11, "'.' expected"},
      {"1.000000 2.000000", 18, "blank expected"},
      {"1.000000 2.000000 ", 19, "name of the line expected"},
      {"1.000000 2.000000 x 02 g1", 24, "hexadecimal byte expected"},
      {"02 0", 5, "second hexadecimal digit of a byte expected"},
      {"02 0g", 5, "second hexadecimal digit of a byte expected"},
      {"02 :1", 4, "hexadecimal byte expected"},
      {"02 /1", 4, "hexadecimal byte expected"},
      {"02 @1", 4, "hexadecimal byte expected"},
      {"02 G1", 4, "hexadecimal byte expected"},
      {"02 `1", 4, "hexadecimal byte expected"},
      {"000000000000000000000000000000000000 01", 38, "more than 18 bytes, the longest telegram"},
  };
  for (const Case& c : cases) {
    const auto entry = parse_serial_line(c.text, 7);
    ASSERT_FALSE(entry.has_value()) << c.text;
    EXPECT_EQ(entry.error().line, 7U);
    EXPECT_EQ(entry.error().column, c.column) << c.text << ": " << entry.error().message;
    EXPECT_EQ(entry.error().message, c.message) << c.text;
  }
  const auto latest = parse_serial_line("0.000000 9000000000.999999 x 02");
  ASSERT_TRUE(latest.has_value());
  EXPECT_EQ(latest->reception.end, 9'000'000'000'999'999'000);
  EXPECT_TRUE(parse_serial_line("000000000000000000000000000000000000").has_value()) << "18 bytes";
  EXPECT_EQ(parse_serial_line("x").error().line, 1U);
}

TEST(SerialLog, ALineOfThisLogBeginsWithADigit) {
  for (const char* text : {"0.1", "9", "a", "f", "A", "F", " \t\r0"})
    EXPECT_TRUE(is_serial_line(text)) << text;
  for (const char* text : {"", " ", "(1.000000) x 001#", "g", "G", "/", ":", "@", "`"})
    EXPECT_FALSE(is_serial_line(text)) << text;
}

}  // namespace
}  // namespace ipos::tests
