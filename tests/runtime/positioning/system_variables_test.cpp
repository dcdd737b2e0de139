// System variables that are parameters, and the position of the process data.
#include <gtest/gtest.h>

#include "tests/runtime/positioning/rig.hpp"

namespace ipos::tests {
namespace {

TEST(PositioningVariables, AreTheirParametersBothWays) {
  struct Pair {
    size_t variable;
    const char* number;
    int32_t first, second;
  };
  for (const Pair& p :
       {Pair{493, "922", 100, 200}, Pair{494, "923", 7'000, 8'000}, Pair{496, "920", 1'000, -1'000},
        Pair{497, "921", -5'000, 9}, Pair{498, "900", 12, -12}}) {
    Rig rig;
    const auto index = rig.parameters.table().find(p.number)->index;
    rig.set(p.number, p.first);
    rig.tick();
    EXPECT_EQ(rig.h[p.variable], p.first) << p.number;
    rig.h[p.variable] = p.second;
    rig.tick();
    EXPECT_EQ(rig.parameters.value(index), p.second) << p.number;
    ASSERT_TRUE(rig.parameters.execute(runtime::ParameterService::WriteVolatile, index, p.first));
    rig.tick();
    EXPECT_EQ(rig.h[p.variable], p.first) << p.number;
  }
}

TEST(PositioningVariables, ComeBackIntoTheRangeOfTheParameter) {
  Rig rig;
  rig.h[493] = 40'000;  // P922: 0..32767
  rig.tick();
  EXPECT_EQ(rig.h[493], 32'767);
}

TEST(PositioningVariables, OnlyTheDriveWritesItsOwn) {
  Rig rig;
  for (const size_t n : {455U, 491U, 495U, 499U, 502U, 503U, 504U, 505U, 506U, 507U, 509U, 510U, 511U}) {
    rig.h[n] = 12'345;
    rig.tick();
    EXPECT_EQ(rig.h[n], 0) << "H" << n;
  }
}

// POSITION HI and LO in two of the three words (1053 1610 p. 82).
TEST(PositioningVariables, PositionOverProcessData) {
  Rig rig({{"100", 10}, {"870", 9}, {"871", 4}, {"872", 3}, {"873", 5}, {"874", 4}, {"815", 0}});
  const auto send = [&](int32_t position) {
    const auto bits = static_cast<uint32_t>(position);
    const std::array<uint16_t, 3> words{6, static_cast<uint16_t>(bits >> 16), static_cast<uint16_t>(bits)};
    rig.drive.take_po(runtime::PoSource::Sbus, words);
  };
  for (const int32_t position : {100'000, -70'000}) {
    send(position);
    rig.tick();
    EXPECT_EQ(rig.h[499], position);
    rig.go(rig.h[499]);
    rig.run_to_target();
    const auto pi = rig.drive.pi();
    EXPECT_EQ(static_cast<int32_t>(uint32_t{pi[0]} << 16 | pi[1]), position);
  }
  Rig half({{"100", 10}, {"871", 4}});
  half.drive.take_po(runtime::PoSource::Sbus, std::array<uint16_t, 3>{6, 1, 1});
  half.tick();
  EXPECT_EQ(half.h[499], 0) << "one half alone is no position";
}

}  // namespace
}  // namespace ipos::tests
