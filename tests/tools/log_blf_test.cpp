// BLF as Vector's tools write it for hardware of CAN FD: other objects, other units of time, files that end too early. Expected
// values by hand, from the description of the objects in Vector's library and python-can.
#include <gtest/gtest.h>

#include "tests/tools/taken_log.hpp"

namespace ipos::tests {
namespace {

using namespace ipos::tools;  // NOLINT: everything here is about logs

const Frame kMessageFrame(0x203, 8, {1, 2, 3, 4, 5, 6, 7, 8});

std::string blf(const std::string& objects) {
  std::string file = "LOGG" + number(144, 4) + std::string(32, '\0');
  for (const unsigned word : {2000U, 1U, 6U, 1U, 0U, 0U, 0U, 0U}) file += number(word, 2);
  file.resize(144);
  return file + objects;
}
// An object with time; `flags` 1: 10 us, 2: ns.
std::string timed(uint32_t type, uint32_t flags, uint64_t time, const std::string& body) {
  return "LOBJ" + number(32, 2) + number(1, 2) + number(32 + body.size(), 4) + number(type, 4) +
         number(flags, 4) + number(0, 4) + number(time, 8) + body;
}
const std::string kData = "\x01\x02\x03\x04\x05\x06\x07\x08";
std::string message(uint32_t id, uint8_t flags, uint8_t dlc) {
  return number(1, 2) + number(flags, 1) + number(dlc, 1) + number(id, 4) + kData;
}
// Objects 100 and 101 (Vector's blf description): the flags of the frame tell its kind.
std::string fd(uint32_t id, uint8_t flags, uint8_t dlc, uint8_t fd_flags) {
  return number(2, 2) + number(flags, 1) + number(dlc, 1) + number(id, 4) + number(0, 4) + number(0, 1) +
         number(fd_flags, 1) + number(8, 1) + std::string(5, '\0') + kData + std::string(56, '\0');
}
std::string fd64(uint32_t id, uint32_t flags, uint8_t dlc) {
  return number(3, 1) + number(dlc, 1) + number(8, 1) + number(0, 1) + number(id, 4) + number(0, 4) +
         number(flags, 4) + std::string(24, '\0') + kData;
}

TEST(BlfForms, TimesInBothUnits) {
  EXPECT_EQ(taken(blf(timed(1, 1, 123'456, message(0x203, 0, 8)))).can,
            (std::vector<LogEntry>{{1'234'560'000, "can1", kMessageFrame}}));
  EXPECT_EQ(taken(blf(timed(86, 2, 123'456, message(0x203, 0, 8)))).can,
            (std::vector<LogEntry>{{123'456, "can1", kMessageFrame}}));
  EXPECT_EQ(first_mistake(blf(timed(1, 1, UINT64_MAX / 10'000, message(0x203, 0, 8)))),
            "x: byte 144: a time later than this project knows");
}

TEST(BlfForms, ClassicFramesInObjectsOfFd) {
  const auto frame_of = [](const std::string& object) {
    const Taken got = taken(blf(object));
    EXPECT_TRUE(got.wrong.empty()) << got.wrong[0].second;
    return got.can;
  };
  EXPECT_EQ(frame_of(timed(100, 2, 5, fd(0x203, 0, 8, 0))),
            (std::vector<LogEntry>{{5, "can2", kMessageFrame}}));
  EXPECT_EQ(frame_of(timed(100, 2, 5, fd(0x80000203, 0x80, 13, 6))),
            (std::vector<LogEntry>{{5, "can2", Frame(0x203, 8, {}, true, true)}}));
  EXPECT_EQ(frame_of(timed(101, 2, 5, fd64(0x203, 0, 8))),
            (std::vector<LogEntry>{{5, "can3", kMessageFrame}}));
  EXPECT_EQ(frame_of(timed(101, 1, 5, fd64(0x80000203, 0x10, 2))),
            (std::vector<LogEntry>{{50'000, "can3", Frame(0x203, 2, {}, true, true)}}));
  EXPECT_EQ(frame_of(timed(101, 2, 5, fd64(0x203, 0x40, 15))),
            (std::vector<LogEntry>{{5, "can3", kMessageFrame}}));
  const Taken others = taken(
      blf(timed(100, 2, 5, fd(0x203, 0, 8, 1)) + timed(101, 2, 5, fd64(0x203, 0x1000, 8)) +
          timed(101, 2, 5, fd64(0x203, 0x80, 8)) + timed(2, 2, 5, "four") + timed(73, 2, 5, "four") +
          timed(104, 2, 5, "four") + timed(65, 2, 5, "four") + timed(86, 2, 5, message(0x203, 0x80, 9))));
  EXPECT_TRUE(others.wrong.empty());
  EXPECT_EQ(others.can, (std::vector<LogEntry>{{5, "can1", Frame(0x203, 8, {}, false, true)}}));
  EXPECT_EQ(others.left_out.text(),
            "3 error frames, 2 FD frames, 1 transmit request, 1 record of another kind");
}

TEST(BlfForms, MistakesOfMessages) {
  for (const uint32_t type : {1U, 86U, 100U, 101U})
    EXPECT_EQ(first_mistake(blf(timed(type, 2, 5, "1234567"))),
              "x: byte 144: a CAN message that is too short")
        << type;
  EXPECT_EQ(first_mistake(blf(timed(1, 2, 5, message(0x203, 0, 8).substr(0, 15)))),
            "x: byte 144: a CAN message without all its data");
  EXPECT_EQ(first_mistake(blf(timed(1, 2, 5, message(0x203, 0, 16)))),
            "x: byte 144: a CAN message that is none of classic CAN");
  EXPECT_EQ(first_mistake(blf(timed(1, 2, 5, message(0x800, 0, 8)))),
            "x: byte 144: a CAN message that is none of classic CAN");
  EXPECT_EQ(taken(blf(timed(1, 2, 5, message(0x203, 0x80, 8).substr(0, 8)))).can.size(), 1U)
      << "a remote frame has no data";
}

// A file that ends within an object is told, also when it was filled up with zeros.
TEST(BlfForms, TheEndOfAFile) {
  const std::string whole =
      blf(blf_object(10, number(0, 2) + std::string(6, '\0') + number(48, 4) + std::string(4, '\0') +
                             timed(1, 2, 5, message(0x203, 0, 8))));
  EXPECT_TRUE(taken(whole).wrong.empty());
  EXPECT_TRUE(taken(whole + std::string(3, '\0')).wrong.empty());
  const auto inner = timed(1, 2, 5, message(0x203, 0, 8));
  for (size_t size = 1; size < inner.size(); ++size)
    for (const size_t filled : {0U, 1U, 3U}) {
      const std::string file = blf(blf_object(10, number(0, 2) + std::string(6, '\0') + number(size, 4) +
                                                      std::string(4, '\0') + inner.substr(0, size)));
      EXPECT_EQ(first_mistake(file + std::string(filled, '\0')),
                "x: byte " + std::to_string(file.size() + filled) + ": the file ends within an object")
          << size;
    }
}

// SYSTEMTIME: 21 March 2024, a Thursday, 15:29:03.103, second 1711034943 of 1970. What is no date counts as virtual time 0.
TEST(BlfForms, TheDateOfTheHead) {
  const auto begin = [](const std::vector<unsigned>& words) {
    std::string file = "LOGG" + number(144, 4) + std::string(32, '\0');
    for (const unsigned word : words) file += number(word, 2);
    file.resize(144);
    const Taken got = taken(file + timed(1, 2, 7, message(0x203, 0, 8)));
    EXPECT_EQ(got.can.size(), 1U);
    return got.can.empty() ? -1 : got.can[0].time - 7;
  };
  EXPECT_EQ(begin({2024, 3, 4, 21, 15, 29, 3, 103}), unix_time(1'711'034'943, 103 * runtime::kMillisecond));
  EXPECT_EQ(begin({2024, 3, 4, 21, 23, 59, 59, 999}), unix_time(1'711'065'599, 999 * runtime::kMillisecond));
  for (const std::vector<unsigned>& none : {std::vector<unsigned>{0, 0, 0, 0, 0, 0, 0, 0},
                                            {2024, 2, 4, 30, 0, 0, 0, 0},
                                            {2024, 3, 4, 21, 24, 0, 0, 0},
                                            {2024, 3, 4, 21, 0, 60, 0, 0},
                                            {2024, 3, 4, 21, 0, 0, 61, 0},
                                            {2024, 3, 4, 21, 0, 0, 0, 1'000},
                                            {1969, 3, 4, 21, 0, 0, 0, 0},
                                            {2151, 3, 4, 21, 0, 0, 0, 0}})
    EXPECT_EQ(begin(none), 0);
}

TEST(BlfForms, HeadsAndGaps) {
  const std::string object = timed(1, 2, 5, message(0x203, 0, 8));
  for (size_t gap = 0; gap < 8; ++gap)
    EXPECT_EQ(taken(blf(std::string(gap, '\0') + object)).can.size(), 1U) << gap;
  EXPECT_EQ(first_mistake(blf(std::string(8, '\0') + object)), "x: byte 144: an object expected");
  std::string file = blf(object);
  file.replace(4, 4, number(71, 4));
  EXPECT_EQ(first_mistake(file), "x: byte 4: a head that is too short");
  EXPECT_EQ(first_mistake(blf(object.substr(0, 40))), "x: byte 144: the file ends within an object");
  EXPECT_EQ(first_mistake(blf(object.substr(0, 15))), "x: byte 144: the file ends within an object");
  EXPECT_EQ(first_mistake(blf("LOBJ" + number(16, 2) + number(1, 2) + number(15, 4) + number(1, 4))),
            "x: byte 152: an object of 15 bytes");
  EXPECT_EQ(first_mistake(blf(blf_object(10, number(3, 2) + std::string(14, '\0')))),
            "x: byte 160: packed by method 3, which is not known");
  EXPECT_EQ(first_mistake(blf(blf_object(10, "short"))), "x: byte 144: a container without head");
}

}  // namespace
}  // namespace ipos::tests
