// [station.encoders] in a plant: the shaft of a station at X14 of another one (H510), and at X42 as master of its DRS card.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/runtime/bus_plan/plant_rig.hpp"

namespace ipos::tests {
namespace {

constexpr int kMaster = 0, kSlave = 1;

// The master turns while DI04 (n11) of it is 1.
std::string master_text(const std::string& parameters = "") {
  return bus_text() + "[[station]]\nname = \"master\"\nunit = \"mdxb\"\nsbus = \"sbus\"\n[station.parameters]\nP700 = 11\nP323 = 0\nP301 = 0\n" + parameters +
         "[station.inputs]\nDI00 = 1\nDI01 = 1\nDI03 = 1\nDI04 = 1\n";
}
std::string slave_text(const std::string& encoders, const std::string& parameters = "", const std::string& unit = "mdxb",
                       const std::string& keys = "") {
  return "[[station]]\nname = \"slave\"\nunit = \"" + unit + "\"\nsbus = \"sbus\"\n" + keys + "[station.parameters]\nP813 = 2\nP323 = 0\nP301 = 0\n" + parameters +
         "[station.inputs]\nDI00 = 1\nDI01 = 1\nDI03 = 1\n" + encoders;
}

class Axes {
 public:
  explicit Axes(const std::string& encoders, const std::string& slave = "", const std::string& master = "", const std::string& more = "",
                const std::string& unit = "mdxb")
      : rig(master_text(master) + slave_text(encoders, slave, unit) + more) {}

  void run(int ms) { rig.run_until(end += ms * kMillisecond); }
  int32_t shaft(size_t n) { return rig.station(n).shaft_position(); }
  int32_t h(size_t n, uint32_t number) { return rig.station(n).variable(number); }
  void input(size_t n, int line, bool level) { rig.station(n).inputs().line(static_cast<size_t>(line)).set = level ? 1 : 0; }
  bool output(size_t n, int bit) { return (rig.station(n).outputs() >> bit & 1) != 0; }

  PlantRig rig;
  Time end = 0;
};

constexpr const char* kX14 = "[station.encoders]\nX14 = \"master\"\n";
constexpr const char* kX42 = "[station.encoders]\nX42 = \"master\"\n";
constexpr const char* kSync = "P700 = 14\nP241 = 0\nP630 = 16\nP631 = 17\nP632 = 18\n";
constexpr int kFirst = 8;  // DO10, of P630

// H510 is where the shaft of the master was a millisecond ago; the slave itself does not turn.
TEST(EncoderX14, CountsTheOtherShaft) {
  for (const char* unit : {"md60a", "compact", "mdxb"}) {
    Axes axes(kX14, "", "", "", unit);
    axes.run(50);
    for (int n = 0; n < 500; ++n) {
      const int32_t before = axes.shaft(kMaster);
      axes.run(1);
      ASSERT_EQ(axes.h(kSlave, 510), before) << unit << " " << n;
    }
    EXPECT_GT(axes.h(kSlave, 510), 1'000);
    EXPECT_EQ(axes.h(kSlave, 511), 0);
  }
}

// It begins at 0 whenever the unit is switched on, as incremental encoders do.
TEST(EncoderX14, BeginsAtZero) {
  Axes axes(kX14);
  axes.run(1'000);
  EXPECT_GT(axes.h(kSlave, 510), 1'000);
  axes.rig.get().set_power("slave", false);
  axes.run(100);
  const int32_t there = axes.shaft(kMaster);
  axes.rig.get().set_power("slave", true);
  axes.run(101);
  EXPECT_NEAR(axes.h(kSlave, 510), axes.shaft(kMaster) - there, 25);
}

// Without the table X14 follows the motor, as ever.
TEST(EncoderX14, FollowsTheMotorWithoutIt) {
  Axes axes("", "P942 = 2\nP943 = 1\n");
  axes.input(kSlave, 4, true);
  axes.run(1'000);
  EXPECT_GT(axes.h(kSlave, 511), 1'000);
  EXPECT_NEAR(axes.h(kSlave, 510), axes.h(kSlave, 511) / 2.0, 1);
}

TEST(EncoderPlant, LeavingOutMillisecondsChangesNothing) {
  for (const char* encoders : {kX14, kX42}) {
    Axes plain(encoders, kSync), lazy(encoders, kSync);
    plain.rig.station(kSlave).use_pace(Pace::InTurn);
    plain.rig.station(kMaster).use_pace(Pace::InTurn);
    for (int n = 0; n < 40; ++n) {
      for (Axes* axes : {&plain, &lazy}) {
        if (n == 10) axes->input(kMaster, 4, false);
        if (n == 30) axes->input(kMaster, 4, true);
        axes->run(97);
      }
      ASSERT_EQ(plain.h(kSlave, 510), lazy.h(kSlave, 510)) << n;
      ASSERT_EQ(plain.shaft(kSlave), lazy.shaft(kSlave)) << n;
    }
  }
}

// ISYNC with the master at X14, cut in where the master has made 50 000 increments, with bit 1 of H561: the slave goes beyond the speed
// of the master and arrives where it would be had it been in step from there on. 750 rpm are 51.2 increments a
// millisecond, P911 is 0.4096 of them a millisecond more: 125 ms up to the speed, which lose 3200 increments, and 2 sqrt(3200 /
// 0.4096) ms beyond it and back. Without bit 1 the 3200 stay lost.
TEST(EncoderX14, IsyncCutsInAndCatchesUp) {
  constexpr const char* kProgram =
      "#include <constb.h>\nlong lStart;\nmain() {\n  SyncSource = 510;\n  while (ActPos_Ext < 50000) { }\n  SyncControl = BITS;\n  lStart = ActPos_Ext;\n}\n";
  for (const auto& [bits, time, lost] : {std::tuple("3", 125 + 2 * std::sqrt(3'200 / 0.4096), 0), std::tuple("1", 125.0, 3'200)}) {
    std::string program = kProgram;
    program.replace(program.find("BITS"), 4, bits);
    PlantRig rig(master_text("P160 = \"750 rpm\"\nP130 = \"0.1 s\"\n") +
                     slave_text(kX14, "P700 = 13\nP077 = 2\nP911 = 500\n", "mdxb", "program = \"s.ipc\"\n"),
                 {{"s.ipc", program}}, vm::Rates{{20, 20, 20}});
    Time end = 0;
    int coupling = 0, before = 0;
    const auto state = [&] { return rig.variable(kSlave, "H562"); };
    while (state() != 2 && end < 5'000 * kMillisecond) {
      rig.run_until(end += kMillisecond);
      (state() == 1 ? coupling : before) += 1;
    }
    EXPECT_NEAR(before, 50'000 / 51.2, 60);
    EXPECT_NEAR(coupling, time, 20) << bits;  // at its end steps of the ramp and telegrams count
    rig.run_until(end += 500 * kMillisecond);
    const int32_t way = rig.variable(kSlave, "H510") - rig.variable(kSlave, "lStart");
    EXPECT_NEAR(way - rig.variable(kSlave, "H511"), lost, 3 * 51.2) << "within the milliseconds between program and positioning";
  }
}

// In step at constant speed, with the lag of a proportional controller while the master accelerates, and exactly at its place
// when it stands.
TEST(DrsPlant, SlaveFollowsItsMaster) {
  Axes axes(kX42, kSync, "P160 = \"1000 rpm\"\nP302 = \"3000 rpm\"\nP130 = \"2 s\"\nP131 = \"2 s\"\n");
  axes.run(650);  // on the ramp: 0.1024 increments per ms and ms
  const double ramp_lag = 0.1024 * 5.5 / 0.01;  // the axis turns at the mean of the last two speeds
  EXPECT_NEAR(axes.shaft(kMaster) - axes.shaft(kSlave), ramp_lag, 2);
  axes.run(2'000);
  for (int n = 0; n < 200; ++n) {
    axes.run(1);
    ASSERT_NEAR(axes.shaft(kMaster), axes.shaft(kSlave), 2) << n;
  }
  EXPECT_TRUE(axes.output(kSlave, kFirst)) << "/prewarning";
  EXPECT_TRUE(axes.output(kSlave, kFirst + 1)) << "/lag error";
  EXPECT_TRUE(axes.output(kSlave, kFirst + 2)) << "in position";
  axes.input(kMaster, 4, false);
  axes.run(3'000);
  EXPECT_GT(axes.shaft(kMaster), 100'000);
  EXPECT_NEAR(axes.shaft(kMaster), axes.shaft(kSlave), 1);
}

TEST(DrsPlant, ElectronicGear) {
  Axes axes(kX42, std::string(kSync) + "P221 = 5\nP222 = 2\n");
  axes.run(2'000);
  axes.input(kMaster, 4, false);
  axes.run(3'000);
  EXPECT_GT(axes.shaft(kMaster), 10'000);
  EXPECT_NEAR(axes.shaft(kSlave), axes.shaft(kMaster) * 2 / 5.0, 1);
}

// Free running by SLAVE FREE RUNN. at DI05: the setpoints of the slave act; in mode 2 it comes back.
TEST(DrsPlant, FreeRunningAndBack) {
  Axes axes(kX42, std::string(kSync) + "P223 = 1\nP604 = 19\nP603 = 4\nP160 = \"300 rpm\"\nP130 = \"0.1 s\"\nP240 = \"900 rpm\"\nP302 = \"3000 rpm\"\n");
  axes.input(kMaster, 4, false);
  axes.run(100);
  axes.input(kSlave, 5, true);
  axes.input(kSlave, 4, true);  // n11 of the slave
  axes.run(1'000);
  EXPECT_NEAR(axes.shaft(kSlave), 20.48 * 1'000, 400);
  EXPECT_EQ(axes.shaft(kMaster), 0);
  axes.input(kSlave, 4, false);
  axes.input(kSlave, 5, false);
  axes.run(3'000);
  EXPECT_NEAR(axes.shaft(kSlave), 0, 1);
}

// A slave that cannot: F42 after P513, with the response of P834.
TEST(DrsPlant, LagError) {
  for (const auto& [response, fault] : {std::pair("0", 0), std::pair("3", 42)}) {
    Axes axes(kX42, std::string(kSync) + "P302 = \"60 rpm\"\nP512 = 1000\nP513 = \"0.2 s\"\nP834 = " + response + "\n", "P160 = \"150 rpm\"\nP130 = \"0.1 s\"\n");
    axes.run(3'000);
    EXPECT_EQ(axes.rig.station(kSlave).fault(), fault);
    EXPECT_FALSE(axes.output(kSlave, kFirst));
    EXPECT_FALSE(axes.output(kSlave, kFirst + 1));
    EXPECT_FALSE(axes.output(kSlave, kFirst + 2));
    EXPECT_EQ(axes.rig.says("slave: F42: the slave has been more than P512 away from its master"), 1U);
  }
}

// DRS SLAVE START at DI05, and why the slave stands.
TEST(DrsPlant, WaitsForItsStart) {
  Axes axes(kX42, std::string(kSync) + "P604 = 23\nP302 = \"3000 rpm\"\n");
  axes.run(1'000);
  EXPECT_EQ(axes.shaft(kSlave), 0);
  EXPECT_EQ(axes.rig.says("not enabled: the slave stands (DRS)"), 1U);
  axes.input(kSlave, 5, true);
  axes.run(3'000);
  EXPECT_NEAR(axes.shaft(kMaster), axes.shaft(kSlave), 2);
}

// Without X42, or in another mode, the drive turns at its own setpoint, and the journal tells it where SYNC. is chosen.
TEST(DrsPlant, NeedsItsMasterAndItsMode) {
  Axes alone("", kSync), other(kX42, "P700 = 11\n");
  for (Axes* axes : {&alone, &other}) {
    axes->run(500);
    EXPECT_EQ(axes->shaft(kSlave), 0);
    axes->input(kSlave, 4, true);
    axes->run(500);
    EXPECT_GT(axes->shaft(kSlave), 500);
  }
  EXPECT_EQ(alone.rig.says("P700 Operating mode 1 is CFC & SYNC.: the drive turns at its own setpoint"), 1U);
  EXPECT_EQ(other.rig.says("synchronous operation"), 0U);
}

}  // namespace
}  // namespace ipos::tests
