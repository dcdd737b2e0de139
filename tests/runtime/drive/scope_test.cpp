// The scope in a MOVIDRIVE B (11264926 chapter 8.7.4): what it records, and when.
#include "runtime/drive/scope.hpp"

#include "runtime/drive/indices.hpp"
#include "tests/runtime/drive/drive_rig.hpp"

namespace ipos::tests {
namespace {

namespace index = runtime::index;
using runtime::Scope;

Scope::Sample sample(int32_t value) { return {value, -value, 0, 1}; }

// Feeds 0, 1, 2, ... one a millisecond, until it is done.
int run(Scope& scope, int from = 0) {
  int value = from;
  for (; scope.runs() && value < from + 10'000; ++value)
    if (scope.tick()) scope.take(sample(value));
  return value;
}

TEST(Scope, WithoutATriggerItRecordsAtOnce) {
  Scope scope;
  EXPECT_EQ(scope.state(), Scope::State::Off);
  scope.start({3, Scope::Edge::None, 0, 10, 5});
  EXPECT_EQ(run(scope), 28) << "ten samples, three milliseconds apart";
  EXPECT_EQ(scope.state(), Scope::State::Done);
  ASSERT_EQ(scope.recorded(), 10U);
  for (uint32_t n = 0; n < 10; ++n) {
    EXPECT_EQ(scope.value(0, n), static_cast<int32_t>(3 * n));
    EXPECT_EQ(scope.value(1, n), -static_cast<int32_t>(3 * n));
  }
}

TEST(Scope, BeforeAndBehindTheTrigger) {
  for (const uint32_t before : {0U, 1U, 7U, 19U}) {
    Scope scope;
    scope.start({1, Scope::Edge::Rising, 100, 20, before});
    run(scope);
    ASSERT_EQ(scope.recorded(), 20U) << before;
    for (uint32_t n = 0; n < 20; ++n)
      EXPECT_EQ(scope.value(0, n), 100 + static_cast<int32_t>(n) - static_cast<int32_t>(before)) << before;
  }
}

// An edge is one only from the other side; what is there from the beginning is none.
TEST(Scope, AnEdgeHasTwoSides) {
  Scope scope;
  scope.start({1, Scope::Edge::Rising, 100, 10, 2});
  for (const int value : {150, 150, 150, 150, 90, 120})
    if (scope.tick()) scope.take(sample(value));
  EXPECT_EQ(scope.state(), Scope::State::Recording);
  run(scope, 121);
  EXPECT_EQ(scope.value(0, 0), 150);
  EXPECT_EQ(scope.value(0, 1), 90);
  EXPECT_EQ(scope.value(0, 2), 120);
  scope.start({1, Scope::Edge::Falling, 100, 10, 0});
  for (const int value : {50, 110, 100})
    if (scope.tick()) scope.take(sample(value));
  EXPECT_EQ(scope.state(), Scope::State::Recording);
}

// Over the parameters: the run-up of a drive, triggered by its speed.
TEST(Scope, OfADrive) {
  PROVES("MDB-TOC-28");
  DriveRig rig("mdxb");
  rig.bus_control();
  rig.set("P130", 2'000);  // 1.5 rpm a millisecond
  const auto write = [&](uint16_t parameter, int32_t value) {
    EXPECT_TRUE(rig.parameters.execute(ParameterService::WriteVolatile, parameter, value)) << parameter;
  };
  write(index::kScopeChannel, index::kSpeed);
  write(index::kScopeChannel + 1, 9);  // nothing of the drive
  write(index::kScopeTime, 2);
  write(index::kScopeTrigger, 1);
  write(index::kScopeLevel, 300'000);
  write(index::kScopeSamples, 40);
  write(index::kScopeBefore, 10);
  write(index::kScopeControl, 1);
  EXPECT_EQ(rig.parameters.value(index::kScopeControl), 1);
  rig.run_ms(500);
  EXPECT_EQ(rig.parameters.value(index::kScopeState), static_cast<int32_t>(Scope::State::Waiting));
  rig.po({0x0006, 5000, 0});
  rig.settle();
  EXPECT_EQ(rig.parameters.value(index::kScopeState), static_cast<int32_t>(Scope::State::Done));
  EXPECT_EQ(rig.parameters.value(index::kScopeControl), 0);
  ASSERT_EQ(rig.parameters.value(index::kScopeRecorded), 40);
  int32_t last = 0;
  for (int32_t n = 0; n < 40; ++n) {
    write(index::kScopePosition, n);
    const int32_t speed = rig.parameters.value(index::kScopeValue);
    EXPECT_EQ(speed >= 300'000, n >= 10) << n;
    EXPECT_EQ(n == 0 ? 3'000 : speed - last, 3'000) << n;
    last = speed;
    write(index::kScopePosition, 1000 + n);
    EXPECT_EQ(rig.parameters.value(index::kScopeValue), 0);
  }
  write(index::kScopePosition, 40);
  EXPECT_EQ(rig.parameters.value(index::kScopeValue), 0) << "there is no such sample";
}

// It sees every millisecond, also of a drive that stands still.
TEST(Scope, KeepsTheDriveInTurn) {
  DriveRig rig("mdxb");
  rig.run_ms(100);
  const Drive::Moment before = rig.drive.moment();
  rig.run_ms(1);
  EXPECT_NE(rig.drive.steady_since(before), 0U);
  EXPECT_TRUE(rig.parameters.execute(ParameterService::WriteVolatile, index::kScopeControl, 1));
  rig.run_ms(2);
  const Drive::Moment running = rig.drive.moment();
  rig.run_ms(1);
  EXPECT_EQ(rig.drive.steady_since(running), 0U);
  rig.run_ms(497);
  EXPECT_EQ(rig.parameters.value(index::kScopeState), static_cast<int32_t>(Scope::State::Done));
  const Drive::Moment done = rig.drive.moment();
  rig.run_ms(1);
  EXPECT_NE(rig.drive.steady_since(done), 0U);
}

}  // namespace
}  // namespace ipos::tests
