// ASC as CANalyzer, asc2log and python-can write it: lines of CAN FD hardware, transmit requests, dates of every language.
// Expected values by hand, from the sources of asc2log.c and python-can.
#include <gtest/gtest.h>

#include "tests/tools/taken_log.hpp"
#include "tools/logs/asc_date.hpp"

namespace ipos::tests {
namespace {

using namespace ipos::tools;  // NOLINT: everything here is about logs
using runtime::kMicrosecond;
using runtime::kMillisecond;
using runtime::kSecond;

const Frame kAscFrame(0x203, 8, {0x31, 0, 0x20, 0x7E});

std::vector<LogEntry> on_bus(Time time, const Frame& frame, const char* bus) { return {{time, bus, frame}}; }

// asc2log.c, CANalyzer: bit 1000h of the flags says that the frame is one of CAN FD, bit 10h that it is a remote frame.
TEST(AscForms, ClassicFramesOnLinesOfCanFd) {
  const std::string head = "date Sat Jan 01 12:00:00.000 am 2000\nbase hex  timestamps absolute\n";
  const auto frame_of = [&](const std::string& line) { return taken(head + line); };
  EXPECT_EQ(frame_of("   0.5 CANFD   1 Rx        203       0 0 8  8 31 00 20 7E 00 00 00 00   130000  130   "
                     "200000 0 0 0 0 0\n")
                .can,
            on_bus(500 * kMillisecond, kAscFrame, "can1"));
  EXPECT_EQ(frame_of("   0.5 CANFD   2 Tx        203  Request_1  0 0 d  8 31 00 20 7E 00 00 00 00   130000  "
                     "130   0 0 0 0 0 0\n")
                .can,
            on_bus(500 * kMillisecond, kAscFrame, "can2"));
  EXPECT_EQ(frame_of("   0.5 CANFD   1 Rx   12345678x      0 0 3  0   130000  130       10 0 0 0 0 0\n").can,
            on_bus(500 * kMillisecond, Frame(0x12345678, 3, {}, true, true), "can1"));
  const Taken others = frame_of(
      "   0.1 CANFD   1 Rx        203       1 0 3  3 AA BB CC   130000  130     3000 0 0 0 0 0\n"
      "   0.2 CANFD   1 Rx        203       0 0 f 64 00 00\n"
      "   0.3 CANFD   1 Rx  ErrorFrame  Not Acknowledge error, dominant error flag\n"
      "   0.4 CANFD   1 TxRq      203       0 0 1  1 AA   130000  130     0 0 0 0 0 0\n"
      "   0.5 Statistic: D 0\n   0.6 CANFD x\n   0.7 CAN 1 Status:chip status error active\n");
  EXPECT_EQ(others.can.size(), 0U);
  EXPECT_EQ(others.left_out.of(LeftOut::FdFrame), 1U);
  EXPECT_EQ(others.left_out.of(LeftOut::ErrorFrame), 1U);
  EXPECT_EQ(others.left_out.of(LeftOut::TransmitRequest), 1U);
  EXPECT_EQ(others.left_out.of(LeftOut::Record), 3U);
  EXPECT_EQ(others.wrong.size(), 1U) << "a line without its flags";
  const auto mistake = [&](const std::string& line) { return first_mistake(head + line); };
  EXPECT_EQ(mistake("0.5 CANFD 1 Rx 800 0 0 0 0 1 1 0\n"), "x:3:16: identifier too large");
  EXPECT_EQ(mistake("0.5 CANFD 1 Up 203 0 0 0 0 1 1 0\n"), "x:3:16: Rx or Tx expected");
  EXPECT_EQ(mistake("0.5 CANFD 1 Rx 203 0 0 g 0 1 1 0\n"), "x:3:24: DLC expected");
  EXPECT_EQ(mistake("0.5 CANFD 1 Rx 203 0 0 8 65 1 1 0\n"), "x:3:26: number of data bytes expected");
  EXPECT_EQ(mistake("0.5 CANFD 1 Rx 203 0 0 8 7 1 2 3 4 5 6 7 0 0 0\n"),
            "x:3:26: as many bytes as the DLC says expected");
}

TEST(AscForms, ADlcAboveEightIsEightBytes) {
  const std::string head = "date Sat Jan 01 12:00:00.000 am 2000\n";
  for (const char* dlc : {"8", "9", "a", "B", "D", "f"})
    EXPECT_EQ(taken(head + "base hex timestamps absolute\n0.5 1 203 Rx d " + dlc +
                    " 31 00 20 7E 00 00 00 00 Length = 1\n")
                  .can,
              on_bus(500 * kMillisecond, kAscFrame, "can1"))
        << dlc;
  EXPECT_EQ(taken(head + "base dec timestamps absolute\n0.5 1 515 Rx d 13 49 0 32 126 0 0 0 0\n").can,
            on_bus(500 * kMillisecond, kAscFrame, "can1"));
  EXPECT_EQ(taken(head + "base dec timestamps absolute\n0.5 1 515 Rx d d 49 0 32 126 0 0 0 0\n").can,
            on_bus(500 * kMillisecond, kAscFrame, "can1"))
      << "one digit is hexadecimal in every base";
  EXPECT_EQ(taken(head + "0.5 1 203 Rx r F\n").can,
            on_bus(500 * kMillisecond, Frame(0x203, 8, {}, false, true), "can1"));
  EXPECT_EQ(first_mistake(head + "0.5 1 203 Rx d 10 31 00 20 7E 00 00 00 00\n"), "x:2:16: a DLC above 15");
}

TEST(AscForms, TransmitRequestsAreNoFrames) {
  const Taken got = taken(
      "date Sat Jan 01 12:00:00.000 am 2000\nbase hex  timestamps absolute\n"
      "0.001000 1  203             TxRq d 8 31 00 20 7E 00 00 00 00\n"
      "0.001231 1  203             Tx   d 8 31 00 20 7E 00 00 00 00\n");
  EXPECT_EQ(got.can, on_bus(1'231 * kMicrosecond, kAscFrame, "can1"));
  EXPECT_EQ(got.left_out.text(), "1 transmit request");
}

// The same moment in every spelling: 21 March 2024, 15:29:03.103, second 1711034943 of 1970.
TEST(AscForms, DatesInEveryLanguageAndSize) {
  const auto date = [](std::string_view text) { return asc_date(Fields(text)); };
  const Time moment = unix_time(1'711'034'943, 103 * kMillisecond);
  for (const char* text : {"Thu Mar 21 03:29:03.103 pm 2024", "Thu Mar 21 03:29:03.103 PM 2024",
                           "THU MAR 21 03:29:03.103 PM 2024", "Thu Mar 21 3:29:03.103 pm 2024",
                           "Thu Mar 21 3:29:3.103 pm 2024", "Thu Mar 21 15:29:03.103 2024",
                           "Do M\xC3\xA4r 21 15:29:03.103 2024", "Do M\xE4r 21 15:29:03.103 2024",
                           "Do M\xC3\x84RZ 21 15:29:03.103 2024", "Do Mrz 21 15:29:03.103 2024",
                           "Don Maerz 21 15:29:03.103 2024", "Thursday March 21 15:29:3.103000 2024\r"})
    EXPECT_EQ(date(text), moment) << text;
  // Months by their days of the year 2000, each in English and German.
  const char* const kNames[12][2] = {{"Jan", "Jan"}, {"Feb", "Feb"}, {"Mar", "M\xC3\xA4r"}, {"Apr", "Apr"},
                                     {"May", "Mai"}, {"Jun", "Jun"}, {"Jul", "Jul"},        {"Aug", "Aug"},
                                     {"Sep", "Sep"}, {"Oct", "Okt"}, {"Nov", "Nov"},        {"Dec", "Dez"}};
  const int kDays[12] = {0, 31, 60, 91, 121, 152, 182, 213, 244, 274, 305, 335};
  for (size_t month = 0; month < 12; ++month)
    for (const char* name : kNames[month])
      EXPECT_EQ(date(std::string("x ") + name + " 1 00:00:00 2000"), kDays[month] * Time{86'400} * kSecond)
          << name;
  EXPECT_EQ(date("Do J\xC3\xA4n 1 00:00:00 2000"), 0);
}

// 12 am is midnight and 12 pm is noon: the clock of twelve hours has no 0.
TEST(AscForms, TheClockOfTwelveHours) {
  const auto hour = [](const std::string& clock) {
    const std::string text = "Sat Jan 01 " + clock + " 2000";
    const auto date = asc_date(Fields(text));
    return date ? *date / (3'600 * kSecond) : -1;
  };
  EXPECT_EQ(hour("12:00:00.000 am"), 0);
  EXPECT_EQ(hour("01:00:00.000 am"), 1);
  EXPECT_EQ(hour("11:00:00.000 am"), 11);
  EXPECT_EQ(hour("12:00:00.000 pm"), 12);
  EXPECT_EQ(hour("12:59:59.999 PM"), 12);
  EXPECT_EQ(hour("01:00:00.000 pm"), 13);
  EXPECT_EQ(hour("11:00:00.000 pm"), 23);
  EXPECT_EQ(hour("00:00:00.000 am"), 0) << "as ipos wrote it";
  EXPECT_EQ(hour("23:00:00.000"), 23);
  EXPECT_EQ(hour("24:00:00.000"), -1);
}

// A leap second is one: 1 January 2017 began a second after 23:59:60.
TEST(AscForms, ALeapSecondIsADate) {
  const auto date = [](std::string_view text) { return asc_date(Fields(text)); };
  EXPECT_EQ(date("Sat Dec 31 23:59:60.500 2016"), unix_time(1'483'228'800, 500 * kMillisecond));
  EXPECT_FALSE(date("Sat Dec 31 23:59:61 2016"));
}

// Steps that would add up to more than a log can last: the line is wrong, not the clock.
TEST(AscForms, RelativeTimesThatAddUpToTooMuch) {
  const std::string head = "date Sat Jan 01 12:00:00.000 am 2000\nbase hex timestamps relative\n";
  const std::string step = "1999999999.0 1 203 Rx d 0\n";
  EXPECT_EQ(taken(head + step + "0.5 1 203 Rx d 0\n").can.size(), 2U);
  EXPECT_EQ(first_mistake(head + step + step), "x:4:1: a time later than this project knows");
  const Taken got = taken(head + step + step + "0.5 1 203 Rx d 0\n");
  ASSERT_EQ(got.can.size(), 2U) << "the next line is read";
  EXPECT_EQ(got.can[1].time, got.can[0].time + 500 * kMillisecond);
}

TEST(AscForms, ADateThatIsNotUnderstoodIsTold) {
  for (const char* text :
       {"date Thu 21.03.2024 15:29:03", "date Thu Xyz 21 15:29:03 2024", "date Thu Feb 30 15:29:03 2024",
        "date Thu Mar 21 15:60:03 2024", "date Thu Mar 21 15:29 2024", "date Thu Mar 21 15:29:03 24",
        "date Thu Mar 21 15:29:61 2024", "date Thu Mar 21 015:29:03 2024", "date "}) {
    const Taken got = taken(std::string(text) + "\nbase hex  timestamps absolute\n1.0 1 203 Rx d 0\n");
    EXPECT_EQ(got.notes,
              std::vector<std::string>{"a date that is not understood: times count from 1 January 2000"})
        << text;
    EXPECT_EQ(got.can, on_bus(kSecond, Frame(0x203, 0), "can1")) << text;
  }
  EXPECT_TRUE(taken("date Thu Mar 21 15:29:03 2024\n").notes.empty());
}

TEST(AscForms, LinesThatAreNoFrames) {
  const Taken got = taken(
      "date Sat Jan 01 12:00:00.000 am 2000\nbase hex  timestamps absolute\ninternal events logged\n"
      "no internal events logged\n// version 9.0.0\nBegin Triggerblock Sat Jan 01 12:00:00.000 am 2000\n"
      "   0.000000 Start of measurement\n   0.300000 1  ErrorFrame\n   0.4 1 Statistic: D 0\n   0.5 Li 1 "
      "LIN\n"
      "something else\n   1.0 1 203 Rx d 0\nEnd TriggerBlock\n");
  EXPECT_TRUE(got.wrong.empty());
  EXPECT_EQ(got.can.size(), 1U);
  EXPECT_EQ(got.left_out.text(), "1 error frame, 3 records of other kinds");
}

// Seconds have up to nine decimals.
TEST(AscForms, PartsOfASecond) {
  const std::string head = "date Sat Jan 01 12:00:00.000 am 2000\n";
  EXPECT_EQ(taken(head + "1.123456789 1 203 Rx d 0\n").can,
            on_bus(kSecond + 123'456'789, Frame(0x203, 0), "can1"));
  EXPECT_EQ(taken(head + "1 1 203 Rx d 0\n").can, on_bus(kSecond, Frame(0x203, 0), "can1"));
  for (const char* time : {"1.1234567890", "1.", "1.-1", "2000000000.0", "1..2"})
    EXPECT_EQ(first_mistake(head + time + " 1 203 Rx d 0\n"), "x:2:1: time in seconds expected") << time;
}

}  // namespace
}  // namespace ipos::tests
