// Frame lengths against the independent wire model and against published figures.
#include "runtime/bus/can/frame_bits.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/runtime/bus/wire_model.hpp"

namespace ipos::runtime {
namespace {

std::string text(const WireBits& bits) {
  std::string out;
  for (uint32_t i = 0; i < bits.count; ++i) out += bits.recessive[i] ? '1' : '0';
  return out;
}

TEST(FrameBits, ModelCrcHasThePublishedCheckValue) {
  // CRC-15/CAN of the nine characters "123456789" is 059Eh (catalogue of parametrised CRC algorithms).
  std::string message;
  for (const char c : std::string("123456789")) message += tests::binary(static_cast<uint8_t>(c), 8);
  EXPECT_EQ(tests::crc15(message), tests::binary(0x059E, 15));
}

TEST(FrameBits, PublishedBounds) {
  // Davis, Burns, Bril, Lukkien 2007, with g = 34 or 54 bits exposed to stuffing; 135 for 8 bytes, 111
  // unstuffed.
  for (uint32_t n = 0; n <= 8; ++n) {
    EXPECT_EQ(worst_case_bits(n, false), 34 + 8 * n + 13 + (34 + 8 * n - 1) / 4);
    EXPECT_EQ(worst_case_bits(n, true), 54 + 8 * n + 13 + (54 + 8 * n - 1) / 4);
  }
  EXPECT_EQ(worst_case_bits(8, false), 135U);
  EXPECT_EQ(worst_case_bits(6, false), 115U);
  EXPECT_EQ(worst_case_bits(8, true), 160U);
  EXPECT_EQ(unstuffed_bits(8, false), 111U);
  EXPECT_EQ(unstuffed_bits(0, false), 47U);
  EXPECT_EQ(unstuffed_bits(8, true), 131U);
}

TEST(FrameBits, BitForBitAsTheModel) {
  std::mt19937 random(2);
  uint32_t longest = 0;
  for (int i = 0; i < 20'000; ++i) {
    Frame frame;
    frame.extended = random() % 3 == 0;
    frame.remote = random() % 8 == 0;
    frame.length = static_cast<uint8_t>(random() % 9);
    frame.id = static_cast<uint32_t>(random() % (frame.extended ? kExtendedIdLimit : kStandardIdLimit));
    // A third of the frames from few bit patterns: long runs, many stuff bits.
    const uint8_t pattern = static_cast<uint8_t>(random() % 2 == 0 ? 0x00 : 0xFF);
    for (uint8_t& byte : frame.data)
      byte = i % 3 == 0 ? static_cast<uint8_t>(pattern ^ (random() % 5 == 0 ? 0x0F : 0))
                        : static_cast<uint8_t>(random());
    ASSERT_EQ(text(wire_bits(frame)), tests::wire(frame));
    const uint32_t bits = frame_bits(frame);
    ASSERT_EQ(bits, tests::wire(frame).size() + 3);
    const uint32_t bytes = frame.remote ? 0 : frame.length;
    ASSERT_GE(bits, unstuffed_bits(bytes, frame.extended));
    ASSERT_LE(bits, worst_case_bits(bytes, frame.extended));
    longest = std::max(longest, bits);
  }
  EXPECT_GT(longest, 140U);
}

TEST(FrameBits, ArbitrationKeyOrdersLikeTheBits) {
  std::mt19937 random(3);
  const auto any = [&random] {
    Frame frame;
    frame.extended = random() % 2 == 0;
    frame.remote = random() % 2 == 0;
    const uint32_t base = static_cast<uint32_t>(random() % 4);
    frame.id = frame.extended ? base << 18 | static_cast<uint32_t>(random() % 4) : base;
    return frame;
  };
  for (int i = 0; i < 20'000; ++i) {
    const Frame a = any();
    const Frame b = any();
    const std::string bits_a = tests::arbitration_field(a);
    const std::string bits_b = tests::arbitration_field(b);
    ASSERT_EQ(arbitration_key(a) < arbitration_key(b), bits_a < bits_b) << bits_a << ' ' << bits_b;
    ASSERT_EQ(arbitration_key(a) == arbitration_key(b), a == b);
  }
}

TEST(FrameBits, CanonicalFramesHaveNothingBehindTheirLength) {
  Frame frame{5, 2, {1, 2, 3, 4, 5, 6, 7, 8}, false, false};
  EXPECT_EQ(canonical(frame), (Frame{5, 2, {1, 2}, false, false}));
  frame.remote = true;
  EXPECT_EQ(canonical(frame), (Frame{5, 2, {}, false, true}));
  EXPECT_FALSE(is_valid(Frame{2048, 0, {}, false, false}));
  EXPECT_TRUE(is_valid(Frame{2048, 0, {}, true, false}));
  EXPECT_FALSE(is_valid(Frame{1U << 29, 0, {}, true, false}));
  EXPECT_FALSE(is_valid(Frame{1, 9, {}, false, false}));
}

}  // namespace
}  // namespace ipos::runtime
