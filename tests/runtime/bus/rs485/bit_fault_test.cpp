// What a fault leaves of the bits of a telegram, for many seeds. Parity and stop bits are counted here, not by the receiver.
#include "runtime/bus/rs485/bit_fault.hpp"

#include <algorithm>

#include "runtime/bus/rs485/levels.hpp"
#include "tests/runtime/bus/rs485/serial_rig.hpp"

namespace ipos::tests {
namespace {

const std::vector<uint8_t> kSent = {0x02, 0x01, 0x81, 0x00, 0x00, 0x82};

struct Left {
  std::vector<bool> bits;
  size_t flipped = 0;
  size_t wrong_parities = 0, wrong_stops = 0, wrong_starts = 0;
};

Left left_by(OctetFaultKind kind, uint64_t seed) {
  const std::vector<bool> before = wire_bits(kSent);
  Left left{before};
  Random random(seed);
  damage(kind, left.bits, random);
  EXPECT_EQ(left.bits.size(), before.size()) << "its time stays";
  for (size_t n = 0; n < before.size(); ++n) left.flipped += left.bits[n] != before[n];
  for (size_t first = 0; first < left.bits.size(); first += 11) {
    size_t ones = 0;
    for (size_t n = 1; n <= 9; ++n) ones += left.bits[first + n];
    left.wrong_parities += ones % 2;
    left.wrong_starts += left.bits[first];
    left.wrong_stops += !left.bits[first + 10];
  }
  return left;
}

TEST(BitFault, EachKind) {
  size_t counts[4] = {};
  for (uint64_t seed = 1; seed <= 500; ++seed) {
    const Left lost = left_by(OctetFaultKind::Lost, seed);
    EXPECT_TRUE(std::all_of(lost.bits.begin(), lost.bits.end(), [](bool bit) { return bit; }));
    const Left parity = left_by(OctetFaultKind::Parity, seed);
    EXPECT_EQ(std::tuple(parity.flipped, parity.wrong_parities, parity.wrong_starts, parity.wrong_stops), std::tuple(1U, 1U, 0U, 0U));
    const Left cut = left_by(OctetFaultKind::Cut, seed);
    EXPECT_GE(cut.wrong_starts, 1U) << "the last characters are silence";
    EXPECT_EQ(cut.wrong_stops, 0U);
    const Left collision = left_by(OctetFaultKind::Collision, seed);
    EXPECT_EQ(std::pair(collision.wrong_stops, collision.wrong_starts), std::pair(size_t{1}, size_t{0})) << "11 bits of 0 hold one stop bit";
    for (const OctetFaultKind kind : {OctetFaultKind::Noise, OctetFaultKind::Terminator, OctetFaultKind::Length}) {
      const size_t flipped = left_by(kind, seed).flipped;
      ASSERT_TRUE(flipped >= 1 && flipped <= 3) << seed;
      ++counts[flipped];
    }
  }
  for (const size_t flipped : {1U, 2U, 3U}) EXPECT_GT(counts[flipped], 400U);
}

TEST(BitFault, WordsOfEachLine) {
  EXPECT_EQ(find_octet_fault("swap", OctetLine::Rs232), nullptr);
  EXPECT_EQ(find_octet_fault("terminator", OctetLine::Rs232), nullptr);
  EXPECT_EQ(find_octet_fault("link", OctetLine::Rs485), nullptr);
  EXPECT_EQ(find_octet_fault("swap", OctetLine::Rs485)->kind, OctetFaultKind::Swap);
  EXPECT_EQ(find_octet_fault("link", OctetLine::Profibus)->kind, OctetFaultKind::Link);
}

}  // namespace
}  // namespace ipos::tests
