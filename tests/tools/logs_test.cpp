// Logs of other tools: samples in the forms as their tools print them, what is written read again, and a
// thousand damaged files of each form.
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <random>
#include <sstream>

#include "tests/tools/taken_log.hpp"
#include "tools/logs/log_findings.hpp"
#include "tools/logs/log_writer.hpp"

namespace ipos::tests {
namespace {

using namespace ipos::tools;  // NOLINT: everything here is about logs

// Frames of every length and kind on two buses, a little apart.
std::vector<LogEntry> frames() {
  std::vector<LogEntry> all;
  for (uint8_t n = 0; n < 40; ++n) {
    Frame frame(n % 3 == 0 ? 0x1ABCDE00U + n : 0x200U + n, static_cast<uint8_t>(n % 9));
    frame.extended = n % 3 == 0;
    frame.remote = n % 10 == 7;
    for (uint8_t byte = 0; byte < frame.length && !frame.remote; ++byte)
      frame.data[byte] = static_cast<uint8_t>(n * 7 + byte);
    all.push_back({n * 1'234 * runtime::kMicrosecond, n % 4 == 3 ? "can2" : "can1", frame});
  }
  return all;
}

std::string written(const char* name) {
  std::ostringstream out;
  {
    const auto writer = make_log_writer(name, out);
    for (const LogEntry& entry : frames()) writer->can(entry.time, entry.bus, entry.frame);
  }
  return out.str();
}

// The frames in containers of `chunk` bytes, so that objects lie across their ends.
std::string blf(size_t chunk, bool compressed) {
  std::string objects;
  for (const LogEntry& entry : frames()) {
    const Frame& frame = entry.frame;
    std::string body = "LOBJ" + number(32, 2) + number(1, 2) + number(48, 4) + number(86, 4);
    body += number(2, 4) + number(0, 4) + number(static_cast<uint64_t>(entry.time), 8);  // ns
    body +=
        number(entry.bus == "can2" ? 2 : 1, 2) + number(frame.remote ? 0x80 : 0, 1) + number(frame.length, 1);
    body += number(frame.id | (frame.extended ? 0x80000000U : 0), 4);
    body.append(frame.data.begin(), frame.data.end());
    objects += body;
  }
  std::string file = "LOGG" + number(144, 4) + std::string(32, '\0');
  for (const unsigned word : {2000U, 1U, 6U, 1U, 0U, 0U, 0U, 0U})
    file += number(word, 2);  // Saturday, 1 January 2000
  file.resize(144);
  for (size_t at = 0; at < objects.size(); at += chunk) {
    const std::string part = objects.substr(at, chunk);
    std::string packed = part;
    if (compressed) {
      uLongf size = compressBound(part.size());
      packed.resize(size);
      compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(part.data()),
               part.size());
      packed.resize(size);
    }
    file += blf_object(10, number(compressed ? 2 : 0, 2) + std::string(6, '\0') + number(part.size(), 4) +
                               std::string(4, '\0') + packed);
    file.append((4 - file.size() % 4) % 4, '\0');
  }
  return file;
}

TEST(Logs, WhatIsWrittenIsReadAgain) {
  for (const char* name : {"a.log", "a.pcapng", "a.asc", "a.trc"}) {
    const Taken got = taken(written(name));
    EXPECT_TRUE(got.wrong.empty()) << name << ": " << got.wrong.front().second;
    EXPECT_EQ(got.can, frames()) << name;
  }
}

TEST(Logs, PcapngKeepsNanosecondsTelegramsAndTheirErrors) {
  std::ostringstream out;
  const auto writer = make_log_writer("a.pcapng", out);
  writer->can(123'456'789, "sbus one", Frame(5, 1, {9}));
  runtime::Reception good{{}, {}, 1'000'001, 2'000'000};
  for (const int byte : {0x02, 0x05, 0x86, 0x31, 0x00, 0x20, 0x7E, 0, 0, 0, 0})
    good.bytes.push(static_cast<uint8_t>(byte));
  good.bytes.push(runtime::block_check(good.bytes.span()));
  good.telegram = runtime::decode_serial(good.bytes.span());
  ASSERT_TRUE(good.telegram);
  writer->serial("line1", good);
  runtime::Reception bad = good;
  bad.telegram = tl::unexpected(runtime::SerialError::Parity);
  writer->serial("line1", bad);
  const profibus::Octets token{0xDC, 2, 1};
  writer->dp("dp", runtime::reception_of(token, 7, 8, std::nullopt));
  writer->dp("dp", runtime::reception_of(token, 9, 10, profibus::FrameError::Parity));
  const Taken got = taken(out.str());
  EXPECT_TRUE(got.wrong.empty());
  ASSERT_EQ(got.can.size(), 1U);
  EXPECT_EQ(got.can[0].time, 123'456'789);
  EXPECT_EQ(got.can[0].bus, "sbus_one") << "a name of a bus has no blanks in other logs";
  ASSERT_EQ(got.serial.size(), 2U);
  EXPECT_EQ(got.serial[0].time, 1'000'001);
  EXPECT_TRUE(got.serial[0].reception.telegram == good.telegram);
  ASSERT_FALSE(got.serial[1].reception.telegram);
  EXPECT_EQ(got.serial[1].reception.telegram.error(), runtime::SerialError::Parity);
  ASSERT_EQ(got.dp.size(), 2U);
  for (const runtime::ProfibusEntry& entry : got.dp) EXPECT_EQ(entry.reception.octets, token);
  EXPECT_EQ(got.dp[0].reception.start, 7);
  EXPECT_TRUE(got.dp[0].reception.frame);
  ASSERT_FALSE(got.dp[1].reception.frame) << "a parity error is not in the octets";
  EXPECT_EQ(got.dp[1].reception.frame.error(), profibus::FrameError::Parity);
}

// A keypad's line is named after its station, so a bus may have that name, too.
TEST(Logs, BusesOfTwoKindsWithOneNameStayApart) {
  std::ostringstream out;
  const auto writer = make_log_writer("a.pcapng", out);
  runtime::Reception telegram{{}, {}, 1, 2};
  telegram.bytes.push(0x02);
  telegram.telegram = tl::unexpected(runtime::SerialError::Timeout);
  for (int n = 0; n < 2; ++n) {
    writer->serial("a.keypad", telegram);
    writer->can(3, "a.keypad", Frame(5, 1, {9}));
    writer->dp("a.keypad", runtime::reception_of({0xE5}, 7, 8, std::nullopt));
  }
  const Taken got = taken(out.str());
  EXPECT_TRUE(got.wrong.empty());
  EXPECT_EQ(got.can.size(), 2U);
  EXPECT_EQ(got.serial.size(), 2U);
  EXPECT_EQ(got.dp.size(), 2U);
}

// Wireshark takes any text as the name of an interface; a line of a log ends its name at a blank.
TEST(Logs, NoNameOfAnInterfaceBreaksALineOfALog) {
  for (int c = 0; c < 256; ++c) {
    std::ostringstream out;
    make_log_writer("a.pcapng", out)->can(0, std::string("a") + static_cast<char>(c) + "b", Frame(0x100, 0));
    const Taken read = taken(out.str());
    ASSERT_EQ(read.can.size(), 1U) << c;
    std::ostringstream lines;
    make_log_writer("a.log", lines)->can(0, read.can[0].bus, read.can[0].frame);
    const Taken again = taken(lines.str());
    ASSERT_TRUE(again.wrong.empty()) << c << ": " << again.wrong[0].second;
    EXPECT_EQ(again.can[0].bus, read.can[0].bus) << c;
    EXPECT_EQ(read.can[0].bus == "a_b", c <= ' ' || c == '_' || c == 0x7F) << c;
  }
}

// As the descriptions of the forms want it, byte by byte: a remote frame has no data, and times their unit.
TEST(Logs, WhatIsWrittenByTheLetter) {
  const auto text = [](const char* name) {
    std::ostringstream out;
    {
      const auto writer = make_log_writer(name, out);
      writer->can(61 * runtime::kSecond + 2'003 * runtime::kMicrosecond, "a",
                  Frame(0x12ABCDE, 2, {1, 0xAB}, true));
      writer->can(62 * runtime::kSecond, "b", Frame(0x203, 5, {1, 2, 3, 4, 5}, false, true));
    }
    return out.str();
  };
  EXPECT_NE(text("a.asc").find(
                "\n  61.002003 1  12ABCDEx        Rx   d 2 01 AB\n  62.000000 2  203             Rx   r 5\n"),
            std::string::npos)
      << text("a.asc");
  EXPECT_TRUE(
      text("a.asc").starts_with("date Sat Jan 01 12:00:00.000 am 2000\nbase hex  timestamps absolute\n"));
  EXPECT_NE(text("a.trc").find("\n      1     61002.003 DT  1 012ABCDE Rx -  2    01 AB\n      2     "
                               "62000.000 RR  2     0203 Rx -  5   \n"),
            std::string::npos)
      << text("a.trc");
  EXPECT_EQ(text("a.log"), "(0946684861.002003) a 012ABCDE#01AB\n(0946684862.000000) b 203#R5\n");
  // The packet of the remote frame is its head of eight bytes: 28 + 40 of the block.
  const std::string capture = text("a.pcapng");
  EXPECT_EQ(capture.substr(capture.size() - 40, 8), number(6, 4) + number(40, 4));
  EXPECT_EQ(capture.substr(capture.size() - 12, 8), number(0x40000203, 4, true) + number(5, 4));
}

// Of equal mistakes twenty are printed, of others all; the sum stands at the end.
TEST(Logs, FindingsOfALog) {
  LogFindings findings("a\x1B.log");
  size_t frames = 0;
  const LogReader reader = findings.watch({[&](const LogEntry&, LogPlace) { ++frames; },
                                           [](const auto&, LogPlace) {},
                                           [](const auto&, LogPlace) {},
                                           {}});
  std::string log;
  for (int n = 0; n < 22; ++n) log += "nonsense\n";
  testing::internal::CaptureStderr();
  read_log(log + "(1.000000) can0 203#\n(1.000000) can0 203#0\n(1.000000) can0 203##0\n", reader);
  EXPECT_FALSE(findings.finish());
  const std::string told = testing::internal::GetCapturedStderr();
  std::string expected;
  for (int n = 1; n <= 20; ++n) expected += "a?.log:" + std::to_string(n) + ":1: error: '(' expected\n";
  EXPECT_EQ(told, expected +
                      "a?.log: note: more mistakes of this kind are only counted\n"
                      "a?.log:24:22: error: second hexadecimal digit of a data byte expected\n"
                      "a?.log: note: 1 FD frame, 23 lines not understood left out\n");
  EXPECT_EQ(frames, 1U);
}

// Binary logs have no lines: a mistake of theirs is told once and is no line that was left out. A capture of Ethernet alone is
// no log of a bus.
TEST(Logs, FindingsOfACapture) {
  const auto told = [](const std::string& log) {
    LogFindings findings("a.pcap");
    const LogReader reader = findings.watch(
        {[](const LogEntry&, LogPlace) {}, [](const auto&, LogPlace) {}, [](const auto&, LogPlace) {}, {}});
    testing::internal::CaptureStderr();
    read_log(log, reader);
    const bool good = findings.finish();
    return testing::internal::GetCapturedStderr() + (good ? "good" : "bad");
  };
  const auto head = [](uint32_t link) { return number(0xA1B2C3D4, 4) + std::string(16, '\0') + number(link, 4); };
  const auto packet = [](const std::string& data) {
    return number(1, 4) + number(0, 4) + number(data.size(), 4) + number(data.size(), 4) + data;
  };
  const std::string good = packet(number(0x203, 4, true) + std::string(4, '\0'));
  const std::string bad = packet(number(0x800, 4, true) + std::string(4, '\0'));
  EXPECT_EQ(told(head(227) + good), "good");
  EXPECT_EQ(told(head(227) + good + good.substr(1, 9)),
            "a.pcap: byte 48: error: the file ends within a packet\nbad");
  EXPECT_EQ(told(head(227) + bad + bad), "a.pcap: byte 24: error: no frame of classic CAN\n"
                                         "a.pcap: byte 48: error: no frame of classic CAN\nbad");
  EXPECT_EQ(told(head(1) + good + good),
            "a.pcap: error: no bus is in this capture: 2 packets of other link types\nbad");
  EXPECT_EQ(told(head(227)), "good") << "a bus that was silent";
}

TEST(Logs, BlfWithContainersThatCutObjects) {
  for (const size_t chunk : {5'000U, 700U, 48U, 33U})
    for (const bool compressed : {true, false}) {
      const Taken got = taken(blf(chunk, compressed));
      EXPECT_TRUE(got.wrong.empty()) << chunk << ": " << got.wrong.front().second;
      EXPECT_EQ(got.can, frames()) << chunk;
    }
}

// As Vector's tools write it: a date with pm, other events, what follows the data.
TEST(Logs, AscAsOthersWriteIt) {
  const Taken got = taken(
      "date Sat Jan 1 01:00:00.500 pm 2000\n"
      "base hex  timestamps absolute\n"
      "internal events logged\n"
      "// version 9.0.0\n"
      "Begin Triggerblock Sat Jan 1 01:00:00.500 pm 2000\n"
      "   0.000000 Start of measurement\n"
      "   0.000100 1  605             Rx   d 8 40 00 18 02 00 00 00 00  Length = 240000 BitCount = 124 ID = "
      "1541\n"
      "   0.200000 2  18EBFF00x       Tx   d 2 01 A0\n"
      "   0.250000 1  Statistic: D 0 R 0 XD 0 XR 0 E 0 O 0 B 0.00%\n"
      "   0.300000 1  ErrorFrame\n"
      "   0.400000 CAN 1 Status:chip status error active\n"
      "   1.000001 1  5               Rx   r\n"
      "End TriggerBlock\n");
  EXPECT_TRUE(got.wrong.empty()) << got.wrong.front().second;
  const Time begin = 13 * 3600 * runtime::kSecond + 500 * runtime::kMillisecond;
  const std::vector<LogEntry> expected{
      {begin + 100 * runtime::kMicrosecond, "can1", Frame(0x605, 8, {0x40, 0, 0x18, 2})},
      {begin + 200 * runtime::kMillisecond, "can2", Frame(0x18EBFF00, 2, {1, 0xA0}, true)},
      {begin + runtime::kSecond + runtime::kMicrosecond, "can1", Frame(5, 0, {}, false, true)}};
  EXPECT_EQ(got.can, expected);
  const Taken relative = taken(
      "date Sat Jan 01 00:00:00 2000\nbase dec timestamps relative\n0.5 1 100 Rx d 1 255\n0.25 1 101 Rx d "
      "0\n");
  const std::vector<LogEntry> steps{{500 * runtime::kMillisecond, "can1", Frame(100, 1, {255})},
                                    {750 * runtime::kMillisecond, "can1", Frame(101, 0)}};
  EXPECT_EQ(relative.can, steps);
}

// The examples of PEAK's description of the format.
TEST(Logs, TrcOfSeveralVersions) {
  const Taken first = taken(
      ";$FILEVERSION=1.1\n;$STARTTIME=36526.5\n;\n"
      "     1)         1.3  Rx         0300  3  00 01 FF\n"
      "     2)         2.0  Warng  FFFFFFFF  4  00 00 00 08  BUSHEAVY\n"
      "     3)       100.1  Tx     18EFC034  2  0A 0B\n"
      "     4)       200.0  Rx         0300  8  RTR\n");
  EXPECT_TRUE(first.wrong.empty()) << first.wrong.front().second;
  const Time noon = 12 * 3600 * runtime::kSecond;
  const auto ms = [](int64_t tenths) { return tenths * 100 * runtime::kMicrosecond; };
  EXPECT_EQ(first.can, (std::vector<LogEntry>{{noon + ms(13), "can1", Frame(0x300, 3, {0, 1, 0xFF})},
                                              {noon + ms(1001), "can1", Frame(0x18EFC034, 2, {10, 11}, true)},
                                              {noon + ms(2000), "can1", Frame(0x300, 8, {}, false, true)}}));
  const Taken second = taken(
      ";$FILEVERSION=2.1\n;$STARTTIME=36526.0\n;$COLUMNS=N,O,T,B,I,d,R,L,D\n"
      "      1        40.000 DT  1      0605 Rx -  8    40 00 18 02 00 00 00 00\n"
      "      2        41.250 ST  1    -      Rx -  4    00 00 00 00\n"
      "      3        42.001 RR  2  1FFFFFFF Tx -  2\n");
  EXPECT_TRUE(second.wrong.empty()) << second.wrong.front().second;
  EXPECT_EQ(second.can,
            (std::vector<LogEntry>{{40 * runtime::kMillisecond, "can1", Frame(0x605, 8, {0x40, 0, 0x18, 2})},
                                   {42 * runtime::kMillisecond + runtime::kMicrosecond, "can2",
                                    Frame(0x1FFFFFFF, 2, {}, true, true)}}));
}

TEST(Logs, MistakesHaveTheirPlace) {
  const auto first = [](const std::string& log) {
    const Taken got = taken(log);
    return got.wrong.empty() ? "nothing" : place_text("x", got.wrong[0].first) + ": " + got.wrong[0].second;
  };
  const std::string asc = "date Sat Jan 01 00:00:00 2000\n";
  EXPECT_EQ(first(asc + "0.1 1 800 Rx d 1 00\n"), "x:2:7: identifier too large");
  EXPECT_EQ(first(asc + "0.1 1 100 Rx d 2 00\n"), "x:2:20: data byte 2 of 2 expected");
  EXPECT_EQ(first(asc + "0.1x 1 100 Rx d 2 00\n"), "x:2:1: time in seconds expected");
  EXPECT_EQ(first(";$FILEVERSION=1.1\n 1) 1.0 Rx 0300 16 00\n"),
            "x:2:17: length of 0 to 8, or a DLC up to 15, expected");
  EXPECT_EQ(first(";$COLUMNS=\n"), "x:1:11: columns expected, for example N,O,T,I,d,l,D");
  std::string pcapng = written("a.pcapng");
  EXPECT_EQ(first(pcapng.substr(0, pcapng.size() - 1)).substr(0, 8), "x: byte ");
  pcapng[28 + 8] = 105;  // link type of the first interface: IEEE 802.11
  EXPECT_EQ(first(pcapng), "nothing");
  EXPECT_EQ(taken(pcapng).left_out.text(), "30 packets of other link types");
  EXPECT_EQ(first("LOGG"), "x: byte 0: the file ends within its head");
}

// What a killed run leaves: everything up to the last whole line or block is read.
TEST(Logs, TheBeginningOfALogIsALog) {
  for (const char* name : {"a.log", "a.pcapng", "a.asc", "a.trc"}) {
    const std::string log = written(name);
    size_t most = 0;
    for (size_t size = 0; size <= log.size(); size += 37) {
      const Taken got = taken(log.substr(0, size));
      EXPECT_LE(got.wrong.size(), 1U) << name;
      ASSERT_LE(got.can.size(), frames().size());
      // A line that was cut off in its data may read as a shorter one; all before it are whole.
      for (size_t n = 0; n + 1 < got.can.size(); ++n) ASSERT_EQ(got.can[n], frames()[n]) << name;
      EXPECT_GE(got.can.size() + 1, most) << name;
      most = std::max(most, got.can.size());
    }
    EXPECT_GE(most + 2, frames().size()) << name;
  }
}

TEST(Logs, AThousandDamagedFilesOfEachForm) {
  std::mt19937 draw(11);
  const auto below = [&](size_t limit) { return std::uniform_int_distribution<size_t>(0, limit - 1)(draw); };
  const std::pair<const char*, std::string> logs[] = {
      {"candump", written("a.log")}, {"pcapng", written("a.pcapng")}, {"ASC", written("a.asc")},
      {"TRC", written("a.trc")},     {"BLF", blf(700, true)},         {"BLF, plain", blf(700, false)}};
  for (const auto& [name, log] : logs) {
    size_t told = 0;
    for (int file = 0; file < 1000; ++file) {
      std::string damaged = log;
      for (size_t times = 1 + below(4); times > 0 && !damaged.empty(); --times) {
        const size_t at = below(damaged.size());
        const size_t kind = below(4);
        if (kind == 0)
          damaged[at] = static_cast<char>(below(256));
        else if (kind == 1)
          damaged.erase(at, 1 + below(20));
        else if (kind == 2)
          damaged.insert(at, damaged, below(damaged.size()), below(30));
        else
          damaged.resize(at);
      }
      const Taken got = taken(damaged);
      told += got.wrong.empty() ? 0 : 1;
      const auto lines = static_cast<size_t>(std::count(damaged.begin(), damaged.end(), '\n')) + 1;
      for (const auto& [place, text] : got.wrong) {
        EXPECT_FALSE(text.empty());
        EXPECT_LE(place.line, lines) << name;
        EXPECT_LE(place.column, damaged.size() + 1) << name;
      }
      for (const LogEntry& entry : got.can) EXPECT_TRUE(is_valid(entry.frame));
    }
    EXPECT_GT(told, 400U) << name;
  }
}

}  // namespace
}  // namespace ipos::tests
