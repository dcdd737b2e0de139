// Captures of Wireshark, tcpdump and others: pcap and pcapng with every unit of time, byte order, link type, with other
// interfaces beside CAN, CAN FD, cut packets. Expected values by hand from the drafts of the forms;
// logs_peers.py asks tshark about the same ones.
#include <gtest/gtest.h>

#include "tests/tools/taken_log.hpp"

namespace ipos::tests {
namespace {

using namespace ipos::tools;  // NOLINT: everything here is about logs
using runtime::kMillisecond;
using runtime::kSecond;

constexpr int64_t kBegin = 1'711'000'000;  // of 1970
const Frame kFrame(0x203, 8, {1, 2, 3, 4, 5, 6, 7, 8});

// A CAN frame as SocketCAN hands it over; the identifier in network order.
std::string can(uint32_t word, uint8_t flags = 0, size_t length = 8, size_t filled = 0) {
  std::string out = number(word, 4, true) + number(length, 1) + number(flags, 1) + number(0, 2);
  for (size_t n = 0; n < length; ++n) out += static_cast<char>(n + 1);
  return out + std::string(filled, '\0');
}

// pcapng in either byte order.
struct Capture {
  bool big = false;
  std::string bytes;

  explicit Capture(bool big_endian = false) : big(big_endian) { section(); }
  std::string num(uint64_t value, size_t size) const { return number(value, size, big); }
  Capture& block(uint32_t type, std::string body) {
    body.resize((body.size() + 3) / 4 * 4);
    const std::string size = num(body.size() + 12, 4);
    bytes += num(type, 4) + size + body + size;
    return *this;
  }
  Capture& section() {
    return block(0x0A0D0D0A, num(0x1A2B3C4D, 4) + num(1, 2) + num(0, 2) + num(UINT64_MAX, 8));
  }
  std::string option(uint16_t code, std::string value) const {
    const std::string head = num(code, 2) + num(value.size(), 2);
    value.resize((value.size() + 3) / 4 * 4);
    return head + value;
  }
  Capture& interface(uint16_t link, const std::string& options = {}) {
    return block(1, num(link, 2) + num(0, 2) + num(0, 4) + options);
  }
  Capture& packet(uint32_t on, uint64_t stamp, const std::string& data, size_t original = 0) {
    return block(6, num(on, 4) + num(stamp >> 32, 4) + num(stamp & UINT32_MAX, 4) + num(data.size(), 4) +
                        num(original == 0 ? data.size() : original, 4) + data);
  }
};

Time time_of(const Capture& capture) {
  const Taken got = taken(capture.bytes);
  EXPECT_TRUE(got.wrong.empty()) << got.wrong[0].second;
  EXPECT_EQ(got.can.size(), 1U);
  return got.can.empty() ? -1 : got.can[0].time;
}

// if_tsresol: powers of ten, or of two with bit 7. Parts of a nanosecond are cut off.
TEST(Captures, EveryUnitOfTime) {
  for (const bool big : {false, true}) {
    const auto at = [&](int resolution, uint64_t stamp) {
      Capture capture(big);
      return time_of(
          capture
              .interface(
                  227, resolution < 0 ? "" : capture.option(9, number(static_cast<uint64_t>(resolution), 1)))
              .packet(0, stamp, can(0x203)));
    };
    const auto begin = static_cast<uint64_t>(kBegin);
    EXPECT_EQ(at(-1, begin * 1'000'000 + 123'456), unix_time(kBegin, 123'456'000))
        << "microseconds without the option";
    EXPECT_EQ(at(0, begin), unix_time(kBegin));
    EXPECT_EQ(at(1, begin * 10 + 7), unix_time(kBegin, 700 * kMillisecond));
    EXPECT_EQ(at(3, begin * 1'000 + 123), unix_time(kBegin, 123 * kMillisecond));
    EXPECT_EQ(at(6, begin * 1'000'000 + 123'456), unix_time(kBegin, 123'456'000));
    EXPECT_EQ(at(9, begin * 1'000'000'000 + 123'456'789), unix_time(kBegin, 123'456'789));
    EXPECT_EQ(at(12, 1'000'000'000'500'000'999), unix_time(1'000'000, 500'000));
    EXPECT_EQ(at(15, 3'500'000'000'000'000), unix_time(3, 500 * kMillisecond));
    EXPECT_EQ(at(20, UINT64_MAX), unix_time(0, 184'467'440));
    EXPECT_EQ(at(127, UINT64_MAX), unix_time(0));
    EXPECT_EQ(at(0x80, begin), unix_time(kBegin));
    EXPECT_EQ(at(0x80 | 1, begin << 1 | 1), unix_time(kBegin, 500 * kMillisecond));
    EXPECT_EQ(at(0x80 | 10, begin << 10 | 256), unix_time(kBegin, 250 * kMillisecond));
    EXPECT_EQ(at(0x80 | 20, begin << 20 | 1), unix_time(kBegin, 953));
    EXPECT_EQ(at(0x80 | 30, begin << 30 | 1ULL << 29), unix_time(kBegin, 500 * kMillisecond));
    EXPECT_EQ(at(0x80 | 64, 1ULL << 63), unix_time(0, 500 * kMillisecond));
    EXPECT_EQ(at(0x80 | 127, UINT64_MAX), unix_time(0));
  }
}

TEST(Captures, AnOffsetIsAddedToTheTimes) {
  const auto at = [](int64_t offset, uint64_t stamp) {
    Capture capture;
    return capture.interface(227, capture.option(14, number(static_cast<uint64_t>(offset), 8)))
        .packet(0, stamp, can(0x203));
  };
  EXPECT_EQ(time_of(at(kBegin, 123'456)), unix_time(kBegin, 123'456'000));
  EXPECT_EQ(time_of(at(-3600, 7'200'000'000)), unix_time(3600));
  for (const int64_t offset : {int64_t{-1}, INT64_MIN, INT64_MAX, int64_t{9'000'000'001}})
    EXPECT_EQ(first_mistake(at(offset, 0).bytes), "x: byte 72: a time later than this project knows")
        << offset;
  EXPECT_EQ(time_of(at(9'000'000'000, 0)), unix_time(9'000'000'000));
}

// The interfaces of a section are gone in the next one, which may have another byte order.
TEST(Captures, TwoSections) {
  Capture first;
  first.interface(227, first.option(2, "one"))
      .interface(1)
      .packet(0, 1'000'000, can(0x203))
      .packet(1, 1, std::string(60, 'x'));
  Capture second(true);
  second.interface(227, second.option(2, "two") + second.option(9, number(9, 1)))
      .packet(0, 2'000'000'000, can(0x204));
  const Taken got = taken(first.bytes + second.bytes);
  EXPECT_TRUE(got.wrong.empty());
  ASSERT_EQ(got.can.size(), 2U);
  EXPECT_EQ(got.can[0], (LogEntry{unix_time(1), "one", kFrame}));
  EXPECT_EQ(got.can[1], (LogEntry{unix_time(2), "two", Frame(0x204, 8, kFrame.data)}));
  EXPECT_EQ(got.left_out.text(), "1 packet of another link type");
  const Taken turned = taken(second.bytes + first.bytes + second.bytes);
  EXPECT_TRUE(turned.wrong.empty()) << "the order of bytes goes back, too";
  ASSERT_EQ(turned.can.size(), 3U);
  EXPECT_EQ(turned.can[1], got.can[0]);
  EXPECT_EQ(turned.can[2].time, got.can[1].time);
  Capture third(true);
  third.packet(0, 1, can(0x203));
  EXPECT_EQ(taken(first.bytes + third.bytes).wrong.size(), 1U) << "no interface in the third section";
}

TEST(Captures, FdFramesAreNeverTakenForClassicOnes) {
  Capture capture;
  capture.interface(227);
  for (const uint8_t flags : {uint8_t{1}, uint8_t{2}, uint8_t{4}, uint8_t{7}})
    capture.packet(0, 0, can(0x20B, flags));
  capture.packet(0, 0, can(0x20B, 4, 12)).packet(0, 0, can(0x20B, 4, 0)).packet(0, 0, can(0x20B, 0, 8, 56));
  capture.packet(0, 0, can(0x20B, 0, 9));
  const Taken got = taken(capture.bytes);
  EXPECT_TRUE(got.wrong.empty());
  EXPECT_TRUE(got.can.empty());
  EXPECT_EQ(got.left_out.text(), "8 FD frames");
}

TEST(Captures, ClassicFramesOfEveryKind) {
  Capture capture;
  capture.interface(227)
      .packet(0, 0, can(0x203))
      .packet(0, 0, can(0x203, 0, 3, 5))
      .packet(0, 0, can(0x203, 0, 0));
  capture.packet(0, 0, can(0xC0000000U | 0x203, 0, 0))
      .packet(0, 0, can(0x40000203, 0, 4).substr(0, 8))
      .packet(0, 0, can(0x9FFFFFFF));
  capture.packet(0, 0, can(0x20000004))
      .packet(0, 0, can(0x800))
      .packet(0, 0, can(0x203).substr(0, 7))
      .packet(0, 0, can(0x203).substr(0, 15));
  const Taken got = taken(capture.bytes);
  std::vector<Frame> frames;
  for (const LogEntry& entry : got.can) frames.push_back(entry.frame);
  EXPECT_EQ(frames, (std::vector<Frame>{kFrame, Frame(0x203, 3, {1, 2, 3}), Frame(0x203, 0),
                                        Frame(0x203, 0, {}, true, true), Frame(0x203, 4, {}, false, true),
                                        Frame(0x1FFFFFFF, 8, kFrame.data, true)}));
  EXPECT_EQ(got.left_out.text(), "1 error frame");
  ASSERT_EQ(got.wrong.size(), 3U) << "a bad packet is told, and the next one is read";
  EXPECT_EQ(got.wrong[0].second, "no frame of classic CAN");
  EXPECT_EQ(got.wrong[1].second, "a CAN frame without head");
  EXPECT_EQ(got.wrong[2].second, "a CAN frame without all its data");
}

// editcap -s, dumpcap -s.
TEST(Captures, PacketsThatWereCut) {
  Capture capture;
  capture.interface(227).interface(147).interface(148).interface(113);
  for (const size_t size : {0U, 7U, 8U, 15U}) capture.packet(0, 0, can(0x203).substr(0, size), 16);
  capture.packet(1, 0, "\x02\x01", 10)
      .packet(2, 0, "\xDC", 3)
      .packet(3, 0, std::string(15, '\0'), 32)
      .packet(3, 0, std::string(14, '\0') + "\x00\x0C" + "x", 32);
  capture.packet(0, 0, can(0x203));
  const Taken got = taken(capture.bytes);
  EXPECT_TRUE(got.wrong.empty()) << got.wrong[0].second;
  EXPECT_EQ(got.can.size(), 1U);
  EXPECT_EQ(got.left_out.of(LeftOut::CutPacket) + got.left_out.of(LeftOut::OtherPacket), 8U);
}

TEST(Captures, OldAndSimpleBlocks) {
  for (const bool big : {false, true}) {
    Capture capture(big);
    capture.interface(1).interface(227);
    const uint64_t stamp = static_cast<uint64_t>(kBegin) * 1'000'000 + 5;
    capture.block(2, capture.num(1, 2) + capture.num(9, 2) + capture.num(stamp >> 32, 4) +
                         capture.num(stamp & UINT32_MAX, 4) + capture.num(16, 4) + capture.num(16, 4) +
                         can(0x203));
    capture.block(3, capture.num(16, 4) + can(0x204));
    capture.block(0x0BAD, "anything");
    const Taken got = taken(capture.bytes);
    EXPECT_TRUE(got.wrong.empty());
    EXPECT_EQ(got.can, (std::vector<LogEntry>{{unix_time(kBegin, 5'000), "can1", kFrame}}));
    EXPECT_EQ(got.left_out.text(), "1 packet without time");
  }
}

// "any" of Linux: the head says what the packet is; the identifier has the order of the machine, or that of the network.
TEST(Captures, OfAllInterfacesOfLinux) {
  const auto sll = [](uint16_t protocol, const std::string& frame) {
    return number(4, 2, true) + number(280, 2, true) + std::string(10, '\0') + number(protocol, 2, true) +
           frame;
  };
  const auto sll2 = [](uint16_t protocol, const std::string& frame) {
    return number(protocol, 2, true) + std::string(2, '\0') + number(3, 4, true) + number(280, 2, true) +
           std::string(10, '\0') + frame;
  };
  const auto swapped = [](uint32_t word) { return number(word, 4) + can(0).substr(4); };
  for (const bool big : {false, true}) {
    Capture capture(big);
    capture.interface(113).interface(276);
    capture.packet(0, 0, sll(0x0C, can(0x203)))
        .packet(1, 0, sll2(0x0C, can(0x203)))
        .packet(0, 0, sll(0x0C, can(0x92345678)));
    if (!big)
      capture.packet(0, 0, sll(0x0C, swapped(0x203)))
          .packet(1, 0, sll2(0x0C, swapped(0x98FEDA01)))
          .packet(0, 0, sll(0x0C, swapped(0x20000004)));
    capture.packet(0, 0, sll(0x0D, can(0x203)))
        .packet(1, 0, sll2(0x0E, can(0x203)))
        .packet(0, 0, sll(0x0C, can(0x203, 4)));
    capture.packet(0, 0, sll(0x800, std::string(40, 'x')));
    const Taken got = taken(capture.bytes);
    EXPECT_TRUE(got.wrong.empty()) << got.wrong[0].second;
    std::vector<uint32_t> ids;
    for (const LogEntry& entry : got.can) ids.push_back(entry.frame.id);
    EXPECT_EQ(ids, big ? (std::vector<uint32_t>{0x203, 0x203, 0x12345678})
                       : (std::vector<uint32_t>{0x203, 0x203, 0x12345678, 0x203, 0x18FEDA01}));
    EXPECT_EQ(got.left_out.text(), big ? "3 FD frames, 1 packet of another link type"
                                       : "1 error frame, 3 FD frames, 1 packet of another link type");
  }
}

// tcpdump: two byte orders, two units.
TEST(Captures, ClassicPcap) {
  for (const bool big : {false, true})
    for (const bool nano : {false, true}) {
      const auto num = [&](uint64_t value, size_t size) { return number(value, size, big); };
      const auto packet = [&](const std::string& data, size_t original) {
        return num(static_cast<uint64_t>(kBegin), 4) + num(123'456, 4) + num(data.size(), 4) +
               num(original, 4) + data;
      };
      const auto file = [&](uint32_t link) {
        return num(nano ? 0xA1B23C4D : 0xA1B2C3D4, 4) + num(2, 2) + num(4, 2) + num(0, 8) + num(65'535, 4) +
               num(link, 4);
      };
      const std::string log = file(227) + packet(can(0x203), 16) + packet(can(0x204, 4), 16) +
                              packet(can(0x203).substr(0, 9), 16) + packet(can(0x203), 16);
      const Taken got = taken(log);
      EXPECT_TRUE(got.wrong.empty()) << got.wrong[0].second;
      const LogEntry expected{unix_time(kBegin, nano ? 123'456 : 123'456'000), "can0", kFrame};
      EXPECT_EQ(got.can, (std::vector<LogEntry>{expected, expected}));
      EXPECT_EQ(got.left_out.text(), "1 FD frame, 1 packet cut by the capture");
      EXPECT_EQ(taken(file(227 | 0x10000000) + packet(can(0x203), 16)).can.size(), 1U)
          << "bits above the link type";
      EXPECT_EQ(taken(file(1) + packet(std::string(60, 'x'), 60)).left_out.text(),
                "1 packet of another link type");
      EXPECT_EQ(taken(file(147) + packet("\x02\x01", 2)).serial.size(), 1U);
      EXPECT_EQ(taken(file(227)).wrong.size(), 0U);
      // Cut anywhere: one mistake, unless between two packets.
      for (size_t size = 4; size < log.size(); ++size) {
        const size_t wrong = taken(log.substr(0, size)).wrong.size();
        EXPECT_EQ(wrong, size == 24 || size == 56 || size == 88 || size == 113 ? 0U : 1U) << size;
      }
    }
}

// A stranger's name of an interface: one word, cut, and two that were cut stay two.
TEST(Captures, NamesOfInterfaces) {
  Capture capture;
  const std::string name(64, 'n');
  capture.interface(227, capture.option(2, name))
      .interface(227, capture.option(2, name + "a"))
      .interface(227, capture.option(2, name + "b"));
  capture.interface(227, capture.option(2, "")).interface(227, capture.option(2, "a\x1B[2J b"));
  for (uint32_t n = 0; n < 5; ++n) capture.packet(n, 0, can(0x203));
  const Taken got = taken(capture.bytes);
  std::vector<std::string> buses;
  for (const LogEntry& entry : got.can) buses.push_back(entry.bus);
  EXPECT_EQ(buses, (std::vector<std::string>{name, name + "~1", name + "~2", "can3", "a_[2J_b"}));
}

// The longest telegram of RS-485 has 18 bytes.
TEST(Captures, TelegramsOfRs485) {
  Capture capture;
  capture.interface(147).packet(0, 0, std::string(18, '\x02'));
  EXPECT_EQ(taken(capture.bytes).serial.size(), 1U);
  capture.packet(0, 0, std::string(19, '\x02')).packet(0, 0, "\x02");
  const Taken got = taken(capture.bytes);
  EXPECT_EQ(got.serial.size(), 2U);
  ASSERT_EQ(got.wrong.size(), 1U);
  EXPECT_EQ(got.wrong[0].second, "more than 18 bytes, the longest telegram");
}

}  // namespace
}  // namespace ipos::tests
