// candump logs: the format other tools read, and located errors for what is not such a log.
#include "runtime/bus/log/candump.hpp"

#include <gtest/gtest.h>

#include <random>
#include <sstream>

#include "runtime/bus/can/identifier_text.hpp"
#include "runtime/bus/can/line.hpp"

namespace ipos::runtime {
namespace {

TEST(Candump, LinesAsCanUtilsWritesThem) {
  EXPECT_EQ(candump_line(0, "sbus", {0x40B, 3, {0x12, 0x00, 0xFF}, false, false}),
            "(0946684800.000000) sbus 40B#1200FF");
  EXPECT_EQ(candump_line(kSecond + 234'567 * kMicrosecond + 999, "can0", {5, 0, {}, false, false}),
            "(0946684801.234567) can0 005#");
  EXPECT_EQ(candump_line(0, "x", {0x12345, 1, {0xAB}, true, false}), "(0946684800.000000) x 00012345#AB");
  EXPECT_EQ(candump_line(0, "x", {0x701, 0, {}, false, true}), "(0946684800.000000) x 701#R");
  EXPECT_EQ(candump_line(0, "x", {0x701, 4, {}, false, true}), "(0946684800.000000) x 701#R4");
}

// As candump writes them: %03X, of 29 bits %08X (can-utils, lib.c).
TEST(Candump, IdentifiersAsPeopleReadThem) {
  EXPECT_EQ(id_text(0), "000");
  EXPECT_EQ(id_text(300), "12C");
  EXPECT_EQ(id_text(2047), "7FF");
  EXPECT_EQ(id_text(300, true), "0000012C");
  EXPECT_EQ(id_text(0x18DA'F110, true), "18DAF110");
  EXPECT_EQ(id_words(11), "00Bh (11)");
  EXPECT_EQ(id_words(300), "12Ch (300)");
  EXPECT_EQ(id_words(7, true), "00000007h (7)");
}

TEST(Candump, ReadsWhatOtherToolsWrite) {
  const auto log = parse_candump(
      "(1700000000.000001) vcan0 20B#3100207E00000000\r\n\n"
      "(1700000000.5) vcan0 1#\n");
  ASSERT_FALSE(log.has_value());
  EXPECT_EQ(log.error().line, 3U);
  const auto good = parse_candump(
      "(1700000000.000001) vcan0 20B#3100207E00000000\n(0.000000) a 7ff#de R\n"
      "(946684800.000010) b 1FFFFFFF#R8");
  ASSERT_TRUE(good.has_value());
  ASSERT_EQ(good->size(), 3U);
  EXPECT_EQ((*good)[0].frame, (Frame{523, 8, {0x31, 0, 0x20, 0x7E, 0, 0, 0, 0}, false, false}));
  EXPECT_EQ((*good)[0].time, (1'700'000'000 - 946'684'800) * kSecond + kMicrosecond);
  EXPECT_EQ((*good)[1].frame, (Frame{0x7FF, 1, {0xDE}, false, false}));
  EXPECT_EQ((*good)[2].frame, (Frame{0x1FFFFFFF, 8, {}, true, true}));
  EXPECT_EQ((*good)[2].time, 10 * kMicrosecond);
}

TEST(Candump, ErrorsAreLocated) {
  struct Case {
    const char* text;
    size_t column;
    const char* message;
  };
  const Case cases[] = {
      {"x", 1, "'(' expected"},
      {"(12.000000", 11, "')' expected"},
      {"(-1.000000) a 001#", 2, "digit expected"},
      {"(99999999999.000000) a 001#", 2, "too large"},
      {"(1.0000) a 001#", 4, "six digits"},
      {"(1.00000) a 001#", 4, "six digits"},
      {"(1.0000000000) a 001#", 4, "six digits"},
      {"(1.9999999999) a 001#", 4, "number too large"},
      {"(1.x00000) a 001#", 4, "digit expected"},
      {"(9000000001.000000) a 001#", 2, "number too large"},
      {"(1.000000)a 001#", 11, "blank expected"},
      {"(1.000000) ", 12, "interface name"},
      {"(1.000000) a", 13, "blank expected"},
      {"(1.000000) a 01#", 14, "identifier"},
      {"(1.000000) a 800#", 14, "identifier"},
      {"(1.000000) a 20000000#", 14, "identifier"},
      {"(1.000000) a 123456789#", 14, "identifier"},
      {"(1.000000) a 001", 17, "'#' expected"},
      {"(1.000000) a 001##0", 18, "CAN FD"},
      {"(1.000000) a 001#1", 19, "second hexadecimal digit"},
      {"(1.000000) a 001#112233445566778899", 34, "more than 8"},
      {"(1.000000) a 001#1122x", 22, "end of data"},
      {"(1.000000) a 001#R9", 19, "end of data"},
      {"(1.000000) a 001#11 R x", 23, "end of line"},
  };
  for (const Case& c : cases) {
    const auto entry = parse_candump_line(c.text, 7);
    ASSERT_FALSE(entry.has_value()) << c.text;
    EXPECT_EQ(entry.error().line, 7U);
    EXPECT_EQ(entry.error().column, c.column) << c.text << ": " << entry.error().message;
    EXPECT_NE(entry.error().message.find(c.message), std::string::npos)
        << c.text << ": " << entry.error().message;
  }
}

// Of candump -N, and of tools that write other parts of a second (can-utils#592, #313).
TEST(Candump, StampsOfUpToNineDigits) {
  const auto time = [](const char* text) { return parse_candump_line(text)->time + kCandumpEpoch; };
  EXPECT_EQ(time("(1.000001) a 001#"), kSecond + kMicrosecond);
  EXPECT_EQ(time("(1.0000001) a 001#"), kSecond + 100);
  EXPECT_EQ(time("(1.00000001) a 001#"), kSecond + 10);
  EXPECT_EQ(time("(1.000000001) a 001#"), kSecond + 1);
  EXPECT_EQ(time("(1.999999999) a 001#"), 2 * kSecond - 1);
}

// What canplayer takes: small r, points between bytes, a DLC above 8 behind the data.
TEST(Candump, DataAsCanUtilsTakesIt) {
  for (const char* text : {"(1.000000) a 001#11.22", "(1.000000) a 001#1122"})
    EXPECT_EQ(parse_candump_line(text)->frame, (Frame{1, 2, {0x11, 0x22}})) << text;
  EXPECT_EQ(parse_candump_line("(1.000000) a 001#r4")->frame, (Frame{1, 4, {}, false, true}));
  EXPECT_EQ(parse_candump_line("(1.000000) a 001#0102030405060708_9")->frame,
            (Frame{1, 8, {1, 2, 3, 4, 5, 6, 7, 8}}));
  EXPECT_EQ(parse_candump_line("(1.000000) a 001#R8_F")->frame, (Frame{1, 8, {}, false, true}));
  for (const char* text : {"(1.000000) a 001#0102030405060708_8", "(1.000000) a 001#01_9",
                           "(1.000000) a 001#R_9", "(1.000000) a 001#.01", "(1.000000) a 001#01."})
    EXPECT_FALSE(parse_candump_line(text)) << text;
}

TEST(Candump, RoundTripAndRandomBytes) {
  std::mt19937 random(6);
  for (int i = 0; i < 5000; ++i) {
    Frame frame;
    frame.extended = random() % 2 == 0;
    frame.remote = random() % 4 == 0;
    frame.id = static_cast<uint32_t>(random() % (frame.extended ? kExtendedIdLimit : kStandardIdLimit));
    frame.length = static_cast<uint8_t>(random() % 9);
    for (uint8_t& byte : frame.data) byte = static_cast<uint8_t>(random());
    const Frame sent = canonical(frame);
    const Time time = static_cast<Time>(random()) * kMicrosecond;
    const std::string line = candump_line(time, "bus", sent);
    const auto entry = parse_candump_line(line);
    ASSERT_TRUE(entry.has_value()) << line;
    ASSERT_EQ(*entry, (LogEntry{time, "bus", sent}));
    std::string damaged = line;
    damaged[random() % damaged.size()] = static_cast<char>(random());
    damaged.resize(random() % (damaged.size() + 1));
    (void)parse_candump(damaged);  // any answer, but no crash
  }
}

TEST(Candump, LogOfALineHasTheTimeOfDelivery) {
  class Silent final : public CanNode {
    void on_frame(Time, const Frame&) override {}
    void on_sent(Time, const Frame&, uint64_t) override {}
    void on_not_sent(Time, const Frame&, uint64_t, NotSent) override {}
  };
  EventQueue queue;
  CanLine line(queue, 0, "sbus", 125'000);
  std::ostringstream text;
  CandumpLog log(text);
  line.add_observer(log);
  Silent a;
  Silent b;
  const NodeId node = line.attach("a", 125'000, a);
  line.attach("b", 125'000, b);
  line.send(node, Frame{0x555, 0, {}, false, false}, 0);
  queue.run_until(kSecond);
  // Bit 1 to the end of frame: 47 - 3 bits and the stuff bits; 555h has none before the length field.
  const auto entry = parse_candump(text.str());
  ASSERT_TRUE(entry.has_value());
  ASSERT_EQ(entry->size(), 1U);
  EXPECT_GE((*entry)[0].time, (1 + 44) * 8 * kMicrosecond);
  EXPECT_LE((*entry)[0].time, (1 + 52) * 8 * kMicrosecond);
}

}  // namespace
}  // namespace ipos::runtime
