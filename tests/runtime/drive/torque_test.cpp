// M-CONTROL (P700 = 12, 17): the setpoint is a current, the speed comes of it. The light machine of the rig takes 50 ms
// from 0 to 1500 rpm with rated torque, 30 rpm a millisecond, and needs 80 % of IN for that torque.
#include <array>

#include <cmath>

#include "tests/runtime/drive/drive_rig.hpp"

namespace ipos::tests {
namespace {

constexpr int32_t kCurrent = 2, kMaximumSpeed = 5;  // P870..P872 (1053 1610 p. 82)
constexpr uint16_t kEnable = 6;

// A digit of CURRENT is 0.1 % of IN.
constexpr uint16_t digits(double percent) {
  return static_cast<uint16_t>(static_cast<int16_t>(percent * 10));
}
constexpr double slope(double percent_of_in) { return 30 * percent_of_in / 80; }  // rpm a millisecond

struct TorqueRig : DriveRig {
  explicit TorqueRig(int mode = 12, const MachineData& machine = light_machine())
      : DriveRig("md60a", {}, machine) {
    bus_control();
    set("P700", mode);
    set("P871", kCurrent);
    set("P302", 3'000'000);
  }
};

TEST(Torque, TheSpeedComesOfTheTorque) {
  for (const int mode : {12, 17})
    for (const double percent : {40.0, 8.0, -20.0}) {
      TorqueRig rig(mode);
      rig.po({kEnable, digits(percent), 0});
      rig.run_ms(1);
      for (int n = 1; n <= 50; ++n) {
        const double before = rig.rpm();
        rig.run_ms(1);
        ASSERT_NEAR(rig.rpm() - before, slope(percent), 0.01) << mode << ", " << percent << ", " << n;
      }
      EXPECT_EQ(rig.state(), 6) << "torque control, as the unit shows it";
      EXPECT_NEAR(rig.drive.axis().active_current, percent * 1000, 1);
    }
}

// What the load takes is missing for the acceleration; what is less than the friction turns nothing.
TEST(Torque, LoadAndFriction) {
  MachineData machine = light_machine();
  machine.friction = 10'000;
  machine.load_torque = 20'000;
  TorqueRig rig(12, machine);
  rig.po({kEnable, digits(40), 0});  // 50 % torque
  rig.run_ms(1);
  const double before = rig.rpm();
  rig.run_ms(20);
  EXPECT_NEAR((rig.rpm() - before) / 20, 30 * (0.50 - 0.10 - 0.20), 0.01);
  TorqueRig standing(12, machine);
  standing.po({kEnable, digits(20), 0});  // 25 %: 5 % more than the load
  standing.run_ms(100);
  EXPECT_EQ(standing.drive.axis().position, 0);
}

TEST(Torque, SpeedAndCurrentAreLimited) {
  TorqueRig rig;
  rig.set("P302", 1'500'000);
  rig.po({kEnable, digits(40), 0});
  rig.run_ms(500);
  EXPECT_DOUBLE_EQ(rig.rpm(), 1500);
  EXPECT_EQ(rig.drive.axis().torque, 0) << "without load nothing is needed to hold it";
  rig.set("P872", kMaximumSpeed);
  rig.po({kEnable, digits(-40), 2500});  // digits of 0.2 rpm
  rig.run_ms(500);
  EXPECT_DOUBLE_EQ(rig.rpm(), -500);
  // The setpoint is cut at P303, and P303 leaves sqrt(100^2 - 60^2) = 80 % of active current.
  TorqueRig cut;
  cut.set("P303", 100'000);
  cut.po({kEnable, digits(150), 0});
  cut.run_ms(1);
  const double before = cut.rpm();
  cut.run_ms(10);
  EXPECT_EQ(cut.drive.setpoint().current, 100'000);
  EXPECT_NEAR((cut.rpm() - before) / 10, slope(80), 0.01);
}

TEST(Torque, StopIsARamp) {
  TorqueRig rig;
  rig.set("P131", 3'000);  // 1 rpm a millisecond
  rig.po({kEnable, digits(40), 0});
  rig.ms_until([&] { return rig.rpm() > 600; });
  const double speed = rig.rpm();
  rig.po({2, digits(40), 0});  // bit 2: stop
  rig.run_ms(100);
  EXPECT_NEAR(rig.rpm(), speed - 100, 0.01);
  EXPECT_NEAR(rig.ms_until_standing(), speed - 100, 2);
}

TEST(Torque, ChangeOfDirection) {
  TorqueRig rig;
  rig.set("P350", 1);
  rig.po({kEnable, digits(40), 0});
  rig.run_ms(20);
  EXPECT_LT(rig.rpm(), 0);
  EXPECT_EQ(rig.value("P000"), -rig.drive.axis().speed);
}

// A source that is no bus: the share of P302 is the share of P303.
TEST(Torque, AnalogSetpoint) {
  TorqueRig rig;
  rig.set("P100", 0);
  rig.set("P101", 0);
  rig.set("P115", 0);  // no filter
  rig.ai1(2'500);
  rig.run_ms(1);
  const double before = rig.rpm();
  rig.run_ms(10);
  EXPECT_EQ(rig.drive.setpoint().current, 150'000 / 4);
  EXPECT_NEAR((rig.rpm() - before) / 10, slope(37.5), 0.01);
}

// The firmware of a follower describes its words: a current in M-control, else a speed (MDX60B/61B p. 29).
TEST(Torque, AFollowerHasFixedDescriptions) {
  PROVES("MDB-MS-03");
  for (const int mode : {11, 12, 16, 17})
    for (const int source : {8, 9}) {
      DriveRig rig("mdxb");
      rig.set("P700", mode);
      rig.set("P100", source);
      const bool torque = mode == 12 || mode == 17;
      const std::pair<const char*, int> fixed[] = {
          {"P870", 9}, {"P871", torque ? 2 : 1}, {"P872", 12}, {"P873", 6}, {"P874", 1}, {"P875", 9}};
      for (const auto& [number, value] : fixed) {
        EXPECT_EQ(rig.value(number), value) << number << " " << mode;
        EXPECT_EQ(rig.write(number, 0), 0);
        EXPECT_EQ(rig.value(number), value) << number << " after a write";
      }
      EXPECT_EQ(rig.value("P876"), 1) << "nothing was changed, so nothing is blocked";
    }
}

// On: AI1 decides, and the master's control word and silence mean nothing. Off: the master's word again.
TEST(Torque, SlaveFreeRun) {
  PROVES("MDB-MS-09");
  for (const int mode : {0, 12}) {
    DriveRig rig("mdxb");
    rig.enable_terminals();
    rig.set("P700", mode);
    rig.set("P100", 8);
    rig.set("P601", 19);  // DI02: SLAVE FREE RUNN.
    rig.set("P302", 3'000'000);
    rig.set("P883", 1'000);
    rig.ai1(1'000);
    rig.input("DI02", true);
    rig.run_ms(3'000);
    EXPECT_EQ(rig.drive.fault(), 0) << "nobody is missed";
    if (mode == 0) {
      EXPECT_DOUBLE_EQ(rig.rpm(), 300) << "a tenth of 3000 rpm";
    } else {
      EXPECT_EQ(rig.drive.setpoint().current, 15'000) << "a tenth of P303";
    }
    rig.po({kEnable, 100, 0});
    rig.input("DI02", false);
    rig.run_ms(3'000);
    if (mode == 0) {
      EXPECT_DOUBLE_EQ(rig.rpm(), 20) << "the word of the master";
    } else {
      EXPECT_EQ(rig.drive.setpoint().current, 10'000);
    }
    rig.po({0, 100, 0});
    rig.run_ms(100);
    EXPECT_FALSE(rig.drive.verdict().command == runtime::Command::Enable) << "and its control word";
  }
}

// P304 bounds the active current in CFC and SERVO: 40 % of IN are half of the rated torque of a motor with 80 %, so 3 of the
// 6 rpm a millisecond that it makes of the shaft; the output current is that and the magnetizing current of 60 %.
TEST(TorqueLimit, BoundsTheActiveCurrent) {
  PROVES("DRV-09");
  MachineData machine = light_machine();
  machine.inertia = 400;
  for (const int mode : {0, 5, 11, 16})
    for (const int limit : {0, 40'000, 100'000, 150'000}) {
      SCOPED_TRACE(mode);
      DriveRig rig("md60a", {}, machine);
      rig.set("P700", mode);
      rig.set("P304", limit);
      rig.set("P130", 0);
      rig.set("P160", 1'400'000);
      rig.enable_terminals();
      rig.input("DI04", true);
      rig.run_ms(1);
      const double before = rig.rpm();
      rig.run_ms(50);
      const double current_limit = 150, most = std::sqrt(current_limit * current_limit - 60 * 60);
      const bool acts = mode >= 11 && limit != 0;
      const double active = std::min(most, acts ? limit / 1e3 : most);
      EXPECT_NEAR((rig.rpm() - before) / 50, active / 80 * 6, 0.006);
      EXPECT_NEAR(rig.drive.axis().output_current, 1e3 * std::hypot(active, 60), 3);
    }
}

}  // namespace
}  // namespace ipos::tests
