// Frames of a CANopen line in words.
#include "runtime/bus/canopen/words.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "tests/runtime/bus/canopen/fake_unit.hpp"

namespace ipos::tests {
namespace {

struct Line {
  Frame frame;
  std::string text;
};

void expect_text(LineWords& words, const std::vector<Line>& lines) {
  for (const Line& line : lines) EXPECT_EQ(words.describe(line.frame).text, line.text);
}

TEST(CanopenWords, ALineComesUp) {
  LineWords words({{5, "saw", &mdxb(), {9, 1, 8}, {6, 1, 0}}});
  expect_text(
      words, {{{0x000, 2, {0x82, 0}}, "000 NMT reset communication -> all nodes"},
              {{0x705, 1, {0x00}}, "705 boot-up <- saw"},
              {{0x605, 8, {0x40, 0x00, 0x18, 0x02}}, "605 SDO read 1800h:2 TPDO1 transmission type -> saw"},
              {{0x585, 8, {0x4F, 0x00, 0x18, 0x02, 1}}, "585 SDO 1800h:2 TPDO1 transmission type = 1 <- saw"},
              {{0x605, 8, {0x23, 0x16, 0x21, 0, 0xD0, 7, 0, 0}},
               "605 SDO write 2116h P130 Ramp t11 UP CW = 2.000 s -> saw"},
              {{0x585, 8, {0x60, 0x16, 0x21, 0}}, "585 SDO written 2116h P130 Ramp t11 UP CW <- saw"},
              {{0x605, 8, {0x40, 0x08, 0x10, 0}}, "605 SDO read 1008h Manufacturer device name -> saw"},
              {{0x585, 8, {0x41, 0x08, 0x10, 0, 9}},
               "585 SDO 1008h Manufacturer device name has 9 bytes, in segments <- saw"},
              {{0x605, 8, {0x60}}, "605 SDO next segment of 1008h Manufacturer device name -> saw"},
              {{0x585, 8, {0x00, 'M', 'O', 'V', 'I', 'D', 'R', 'I'}},
               "585 SDO segment \"MOVIDRI\" of 1008h Manufacturer device name <- saw"},
              {{0x605, 8, {0x70}}, "605 SDO next segment of 1008h Manufacturer device name -> saw"},
              {{0x585, 8, {0x1B, 'V', 'E'}},
               "585 SDO segment \"VE\" of 1008h Manufacturer device name, the last <- saw"},
              {{0x585, 8, {0x80, 0x17, 0x10, 0, 0x10, 0, 7, 6}},
               "585 SDO abort 1017h Producer heartbeat time: length of the data does not fit the object "
               "(06070010h) <- saw"},
              {{0x000, 2, {0x01, 5}}, "000 NMT start -> saw"},
              {{0x080, 0}, "080 SYNC"},
              {{0x205, 6, {6, 0, 0x88, 0x13, 0xD0, 0x07}},
               "205 RPDO1 PO1 CTRL. WORD 1 0006h, PO2 SPEED 1000.0 rpm, PO3 RAMP 2000 ms -> saw"},
              {{0x185, 6, {7, 2, 0x88, 0x13, 0, 0}},
               "185 TPDO1 PI1 STATUS WORD1 0207h, PI2 SPEED 1000.0 rpm, PI3 0000h <- saw"},
              {{0x185, 6, {}, false, true}, "185 TPDO1 asked for -> saw"},
              {{0x705, 1, {}, false, true}, "705 guarding request -> saw"},
              {{0x705, 1, {0x85}}, "705 operational, toggle 1 <- saw"},
              {{0x085, 8, {0x00, 0xFF, 0x81, 0, 0x22, 0x2B}},
               "085 EMCY FF00h fault, error register 81h, status word 1 2B22h <- saw"},
              {{0x085, 8, {0, 0, 0}}, "085 EMCY gone, error register 00h <- saw"},
              {{0x706, 1, {0x05}}, "706 operational <- node 6"},
              {{0x7FF, 1, {0x05}}, "7FF 05"}});
  EXPECT_FALSE(words.describe({0x7FF, 1, {0x05}}).known);
}

// A PDO that a master has remapped is told by its new mapping and identifier, once the node has confirmed it.
TEST(CanopenWords, LearnsTheMapping) {
  LineWords words;
  const auto write = [&](uint8_t byte0, uint16_t index, uint8_t sub, uint32_t value) {
    words.describe({0x605, 8, sdo::initiate(byte0, {index, sub}, value)});
    words.describe({0x585, 8, sdo::initiate(0x60, {index, sub})});
  };
  expect_text(words, {{{0x285, 2, {1, 2}}, "285 TPDO2 not mapped: 01 02 <- node 5"}});
  write(0x23, 0x1A01, 1, 0x2001'0A10);
  write(0x2F, 0x1A01, 0, 1);
  write(0x23, 0x1801, 1, 0x0000'0333);
  expect_text(words, {{{0x333, 2, {1, 2}}, "333 TPDO2 PI10 0201h <- node 5"},
                      {{0x333, 1, {1}}, "333 TPDO2 1 of 2 bytes: 01 <- node 5"}});
  // One that is refused changes nothing; a boot-up forgets all.
  words.describe({0x605, 8, sdo::initiate(0x23, {0x1801, 1}, 0x334)});
  words.describe({0x585, 8, sdo::abort({0x1801, 1}, Abort::Value)});
  expect_text(words, {{{0x333, 2, {1, 2}}, "333 TPDO2 PI10 0201h <- node 5"},
                      {{0x705, 1, {0}}, "705 boot-up <- node 5"},
                      {{0x333, 2, {1, 2}}, "333 RPDO2 not mapped: 01 02 -> node 51"}});
}

// A write that nobody has answered is forgotten with the next request, here one in segments to the same object.
TEST(CanopenWords, AnUnansweredWriteIsForgotten) {
  LineWords words;
  words.describe({0x605, 8, sdo::initiate(0x23, {0x1801, 1}, 0x334)});
  words.describe({0x605, 8, sdo::initiate(0x21, {0x1801, 1}, 4)});
  words.describe({0x585, 8, sdo::initiate(0x60, {0x1801, 1})});
  expect_text(words, {{{0x334, 2, {1, 2}}, "334 RPDO2 not mapped: 01 02 -> node 52"}});
}

// Four octets of an object that nobody knows are a number with sign, fewer have none; those of the communication part
// are shown in hexadecimal.
TEST(CanopenWords, ValuesOfObjects) {
  LineWords words;
  expect_text(
      words,
      {{{0x585, 8, {0x43, 0x00, 0x50, 1, 0xFE, 0xFF, 0xFF, 0xFF}}, "585 SDO 5000h:1 = -2 <- node 5"},
       {{0x585, 8, {0x4B, 0x00, 0x50, 1, 0xFE, 0xFF, 0xFF, 0xFF}}, "585 SDO 5000h:1 = 65534 <- node 5"},
       {{0x585, 8, {0x4F, 0x00, 0x50, 1, 0xFE, 0xFF, 0xFF, 0xFF}}, "585 SDO 5000h:1 = 254 <- node 5"},
       {{0x585, 8, {0x43, 0x00, 0x12, 9, 0x05, 6, 0, 0}}, "585 SDO 1200h:9 = 00000605h <- node 5"}});
}

TEST(CanopenWords, AnyFrame) {
  EXPECT_TRUE(rc::check("any frame has a text", [] {
    LineWords words;
    for (int n = *rc::gen::inRange(1, 60); n > 0; --n) {
      Frame frame;
      frame.id = *rc::gen::inRange<uint32_t>(0, 0x800);
      frame.length = *rc::gen::inRange<uint8_t>(0, 9);
      frame.remote = *rc::gen::inRange(0, 8) == 0;
      for (uint8_t& byte : frame.data) byte = *rc::gen::arbitrary<uint8_t>();
      if (*rc::gen::inRange(0, 2) == 0) {
        static const std::vector<uint16_t> kIndices = {0x1400, 0x1600, 0x1800, 0x1A00, 0x1A01, 0x1005};
        const uint16_t index = *rc::gen::elementOf(kIndices);
        const Address at{index, *rc::gen::inRange<uint8_t>(0, 9)};
        const bool asks = *rc::gen::arbitrary<bool>();
        frame = {asks ? 0x605U : 0x585U, 8,
                 sdo::initiate(asks ? 0x23 : 0x60, at, *rc::gen::arbitrary<uint32_t>())};
      }
      RC_ASSERT(words.describe(canonical(frame)).text.size() > 4);
    }
  }));
}

}  // namespace
}  // namespace ipos::tests
