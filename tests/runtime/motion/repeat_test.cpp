// The same orders give the same states: twice in one program, from a snapshot, and with and without
// optimization.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <string>

#include "tests/runtime/motion/order_mix.hpp"

namespace ipos::tests {
namespace {

std::string output_of(const char* program) {
  FILE* pipe = popen(program, "r");
  if (!pipe) return {};
  std::string text;
  std::array<char, 256> buffer;
  while (const size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe)) text.append(buffer.data(), n);
  return pclose(pipe) == 0 ? text : std::string();
}

TEST(MotionRepeats, SameSeedSameHash) {
  for (const Taste taste : {Taste::Plausible, Taste::Any, Taste::Detailed}) {
    EXPECT_EQ(hash_of_run(7, 50'000, taste), hash_of_run(7, 50'000, taste));
    EXPECT_NE(hash_of_run(7, 50'000, taste), hash_of_run(8, 50'000, taste));
  }
}

TEST(MotionRepeats, OptimizerChangesNothing) {
  const std::string plain = output_of(IPOS_HASH_O0);
  EXPECT_EQ(plain.size(), 9 * 17U) << plain;
  EXPECT_EQ(plain, output_of(IPOS_HASH_O2));
}

TEST(MotionRepeats, SnapshotGoesOnAlike) {
  for (const Taste taste : {Taste::Plausible, Taste::Detailed}) {
    std::mt19937_64 random(3);
    runtime::Axis axis(draw_machine(random, taste));
    for (int round = 0; round < 200; ++round) {
      const runtime::AxisOrder order = draw_order(random, Taste::Plausible);
      for (int ms = 0; ms < 50; ++ms) axis.tick(order);
      runtime::Axis copy = axis;
      const runtime::AxisOrder next = draw_order(random, Taste::Plausible);
      for (int ms = 0; ms < 50; ++ms)
        ASSERT_EQ(add_to_hash(0, axis.tick(next)), add_to_hash(0, copy.tick(next))) << round << " " << ms;
    }
  }
}

TEST(MotionRepeats, ResetIsANewAxis) {
  runtime::Axis axis{{}};
  runtime::AxisOrder order;
  order.command = runtime::AxisCommand::Run;
  order.target = 1'500'000;
  for (int ms = 0; ms < 500; ++ms) axis.tick(order);
  ASSERT_NE(axis.state().position, 0);
  axis.reset();
  EXPECT_EQ(add_to_hash(0, axis.state()), add_to_hash(0, runtime::Axis{{}}.state()));
}

}  // namespace
}  // namespace ipos::tests
