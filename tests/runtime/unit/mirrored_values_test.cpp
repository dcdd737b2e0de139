// The variables that are the same datum as a parameter of the PID controller (IPOSplus p. 38, 39): which is which, who
// wins, and what a value does that the parameter refuses.
#include "runtime/services/mirrored_values.hpp"

#include <gtest/gtest.h>

#include <array>

#include "runtime/unit/unit_interface.hpp"
#include "stdlib/unit_types.hpp"

namespace ipos::runtime {
namespace {

struct MirroredPair {
  size_t variable;
  const char* parameter;
  int32_t value, other, refused;
};
// The ranges are those of the table of parameters; P271 has all 32 bits.
constexpr MirroredPair kMirroredPairs[] = {{540, "260", 1, 2, 3},
                                           {541, "263", 32'000, 0, 32'001},
                                           {545, "266", -32'000, 7, 32'001},
                                           {546, "271", INT32_MIN, INT32_MAX, 0},
                                           {557, "284", -32'000, 32'000, -32'001},
                                           {558, "285", 32'000, -5, 32'001}};

struct MirrorRig {
  explicit MirrorRig(const char* unit = "mdxb") : server(*stdlib::find_unit(std::string_view(unit))) {}

  int32_t stored(const char* number) const {
    return server.parameters().stored(server.parameters().table().find(number)->index);
  }
  void set(const char* number, int32_t value) {
    ASSERT_TRUE(server.parameters().execute(ParameterService::Write,
                                            server.parameters().table().find(number)->index, value))
        << number;
  }
  void expect_agreed() {
    for (const MirroredPair& pair : kMirroredPairs)
      EXPECT_EQ(h[pair.variable], stored(pair.parameter)) << pair.parameter;
  }

  UnitInterface server;
  MirroredValues mirrored{server.parameters()};
  std::array<int32_t, 1024> h{};
};

TEST(MirroredVariables, ShowTheParametersAtFirst) {
  MirrorRig rig;
  for (const MirroredPair& pair : kMirroredPairs) rig.set(pair.parameter, pair.value);
  rig.h.fill(77);
  rig.mirrored.show(rig.h);
  for (const MirroredPair& pair : kMirroredPairs)
    EXPECT_EQ(rig.h[pair.variable], pair.value) << pair.parameter;
  size_t others = 0;
  for (const int32_t value : rig.h) others += value == 77 ? 1 : 0;
  EXPECT_EQ(others, rig.h.size() - std::size(kMirroredPairs));
}

TEST(MirroredVariables, FollowTheirParameterAndLeadIt) {
  for (const MirroredPair& pair : kMirroredPairs) {
    SCOPED_TRACE(pair.parameter);
    MirrorRig rig;
    rig.mirrored.show(rig.h);
    rig.expect_agreed();
    const auto before = rig.h;
    rig.set(pair.parameter, pair.value);
    rig.mirrored.show(rig.h);
    EXPECT_EQ(rig.h[pair.variable], pair.value);
    rig.mirrored.take(rig.h);
    EXPECT_EQ(rig.stored(pair.parameter), pair.value);
    rig.h[pair.variable] = pair.other;
    rig.mirrored.take(rig.h);
    EXPECT_EQ(rig.stored(pair.parameter), pair.other) << "written by the program";
    rig.mirrored.show(rig.h);
    EXPECT_EQ(rig.h[pair.variable], pair.other);
    rig.h[pair.variable] = before[pair.variable];
    EXPECT_EQ(rig.h, before) << "no other variable";
    rig.mirrored.take(rig.h);
    rig.expect_agreed();
  }
}

// A parameter that somebody else changes leaves alone what the program has written to another variable meanwhile.
TEST(MirroredVariables, OnlyWhatHasChangedIsShown) {
  for (const MirroredPair& pair : kMirroredPairs)
    for (const MirroredPair& other : kMirroredPairs) {
      if (&pair == &other) continue;
      MirrorRig rig;
      rig.mirrored.show(rig.h);
      rig.h[other.variable] = other.value;
      rig.set(pair.parameter, pair.value);
      rig.mirrored.show(rig.h);
      EXPECT_EQ(rig.h[pair.variable], pair.value);
      EXPECT_EQ(rig.h[other.variable], other.value) << other.parameter;
      rig.mirrored.take(rig.h);
      EXPECT_EQ(rig.stored(pair.parameter), pair.value);
      EXPECT_EQ(rig.stored(other.parameter), other.value);
    }
}

TEST(MirroredVariables, ARefusedValueIsTakenBack) {
  for (const MirroredPair& pair : kMirroredPairs) {
    if (pair.refused == 0) continue;
    SCOPED_TRACE(pair.parameter);
    MirrorRig rig;
    rig.set(pair.parameter, pair.value);
    rig.mirrored.show(rig.h);
    rig.h[pair.variable] = pair.refused;
    rig.mirrored.take(rig.h);
    EXPECT_EQ(rig.h[pair.variable], pair.value);
    EXPECT_EQ(rig.stored(pair.parameter), pair.value);
    rig.expect_agreed();
  }
}

// What the program writes is a volatile write: behind the power it is gone.
TEST(MirroredVariables, AreVolatile) {
  MirrorRig rig;
  rig.mirrored.show(rig.h);
  rig.h[541] = 2'000;
  rig.mirrored.take(rig.h);
  EXPECT_EQ(rig.stored("263"), 2'000);
  rig.server.power_cycle();
  EXPECT_EQ(rig.stored("263"), 1'000) << "the factory setting";
}

TEST(MirroredVariables, AUnitWithoutThemHasNone) {
  MirrorRig rig("md60a");
  rig.h.fill(77);
  const uint32_t changes = rig.server.parameters().changes();
  rig.mirrored.show(rig.h);
  rig.mirrored.take(rig.h);
  for (const int32_t value : rig.h) EXPECT_EQ(value, 77);
  EXPECT_EQ(rig.server.parameters().changes(), changes);
}

}  // namespace
}  // namespace ipos::runtime
