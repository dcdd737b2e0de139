// Variable telegrams: the manual's byte tables, and the rule for the other lengths written out as a table.
#include "runtime/bus/movilink/variable_telegram.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/harness/proves.hpp"

namespace ipos::runtime {
namespace {

using Bytes = std::array<uint8_t, 8>;
constexpr VariablePair kExample{0x11223344, 0x55667788};  // H20, H21
constexpr VariablePair kTelegram2{0x44332211, static_cast<int32_t>(0x88776655)};
constexpr VariableFormat kMotorola8{8, VariableLayout::Motorola};
constexpr VariableFormat kIntel8{8, VariableLayout::Intel};

TEST(VariableTelegram, MotorolaOfTheManual) {
  PROVES("EX-29", "VAR-09");
  EXPECT_EQ(variable_frame(1024, kMotorola8, kExample).data,
            (Bytes{0x55, 0x66, 0x77, 0x88, 0x11, 0x22, 0x33, 0x44}));
  EXPECT_EQ(variable_frame(1025, kMotorola8, kTelegram2).data,
            (Bytes{0x88, 0x77, 0x66, 0x55, 0x44, 0x33, 0x22, 0x11}));
}

TEST(VariableTelegram, IntelOfTheManual) {
  PROVES("EX-30", "VAR-10", "VAR-11");
  EXPECT_EQ(variable_frame(1024, kIntel8, kExample).data,
            (Bytes{0x44, 0x33, 0x22, 0x11, 0x88, 0x77, 0x66, 0x55}));
  EXPECT_EQ(variable_frame(1025, kIntel8, kTelegram2).data,
            (Bytes{0x11, 0x22, 0x33, 0x44, 0x55, 0x66, 0x77, 0x88}));
}

TEST(VariableTelegram, MixedFormatsGarble) {  // 1053 1610 p. 64
  const auto got = frame_variables(variable_frame(1024, kMotorola8, kExample), kIntel8);
  EXPECT_EQ(got, (VariablePair{static_cast<int32_t>(0x88776655), 0x44332211}));
}

TEST(VariableTelegram, EveryLengthInBothLayouts) {
  PROVES("VAR-08", "VAR-12");
  const Bytes motorola[9] = {{},
                             {0x44},
                             {0x33, 0x44},
                             {0x22, 0x33, 0x44},
                             {0x11, 0x22, 0x33, 0x44},
                             {0x88, 0x11, 0x22, 0x33, 0x44},
                             {0x77, 0x88, 0x11, 0x22, 0x33, 0x44},
                             {0x66, 0x77, 0x88, 0x11, 0x22, 0x33, 0x44},
                             {0x55, 0x66, 0x77, 0x88, 0x11, 0x22, 0x33, 0x44}};
  const Bytes intel = {0x44, 0x33, 0x22, 0x11, 0x88, 0x77, 0x66, 0x55};
  for (uint8_t n = 0; n <= 8; ++n) {
    Frame expected{7, n, motorola[n], false, false};
    EXPECT_EQ(variable_frame(7, {n, VariableLayout::Motorola}, kExample), expected);
    expected.data = intel;
    EXPECT_EQ(variable_frame(7, {n, VariableLayout::Intel}, kExample), canonical(expected));
    EXPECT_EQ((VariableFormat{n, VariableLayout::Intel}.variables()), n == 0 ? 0 : n <= 4 ? 1 : 2);
  }
}

TEST(VariableTelegram, EqualFormatsReturnTheLowBytesAndZeros) {
  std::mt19937 random(7);
  for (int i = 0; i < 20'000; ++i) {
    const uint8_t n = static_cast<uint8_t>(i % 9);
    const VariableFormat format{n, i % 2 == 0 ? VariableLayout::Motorola : VariableLayout::Intel};
    const uint64_t value = uint64_t{random()} << 32 | random();
    const VariablePair pair{static_cast<int32_t>(static_cast<uint32_t>(value)),
                            static_cast<int32_t>(static_cast<uint32_t>(value >> 32))};
    const uint64_t kept = n == 8 ? value : value % (uint64_t{1} << (8 * n));
    const VariablePair expected{static_cast<int32_t>(static_cast<uint32_t>(kept)),
                                static_cast<int32_t>(static_cast<uint32_t>(kept >> 32))};
    ASSERT_EQ(frame_variables(variable_frame(1, format, pair), format), expected);
  }
}

TEST(VariableTelegram, OtherLengthsAndKindsAreLeftAlone) {
  for (uint8_t dlc = 0; dlc <= 8; ++dlc) {
    EXPECT_EQ(frame_variables(Frame{1, dlc, {}, false, false}, kIntel8).has_value(), dlc == 8);
    EXPECT_EQ(frame_variables(Frame{1, dlc, {}, false, false}, {0, VariableLayout::Motorola}).has_value(),
              dlc == 0);
  }
  EXPECT_FALSE(frame_variables(Frame{1, 8, {}, true, false}, kIntel8));
  EXPECT_FALSE(frame_variables(Frame{1, 8, {}, false, true}, kIntel8));
}

TEST(VariableTelegram, LengthElement) {
  PROVES("VAR-07");
  for (int32_t word = -300; word < 1000; ++word) {
    const bool legal = (word >= 0 && word <= 8) || (word >= 0x100 && word <= 0x108);
    const auto format = variable_format(word);
    ASSERT_EQ(format.has_value(), legal) << word;
    if (!legal) continue;
    EXPECT_EQ(format->length, word % 16);
    EXPECT_EQ(format->layout, word >= 0x100 ? VariableLayout::Intel : VariableLayout::Motorola);
    EXPECT_EQ(variable_frame(9, *format, kExample).length, word % 16);  // DLC
  }
}

}  // namespace
}  // namespace ipos::runtime
