// Logs as candump and PEAK's tools write them, beside what is plain: other frames, other stamps, marks of editors; and files
// that are no logs. Expected values by hand, from the descriptions of the forms and the sources of can-utils and python-can.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/tools/taken_log.hpp"

namespace ipos::tests {
namespace {

using namespace ipos::tools;  // NOLINT: everything here is about logs
using runtime::kMicrosecond;
using runtime::kMillisecond;
using runtime::kSecond;

const Frame kRequest(0x203, 8, {0x31, 0, 0x20, 0x7E});

std::vector<LogEntry> at(Time time, const Frame& frame, const char* bus = "can0") {
  return {{time, bus, frame}};
}

TEST(CandumpForms, FramesThatAreNoneOfClassicCanAreLeftOutAndCounted) {
  const Taken got = taken(
      "# recorded by hand\n"
      "(1711000000.000000) can0 203#3100207E00000000\n"
      "(1711000000.001000) can0 20000008#0000020000000000\n"
      "(1711000000.001000) can0 20000080#0000000000000000\n"
      "(1711000000.001000) can0 3FFFFFFF#\n"
      "(1711000000.002000) can0 203##1AABBCC\n"
      "(1711000000.002000) can0 12345678##0\n"
      "// note\n"
      "(1711000000.010000) can0 203#3100207E00000000\n");
  EXPECT_TRUE(got.wrong.empty()) << got.wrong[0].second;
  EXPECT_EQ(got.can.size(), 2U);
  EXPECT_EQ(got.left_out.text(), "3 error frames, 2 FD frames");
  // What only looks like them is a mistake.
  for (const char* line :
       {"(1.000000) can0 40000008#00", "(1.000000) can0 2000008##1", "(1.000000) can0 20000008"}) {
    const Taken bad = taken(line);
    EXPECT_EQ(bad.wrong.size(), 1U) << line;
    EXPECT_EQ(bad.left_out.total(), 0U) << line;
  }
}

TEST(CandumpForms, StampsOfSixToNineDigits) {
  EXPECT_EQ(taken("(1711000000.123456) can0 203#3100207E00000000").can,
            at(unix_time(1'711'000'000, 123'456'000), kRequest));
  EXPECT_EQ(taken("(1711000000.1234567) can0 203#3100207E00000000").can,
            at(unix_time(1'711'000'000, 123'456'700), kRequest));
  EXPECT_EQ(taken("(1711000000.12345678) can0 203#3100207E00000000").can,
            at(unix_time(1'711'000'000, 123'456'780), kRequest));
  EXPECT_EQ(taken("(1711000000.123456789) can0 203#3100207E00000000").can,
            at(unix_time(1'711'000'000, 123'456'789), kRequest));
  EXPECT_EQ(taken("(1711000000.000000001) can0 203#3100207E00000000").can,
            at(unix_time(1'711'000'000, 1), kRequest));
  EXPECT_EQ(first_mistake("(1711000000.12345) can0 203#"),
            "x:1:13: six digits of microseconds, or up to nine, expected");
  EXPECT_EQ(first_mistake("(1711000000.1234567890) can0 203#"), "x:1:13: number too large");
  EXPECT_EQ(first_mistake("(1711000000.0000000001) can0 203#"),
            "x:1:13: six digits of microseconds, or up to nine, expected");
}

// can-utils, lib.c: points between bytes, R or r with a length, and a DLC above 8 behind "_".
TEST(CandumpForms, DataInEveryForm) {
  for (const char* data : {"3100207E00000000", "31.00.20.7E.00.00.00.00", "3100.207E.00000000",
                           "3100207E00000000_E", "3100207E00000000_9", "3100207E00000000_f R"})
    EXPECT_EQ(taken("(1.000000) can0 203#" + std::string(data)).can, at(unix_time(1), kRequest)) << data;
  for (const auto& [data, length] : {std::pair("R", 0), {"r", 0}, {"r8", 8}, {"R8_C", 8}, {"r3", 3}})
    EXPECT_EQ(taken("(1.000000) can0 203#" + std::string(data)).can,
              at(unix_time(1), Frame(0x203, static_cast<uint8_t>(length), {}, false, true)))
        << data;
  EXPECT_EQ(first_mistake("(1.000000) can0 203#.31"), "x:1:21: end of data expected");
  EXPECT_EQ(first_mistake("(1.000000) can0 203#31."), "x:1:24: hexadecimal data byte expected");
  EXPECT_EQ(first_mistake("(1.000000) can0 203#31..00"), "x:1:24: hexadecimal data byte expected");
  EXPECT_EQ(first_mistake("(1.000000) can0 203#3100207E00000000.00"), "x:1:38: more than 8 data bytes");
  for (const char* data :
       {"3100207E000000_E", "3100207E00000000_8", "3100207E00000000_", "3100207E00000000_G", "R_9", "R7_9"})
    EXPECT_EQ(taken("(1.000000) can0 203#" + std::string(data)).wrong.size(), 1U) << data;
}

TEST(CandumpForms, OfATerminal) {
  const std::string data = "203   [8]  31 00 20 7E 00 00 00 00";
  EXPECT_EQ(taken("  can0  " + data + "\n").can, at(-runtime::kCandumpEpoch, kRequest))
      << "no time is second 0 of 1970";
  EXPECT_EQ(taken(" (1711000000.123456)  can0  " + data).can,
            at(unix_time(1'711'000'000, 123'456'000), kRequest));
  EXPECT_EQ(taken(" (000.250000)  can0  " + data).can, at(unix_time(0, 250 * kMillisecond), kRequest));
  // 21 March 2024 is day 19803: 19803 * 86400 + 5 * 3600 + 46 * 60 + 40 = 1711000000.
  EXPECT_EQ(taken(" (2024-03-21 05:46:40.123456)  can0  " + data).can,
            at(unix_time(1'711'000'000, 123'456'000), kRequest));
  EXPECT_EQ(taken(" (1.000000)  can0  RX - -  " + data).can, at(unix_time(1), kRequest));
  EXPECT_EQ(taken("  vcan1  TX B E  " + data + "   '1. ~....'").can,
            at(-runtime::kCandumpEpoch, kRequest, "vcan1"));
  EXPECT_EQ(taken("  can0  203   {D}  31 00 20 7E 00 00 00 00").can, at(-runtime::kCandumpEpoch, kRequest));
  EXPECT_EQ(taken("  can0  18FF1234   [1]  AB").can,
            at(-runtime::kCandumpEpoch, Frame(0x18FF1234, 1, {0xAB}, true)));
  EXPECT_EQ(taken("  can0  203   [0]\r").can, at(-runtime::kCandumpEpoch, Frame(0x203, 0)));
  EXPECT_EQ(taken("  can0  203   [4]  remote request").can,
            at(-runtime::kCandumpEpoch, Frame(0x203, 4, {}, false, true)));
  const Taken others = taken(
      "  can0  20000088   [8]  00 00 00 00 00 00 00 00   ERRORFRAME\n"
      "\tcontroller-problem{tx-error-warning}\n\tbus-error\n"
      "  can0  203  [08]  31 00 20 7E 00 00 00 00\n"
      "  can0  203  [12]  31 00 20 7E 00 00 00 00 00 00 00 00\n");
  EXPECT_TRUE(others.wrong.empty()) << others.wrong[0].second;
  EXPECT_EQ(others.left_out.text(), "1 error frame, 2 FD frames");
  EXPECT_EQ(first_mistake("  can0  203   [8]  31 00"), "x:1:25: data byte 3 of 8 expected");
  EXPECT_EQ(first_mistake("  can0  800   [0]"), "x:1:1: identifier of 3 or 8 hexadecimal digits expected");
  EXPECT_EQ(first_mistake("  can0  20G   [0]"), "x:1:1: identifier of 3 or 8 hexadecimal digits expected");
  EXPECT_EQ(first_mistake(" (2024-02-30 05:46:40.0)  can0  203   [0]"), "x:1:1: time in seconds expected");
  for (const char* clock : {"25:46:40.0", "24:00:00.0", "23:60:00.0", "2:00:00.0", "23-59:00.0"})
    EXPECT_EQ(first_mistake(" (2024-03-21 " + std::string(clock) + ")  can0  203   [0]"),
              "x:1:1: time in seconds expected")
        << clock;
  EXPECT_EQ(taken(" (2024-03-21 23:59:59.5)  can0  203   [0]").can,
            at(unix_time(1'711'065'599, 500 * kMillisecond), Frame(0x203, 0)));
  EXPECT_EQ(first_mistake(" (1.x)  can0  203   [0]"), "x:1:1: time in seconds expected");
}

// PEAK's description of the format has an example of each version.
TEST(TrcForms, EveryVersion) {
  const Time ms = kMillisecond;
  const std::string start = ";$STARTTIME=36526.0\n;\n";
  EXPECT_EQ(taken(";$FILEVERSION=1.0\n;\n     1)       1.5  0203  8  31 00 20 7E 00 00 00 00\n").can,
            at(ms + ms / 2, kRequest, "can1"));
  EXPECT_EQ(taken(";$FILEVERSION=1.1\n" + start +
                  "     1)       1.5  Rx         0203  8  31 00 20 7E 00 00 00 00\n")
                .can,
            at(ms + ms / 2, kRequest, "can1"));
  EXPECT_EQ(taken(";$FILEVERSION=1.2\n" + start +
                  "     1)       1.5 2  Rx         0203  8  31 00 20 7E 00 00 00 00\n")
                .can,
            at(ms + ms / 2, kRequest, "can2"));
  EXPECT_EQ(taken(";$FILEVERSION=1.3\n" + start +
                  "     1)       1.500 2  Rx        0203 -  8    31 00 20 7E 00 00 00 00\n")
                .can,
            at(ms + ms / 2, kRequest, "can2"));
  EXPECT_EQ(taken(";$FILEVERSION=2.0\n" + start.substr(0, 20) +
                  ";$COLUMNS=N,O,T,I,d,l,D\n"
                  "      1         1.500 DT     0203 Rx 8  31 00 20 7E 00 00 00 00\n")
                .can,
            at(ms + ms / 2, kRequest, "can1"));
  EXPECT_EQ(taken(";$FILEVERSION=2.1\n" + start.substr(0, 20) +
                  ";$COLUMNS=N,O,T,B,I,d,R,L,D\n"
                  "      1         1.500 DT 2   0203 Rx -  8    31 00 20 7E 00 00 00 00\n")
                .can,
            at(ms + ms / 2, kRequest, "can2"));
}

// A day of doubles is exact to less than a microsecond; what is meant are its milliseconds. 45372.65 is 21 March 2024, 15:36.
TEST(TrcForms, TheStartIsRoundedToMilliseconds) {
  const auto begin = [](const char* days) {
    const Taken got = taken(";$FILEVERSION=1.1\n;$STARTTIME=" + std::string(days) + "\n1) 0.0 Rx 0203 0\n");
    EXPECT_EQ(got.can.size(), 1U) << days;
    return got.can.empty() ? -1 : got.can[0].time;
  };
  EXPECT_EQ(begin("45372.65"), unix_time(1'711'035'360));
  for (int ms = 1; ms < 1'000; ++ms) {
    const double days = 45'372 + (43'200'000 + ms) / 86'400'000.0;
    EXPECT_EQ(begin(fmt::format("{:.10f}", days).c_str()), unix_time(1'711'022'400, ms * kMillisecond)) << ms;
  }
}

// Some tools leave zeros out: above four digits it is an extended one, whatever its number.
TEST(TrcForms, DigitsTellTheKindOfIdentifier) {
  for (const auto& [digits, id, extended] :
       {std::tuple("203", 0x203U, false), {"0203", 0x203U, false}, {"00203", 0x203U, true}, {"1ABCD", 0x1ABCDU, true},
        {"1ABCDE", 0x1ABCDEU, true}, {"00000203", 0x203U, true}}) {
    const Taken got = taken(";$FILEVERSION=1.1\n1) 0.0 Rx " + std::string(digits) + " 0\n");
    ASSERT_EQ(got.can.size(), 1U) << digits;
    EXPECT_EQ(got.can[0].frame.id, id) << digits;
    EXPECT_EQ(got.can[0].frame.extended, extended) << digits;
  }
}

TEST(TrcForms, MistakesOfALine) {
  const std::string head = ";$FILEVERSION=2.1\n;$STARTTIME=36526.0\n;$COLUMNS=N,O,T,B,I,d,R,L,D\n";
  EXPECT_EQ(first_mistake(head + "1 1.0 DT x 0203 Rx - 0\n"), "x:4:10: number of the bus expected");
  EXPECT_EQ(first_mistake(head + "1 1.0 DT 1 0203 Up - 0\n"), "x:4:17: Rx or Tx expected");
  EXPECT_EQ(first_mistake(head + "1 1,0 DT 1 0203 Rx - 0\n"), "x:4:3: time in milliseconds expected");
  EXPECT_EQ(first_mistake(head + "1 1.0 DT 1 0203\n"), "x:4:16: the line ends too early");
  EXPECT_EQ(first_mistake(head + "1 1.0 DT 1 20000000 Rx - 0\n"),
            "x:4:12: identifier of up to 8 hexadecimal digits expected");
  EXPECT_EQ(first_mistake(";$FILEVERSION=2.0\n;$COLUMNS=N,O,T,d,l,D\n1 1.0 DT Rx 0\n"),
            "x:3:13: the columns have no time, identifier or length");
}

TEST(TrcForms, WhatIsLeftOut) {
  const Taken second = taken(
      ";$FILEVERSION=2.1\n;$STARTTIME=36526.0\n;$COLUMNS=N,O,T,B,I,d,R,L,D\n"
      "1 1.0 FD 1 0203 Rx - 8 31 00 20 7E 00 00 00 00\n2 1.0 FB 1 0203 Rx - 9 31\n3 1.0 FE 1 0203 Rx - 8 31\n"
      "4 1.0 BI 1 0203 Rx - 8 31\n5 1.0 ER 1 - Rx - 5 04 00 02 00 00\n6 1.0 ST 1 - Rx - 4 00 00 00 08\n"
      "7 1.0 EC 1 - Rx - 2 00 00\n8 1.0 EV 1 User-defined event\n9 1.0 DT 1 0203 Rx - d 31 00 20 7E 00 00 00 "
      "00\n");
  EXPECT_EQ(second.left_out.text(), "1 error frame, 4 FD frames, 3 records of other kinds");
  const Taken first = taken(
      ";$FILEVERSION=1.1\n;\n1) 1.0 Error 0002 4 00 00 00 08\n2) 1.0 Warng FFFFFFFF 4 00 00 00 08 BUSHEAVY\n"
      "3) 1.0 Rx FFFFFFFF 4 00 00 00 08\n4) 2.0 Rx 0203 13 31 00 20 7E 00 00 00 00\n");
  EXPECT_TRUE(first.wrong.empty()) << first.wrong[0].second;
  EXPECT_EQ(first.left_out.text(), "1 error frame, 2 records of other kinds");
  EXPECT_EQ(first.can, at(2 * kMillisecond, kRequest, "can1")) << "a DLC of 13 is 8 bytes";
}

// Editors of Windows: CR LF, and a mark at the begin.
TEST(LogForms, LineEndsAndMarksOfWindows) {
  for (const std::string log :
       {"(946684801.000000) can1 203#3100207E00000000\n",
        "date Sat Jan 01 12:00:00.000 am 2000\nbase hex  timestamps absolute\n1.0 1 203 Rx d 8 31 00 20 7E "
        "00 00 00 00\n",
        ";$FILEVERSION=1.1\n;$STARTTIME=36526.0\n1) 1000.0 Rx 0203 8 31 00 20 7E 00 00 00 00\n"}) {
    std::string windows;
    for (const char c : log) windows += c == '\n' ? "\r\n" : std::string(1, c);
    for (const std::string& text : {windows, "\xEF\xBB\xBF" + log, "\xEF\xBB\xBF" + windows,
                                    "\r\n\r\n" + windows, "\xEF\xBB\xBF\n" + log}) {
      const Taken got = taken(text);
      EXPECT_TRUE(got.wrong.empty()) << text << got.wrong[0].second;
      EXPECT_EQ(got.can, at(kSecond, kRequest, "can1")) << text;
    }
  }
  EXPECT_EQ(taken("\xEF\xBB\xBF"
                  "02 01 05 00 06 3A 98 01 F4 57\r\n")
                .serial.size(),
            1U);
}

// The places of mistakes are those an editor shows: empty lines count.
TEST(LogForms, EmptyLinesAreCounted) {
  for (const std::string end : {"\n", "\r\n"}) {
    EXPECT_EQ(first_mistake("(1.000000) can0 203#" + end + end + "  " + end + "nonsense" + end), "x:4:1: '(' expected");
    EXPECT_EQ(first_mistake("base hex timestamps absolute" + end + end + "0.5 1 800 Rx d 0" + end),
              "x:3:7: identifier too large");
    EXPECT_EQ(first_mistake(";$FILEVERSION=1.1" + end + end + "1) 1.0 Up 0203 0" + end), "x:3:8: Rx or Tx expected");
  }
}

// A table has at least four columns; a line of a log may have commas, too.
TEST(LogForms, ATableIsKnownByItsSeparators) {
  for (const char separator : {',', ';'}) {
    const auto columns = [&](size_t count) {
      std::string row = "time";
      for (size_t n = 1; n < count; ++n) row += separator + std::string("id");
      return other_file(row + "\n1" + separator + "2\n").has_value();
    };
    EXPECT_FALSE(columns(3));
    EXPECT_TRUE(columns(4));
    EXPECT_TRUE(columns(12));
  }
}

TEST(LogForms, AFileThatIsNoLogIsNamed) {
  const auto what = [](std::string_view file) {
    const Taken got = taken(file);
    EXPECT_EQ(got.wrong.size(), 1U);
    return got.wrong.empty() ? "" : got.wrong[0].second;
  };
  const auto has = [&](std::string_view file, const char* word) {
    EXPECT_TRUE(what(file).find(word) != std::string::npos) << what(file);
  };
  const std::string line = "(1.000000) can0 203#\n(2.000000) can0 203#\n";
  std::string wide = "\xFF\xFE", wide_big = "\xFE\xFF", bare;
  for (const char c : line) {
    wide += {c, '\0'};
    wide_big += {'\0', c};
    bare += {c, '\0'};
  }
  has(wide, "UTF-16");
  has(wide_big, "UTF-16");
  has(bare, "UTF-16");
  has(std::string("MDF     4.10    python-can\0\0", 28), "MF4");
  has("UnFinMF 4.10", "MF4");
  has("***BUSMASTER Ver 3.2.2***\n***PROTOCOL CAN***\n", "BUSMASTER");
  has("Time "
      "Stamp,ID,Extended,Dir,Bus,LEN,D1,D2,D3,D4,D5,D6,D7,D8\n166064000,0000021A,false,Rx,0,8,FE,36,12,FE,69,"
      "05,07,AD,\n",
      "csv");
  has("timestamp,arbitration_id,extended,remote,error,dlc,data\n0.0,0x203,0,0,0,0,\n", "csv");
  has("1320745424.000 CXX OVMS CAN log\n1320745424.002 R11 402 FA\n", "CRTD");
  has("1320745424.002 1R11 402 FA\n", "CRTD");
  has("SQLite format 3", "python-can");
  has("PK\x03\x04", "ZIP");
  has("BZh91AY", "bzip2");
  has("\xFD"
      "7zXZ",
      "xz");
  has("<?xml version=\"1.0\"?>\n", "XML");
  has("{\"id\": 515}\n", "JSON");
  has("\x34\xCD\xB2\xA1", "pcap");
  has(std::string("\x01\x02\x00\x03 abc", 8), "binary");
  has(std::string("abcdefgh\0", 9), "binary");
  has("\x1F\x8B\x08", "gzip");
  EXPECT_FALSE(other_file("0.003455 0.014913 line1 02 01 | request to 1, 3PD cyclic, PO 0006, 3A98, 01F4"));
  EXPECT_FALSE(other_file("  can0  203   [8]  2C 2C 2C 2C 00 00 00 00   ',,,,....'"));
  EXPECT_FALSE(other_file("02 01 05 00 06 3A 98 01 F4 57"));
  EXPECT_FALSE(other_file(""));
}

}  // namespace
}  // namespace ipos::tests
