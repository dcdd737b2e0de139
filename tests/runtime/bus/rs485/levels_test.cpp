// Start bits are found on any wire as by a look at each tick.
#include "runtime/bus/rs485/levels.hpp"

#include <gtest/gtest.h>

#include <random>

namespace ipos::tests {
namespace {

using namespace ipos::runtime;  // NOLINT

constexpr Tick kWindow = 120;

std::optional<Tick> start_by_each_tick(const std::vector<Transmission>& line, const Ear& ear, Tick from,
                                       Tick until) {
  for (Tick tick = from; tick < until; ++tick)
    if (!level_at(line, ear, tick) && (tick == 0 || level_at(line, ear, tick - 1))) return tick;
  return std::nullopt;
}

// Up to three senders with different rates, at once and after each other, with gaps and without.
std::vector<Transmission> any_line(std::mt19937& random) {
  std::vector<Transmission> line;
  for (NodeId sender = 0; sender < 1 + random() % 3; ++sender) {
    constexpr uint32_t kBitTicks[] = {1, 6, 7, 13};
    Transmission& sent = line.emplace_back();
    sent.sender = sender;
    sent.begin = random() % 60;
    sent.bit_ticks = kBitTicks[random() % 4];
    const auto ones = static_cast<uint32_t>(random() % 4);
    for (auto n = random() % 12; n > 0; --n) sent.bits.push_back(random() % 4 < ones);
  }
  return line;
}

TEST(Levels, AStartBitIsFoundAsByALookAtEachTick) {
  std::mt19937 random(20260728);
  int found = 0;
  for (int n = 0; n < 400; ++n) {
    const std::vector<Transmission> line = any_line(random);
    const Ear ear{6, random() % 2 == 0 ? kNoNode : NodeId{0}};
    for (Tick from = 0; from < kWindow; ++from)
      for (const Tick until : {from, from + 1, from + random() % 20, kWindow}) {
        const auto start = next_start(line, ear, from, until);
        ASSERT_EQ(start, start_by_each_tick(line, ear, from, until)) << n << ", " << from << " to " << until;
        found += start.has_value();
      }
  }
  EXPECT_GT(found, 1000) << "most lines have start bits";
}

}  // namespace
}  // namespace ipos::tests
