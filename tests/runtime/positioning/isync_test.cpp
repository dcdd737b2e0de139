// ISYNC: a slave axis that follows the position of a master, first the path of the master alone, then two
// drives with programs on an SBus.
#include "runtime/positioning/follower.hpp"
#include "tests/harness/proves.hpp"
#include "tests/runtime/bus_plan/plant_rig.hpp"

namespace ipos::tests {
namespace {

constexpr int kCycle = 5;

// The slave's way for a master that is at `master(t)` ms, told every kCycle ms.
template <typename F>
std::vector<double> followed(F master, int ms, int gear_master = 1, int gear_slave = 1) {
  Follower follower;
  std::vector<double> path;
  int64_t way = 0;
  for (int t = 0; t < ms; ++t) {
    MasterInputs inputs;
    inputs.sync = t % kCycle == 0;
    inputs.position = wrapped(master(t));
    inputs.gear_master = gear_master;
    inputs.gear_slave = gear_slave;
    follower.tick(inputs);
    way += follower.step();
    path.push_back(static_cast<double>(way) / static_cast<double>(kIncrement));
  }
  return path;
}

// From the third telegram on the line is the master's: what it moves in a millisecond the slave moves.
TEST(Follower, ConstantSpeedIsFollowedWithoutLag) {
  const auto master = [](int t) { return int64_t{40} * t; };
  const std::vector<double> path = followed(master, 200);
  const double offset = path[20] - 40.0 * 20;
  for (size_t t = 20; t < path.size(); ++t)
    ASSERT_NEAR(path[t], offset + 40.0 * static_cast<double>(t), 1e-3) << t;
}

TEST(Follower, RestsWhereTheMasterRestsAndNothingAddsUp) {
  const auto master = [](int t) { return int64_t{t < 1000 ? t : 2000 - t} * (t < 2000 ? 7 : 0); };
  const std::vector<double> path = followed(master, 2'200);
  EXPECT_NEAR(path.back(), 0, 1e-6);
  const std::vector<double> geared =
      followed([](int t) { return int64_t{3} * std::min(t, 1000); }, 1'100, 3, -2);
  EXPECT_NEAR(geared.back(), -2'000, 1e-3);
}

TEST(Follower, PassesTheEndOfTheRange) {
  const auto master = [](int t) { return int64_t{INT32_MAX} - 1'000 + 10 * t; };
  const std::vector<double> path = followed(master, 300);
  for (size_t t = 20; t < path.size(); ++t) ASSERT_NEAR(path[t] - path[t - 1], 10, 1e-3) << t;
}

// The gear always rounds down, to 2^-20 increments, whatever the signs: through 0 the slave goes as evenly as
// anywhere else.
TEST(Follower, TheGearRoundsDown) {
  for (const int gear_master : {1, 3, 7, -3, -7})
    for (const int gear_slave : {1, 5, -1, -5})
      for (const int place : {1, 21, 1'000, -1, -21, -1'000}) {
        SCOPED_TRACE(testing::Message() << gear_slave << " / " << gear_master << " to " << place);
        Follower follower;
        int64_t way = 0;
        for (int t = 0; t < 50; ++t) {
          MasterInputs inputs;
          inputs.sync = t % kCycle == 0;
          inputs.position = t < kCycle ? 0 : place;
          inputs.gear_master = gear_master;
          inputs.gear_slave = gear_slave;
          follower.tick(inputs);
          way += follower.step();
        }
        const int64_t rest = kIncrement * place * gear_slave - way * gear_master;
        EXPECT_GE(rest * gear_master, 0);
        EXPECT_LT(std::abs(rest), std::abs(gear_master));
      }
}

// A master that has gone round the circle of its count many times: still one rounding, not one for each round.
TEST(Follower, ALongWayIsRoundedOnce) {
  constexpr int kTelegrams = 64;
  for (const int gear_master : {3, 7, -3, -7})
    for (const int sign : {1, -1}) {
      SCOPED_TRACE(testing::Message() << "1 / " << gear_master << ", way " << sign);
      Follower follower;
      Wide way = 0;
      for (int t = 0; t < (kTelegrams + 10) * kCycle; ++t) {
        MasterInputs inputs;
        inputs.sync = t % kCycle == 0;
        inputs.position = wrapped(int64_t{sign} * std::min(t / kCycle, kTelegrams) << 30);
        inputs.gear_master = gear_master;
        follower.tick(inputs);
        way += follower.step();
      }
      const Wide rest = (Wide{sign} * kTelegrams << 30) * kIncrement - way * gear_master;
      EXPECT_GE(static_cast<int64_t>(rest) * gear_master, 0);
      EXPECT_LT(std::abs(static_cast<int64_t>(rest)), std::abs(gear_master));
    }
}

// Numbers of a program: what comes of them is bounded, and keeps its direction.
TEST(Follower, TakesAnyGear) {
  constexpr double kMost = 4'294'967'296.0;
  const auto master = [](int t) { return int64_t{1'000'000} * t; };
  for (const auto& [gear, sign] : {std::pair{INT32_MAX, 1.0}, std::pair{INT32_MIN, -1.0}}) {
    const std::vector<double> path = followed(master, 300, 1, gear);
    for (size_t t = 20; t < path.size(); ++t) ASSERT_EQ(path[t] - path[t - 1], sign * kMost) << t;
  }
}

// Half a circle each cycle counts as backwards: 2^41 increments are reached after 5 s.
TEST(Follower, TakesAnyWay) {
  Follower follower;
  MasterInputs inputs;
  for (int t = 0; t < 30'000; ++t) {
    inputs.sync = t % kCycle == 0;
    inputs.position = t / kCycle % 2 == 0 ? 0 : INT32_MIN;
    follower.tick(inputs);
    if (t < 20) continue;
    ASSERT_NEAR(static_cast<double>(follower.step()) / static_cast<double>(kIncrement),
                static_cast<double>(INT32_MIN) / kCycle, 1e-3)
        << t;
  }
}

TEST(Follower, IsLostAfterThreeCycles) {
  Follower follower;
  MasterInputs inputs;
  for (int t = 0; t < 11; ++t) {
    inputs.sync = t % kCycle == 0;
    inputs.position = 10 * t;
    follower.tick(inputs);
    EXPECT_EQ(follower.known(), t == 10) << t;
  }
  inputs.sync = false;
  for (int t = 0; t < 14; ++t) {
    follower.tick(inputs);
    EXPECT_TRUE(follower.known()) << t;
    EXPECT_NEAR(static_cast<double>(follower.step()) / static_cast<double>(kIncrement), 10, 1e-3);
  }
  follower.tick(inputs);
  EXPECT_FALSE(follower.known());
  EXPECT_TRUE(follower.silent());
  EXPECT_EQ(follower.step(), 0);
  // It begins anew: where the master has gone meanwhile is no way, and the third telegram makes it known again.
  for (int t = 0; t < 15; ++t) {
    inputs.sync = t % kCycle == 0;
    inputs.position = 1'000'000 + 20 * t;
    follower.tick(inputs);
    EXPECT_EQ(follower.known(), t >= 10) << t;
    EXPECT_NEAR(static_cast<double>(follower.step()) / static_cast<double>(kIncrement),
                t < 5    ? 0
                : t < 10 ? 40
                         : 20,
                1e-3)
        << t;
  }
}

constexpr const char* kMaster = R"(#include <constb.h>
SCTRCYCL Send;
main() {
  Send.ObjectNo = 1100; Send.CycleTime = 5; Send.Format = 4; Send.DPointer = numof(ActPos_Mot);
  _SBusCommDef(SCD_TRCYCL, Send);
  _SBusCommOn();
  _Wait(500);
  _GoAbs(GO_WAIT, 200000);
  _Wait(500);
  _GoAbs(GO_WAIT, 0);
}
)";
constexpr const char* kSlave = R"(#include <constb.h>
SCREC Receive; long lMaster;
main() {
  Receive.ObjectNo = 1100; Receive.Format = 4; Receive.DPointer = numof(lMaster);
  _SBusCommDef(SCD_REC, Receive);
  _SBusCommOn();
  SyncSource = numof(lMaster);
  _Wait(START);
  SyncControl = 1;
}
)";

class MasterAndSlave {
 public:
  explicit MasterAndSlave(const std::string& start = "100", const std::string& slave = "", const std::string& more = "",
                const std::string& technology = "2")
      : rig(bus_text() + station("master", "P881 = 1\n") +
                station("slave", "P881 = 2\nP077 = " + technology + "\n" + slave) +
                "[[control]]\nname = \"clock\"\nsbus = \"sbus\"\nsync = 300\ncycle = \"5ms\"\n" + more,
            {{"master.ipc", kMaster}, {"slave.ipc", with_start(start)}}, vm::Rates{{20, 20, 20}}) {}

  void run(int ms) { rig.run_until(end += ms * kMillisecond); }
  int32_t master(const char* name) { return rig.variable(0, name); }
  int32_t slave(const char* name) { return rig.variable(1, name); }

  static std::string with_start(const std::string& start) {
    std::string text = kSlave;
    return text.replace(text.find("START"), 5, start);
  }
  static std::string station(const std::string& name, const std::string& parameters) {
    return station_text(name, "P700 = 13\nP885 = 300000\n" + parameters, "mdxb", name + ".ipc") +
           "[station.inputs]\nDI00 = 1\nDI01 = 1\nDI03 = 1\n";
  }

  // How often the unit said that the master leads beyond a software limit switch.
  size_t told_of_limit() {
    const auto& entries = rig.get().journal().entries();
    return static_cast<size_t>(std::count_if(entries.begin(), entries.end(), [](const JournalEntry& entry) {
      return entry.text.find("leads beyond a software limit switch") != std::string::npos;
    }));
  }

  PlantRig rig;
  Time end = 0;
};

// A ramp of the master up, down and back: never further away than what the master does in a cycle of the bus,
// and never with a lag error of the slave's own of that size.
TEST(Isync, SlaveFollowsWithinOneCycle) {
  PROVES("MDB-TOC-22");
  MasterAndSlave pair;
  pair.run(480);
  EXPECT_EQ(pair.slave("H562"), 2);
  constexpr int kOneCycle = 512;  // 1500 rpm are 102.4 increments a millisecond
  int fastest = 0, before = 0, behind = 0, own_lag = 0;
  for (int t = 480; t < 6'500; ++t) {
    pair.run(1);
    const int32_t master = pair.master("H511");
    fastest = std::max(fastest, std::abs(master - before));
    before = master;
    behind = std::max(behind, std::abs(master - pair.slave("H511")));
    own_lag = std::max(own_lag, std::abs(pair.slave("H495")));
    ASSERT_LT(std::abs(master - pair.slave("H511")), kOneCycle) << t << " ms";
    ASSERT_EQ(pair.slave("H562"), 2) << t << " ms";
    if (t == 3'300) {
      EXPECT_EQ(master, 200'000);
      EXPECT_EQ(pair.slave("H511"), 200'000);
    }
  }
  EXPECT_GE(fastest, 102) << "the master was as fast as it may be";
  EXPECT_LT(own_lag, kOneCycle);
  EXPECT_EQ(pair.slave("H511"), 0);
  EXPECT_EQ(pair.told_of_limit(), 0U) << "there is none";
  RecordProperty("furthest_behind", behind);
}

// Coupled to a running master: up to its speed on the ramp P911, and what was lost stays lost.
TEST(Isync, CouplesOnTheRamp) {
  MasterAndSlave pair("1200", "P911 = 500\n");
  pair.run(1'199);
  EXPECT_EQ(pair.slave("H511"), 0);
  pair.run(3);
  EXPECT_EQ(pair.slave("H562"), 1);
  pair.run(258);  // 1500 rpm take 250 ms
  EXPECT_EQ(pair.slave("H562"), 2);
  const int32_t lost = pair.master("H511") - pair.slave("H511");
  pair.run(1'800);  // until 3260 ms: the travel ends at 2953 ms, the next one begins at 3430 ms
  EXPECT_NEAR(pair.master("H511") - pair.slave("H511"), lost, 110) << "the master has stopped";
  EXPECT_EQ(pair.master("H511"), 200'000);
}

// Coupling ends at 12 000 rpm at the latest (docs/inside/positioning.md, ISYNC): four times P911, which is the time for
// 3000 rpm.
TEST(Isync, CouplesUpToTwelveThousandRpm) {
  for (const char* gear : {"2147483647", "-2147483647"}) {
    MasterAndSlave pair("1200); H564 = " + std::string(gear) + "; _Wait(1", "P911 = 250\nP923 = 0\n");
    pair.run(1'215);
    EXPECT_EQ(pair.slave("H562"), 1);
    pair.run(975);
    EXPECT_EQ(pair.slave("H562"), 1) << "1000 ms are not over";
    pair.run(25);
    EXPECT_EQ(pair.slave("H562"), 2) << gear;
  }
}

TEST(Isync, OnlyWithTheTechnologyFunction) {
  MasterAndSlave pair("100", "", "", "0");
  pair.run(3'000);
  EXPECT_EQ(pair.slave("H562"), 0);
  EXPECT_EQ(pair.slave("H511"), 0);
}

// Without sync telegrams the axis stops on P912 and says why; H492 is where that ends.
TEST(Isync, LosesTheMaster) {
  MasterAndSlave pair("100", "P912 = 800\n", fault_text("cut", "station = \"slave\"\nfrom = \"1200ms\"\n"));
  pair.run(1'190);
  EXPECT_EQ(pair.slave("H562"), 2);
  pair.run(40);
  EXPECT_EQ(pair.slave("H562"), 0);
  pair.run(450);  // 1500 rpm in 400 ms
  const int32_t place = pair.slave("H511");
  EXPECT_EQ(place, pair.slave("H492"));
  pair.run(500);
  EXPECT_EQ(pair.slave("H511"), place);
  const auto& entries = pair.rig.get().journal().entries();
  EXPECT_TRUE(std::any_of(entries.begin(), entries.end(), [](const JournalEntry& entry) {
    return entry.text.find("no sync telegram for three cycles") != std::string::npos;
  }));
}

// Whatever the program writes, the slave follows as far as it can.
TEST(Isync, AnyGear) {
  for (const char* gear : {"2147483647", "-2147483647"}) {
    MasterAndSlave pair("100); H564 = " + std::string(gear) + "; _Wait(1", "P923 = 0\n");
    pair.run(7'000);
    EXPECT_EQ(pair.slave("H564"), std::stoi(gear));
    EXPECT_NE(pair.slave("H562"), 0);
  }
}

TEST(Isync, StopsAtASoftwareLimitSwitch) {
  MasterAndSlave pair("100", "P903 = 5\nP920 = 50000\nP921 = -50000\nP941 = 2\n");
  pair.run(4'000);
  EXPECT_EQ(pair.slave("H562"), 0);
  EXPECT_GT(pair.slave("H509"), 50'000);
  EXPECT_LT(pair.slave("H509"), 50'000 + 25'600 + 200) << "1500 rpm on P912 of 1 s for 3000 rpm";
  EXPECT_EQ(pair.told_of_limit(), 1U) << "it is followed no more, so it is told once";
}

}  // namespace
}  // namespace ipos::tests
