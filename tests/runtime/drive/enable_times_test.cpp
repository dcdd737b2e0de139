// From the enable to the first step of the ramp (docs/inside/motion.md, enable and stop): with premagnetization P and
// brake release time R that step falls into millisecond P + R + 1. The output stage is on from the first one, the
// brake opens behind the premagnetization.
#include "tests/runtime/drive/drive_rig.hpp"

namespace ipos::tests {
namespace {

struct EnableTimes {
  int stage = 0, brake = 0, ramp = 0;  // the millisecond of each, counted from 1
};

EnableTimes enable_times(DriveRig& rig) {
  EnableTimes seen;
  rig.enable_terminals();
  rig.ai1(10'000);
  for (int ms = 1; ms <= 1000 && seen.ramp == 0; ++ms) {
    rig.run_ms(1);
    if (seen.stage == 0 && rig.stage()) seen.stage = ms;
    if (seen.brake == 0 && rig.brake_released()) seen.brake = ms;
    if (rig.drive.axis().setpoint != 0) seen.ramp = ms;
  }
  return seen;
}

TEST(EnableTimes, PremagnetizationThenBrakeReleaseThenTheRamp) {
  for (const int magnetize : {0, 1, 70, 300})
    for (const int release : {0, 1, 45}) {
      SCOPED_TRACE("P323 = " + std::to_string(magnetize) + ", P731 = " + std::to_string(release));
      DriveRig rig("md60a");
      rig.set("P323", magnetize);
      rig.set("P731", release);
      const EnableTimes seen = enable_times(rig);
      EXPECT_EQ(seen.stage, 1);
      EXPECT_EQ(seen.brake, magnetize + 1);
      EXPECT_EQ(seen.ramp, magnetize + release + 1);
    }
}

TEST(EnableTimes, OfTheSecondMotorAreThoseOfItsParameters) {
  DriveRig rig("md60a");
  rig.set("P323", 10);
  rig.set("P333", 120);
  rig.set("P734", 30);
  rig.set("P603", 7);  // DI04 parameter switchover
  rig.input("DI04", true);
  rig.run_ms(1);
  const EnableTimes seen = enable_times(rig);
  EXPECT_EQ(seen.stage, 1);
  EXPECT_EQ(seen.brake, 120 + 1);
  EXPECT_EQ(seen.ramp, 120 + 30 + 1);
}

TEST(EnableTimes, OfMovitrac07) {
  DriveRig rig("mc07");
  rig.set("P323", 70);
  const EnableTimes seen = enable_times(rig);
  EXPECT_EQ(seen.stage, 1);
  EXPECT_EQ(seen.ramp, 70 + 1);
}

}  // namespace
}  // namespace ipos::tests
