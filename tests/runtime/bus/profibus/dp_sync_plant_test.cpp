// Sync and Freeze of MOVITRAC 31 in a plant: by frames of a master, from the line, and by the commands of a plant file's master. What
// acts is read at the axis (MOVITRAC 31 PROFIBUS, 3.5; the bits of Global_Control are those of EN 50170 volume 2).
#include <set>

#include "tests/runtime/bus/profibus/hand_rig.hpp"

namespace ipos::tests {
namespace {

constexpr uint8_t kUnfreeze = 0x04, kFreeze = 0x08, kUnsync = 0x10, kSync = 0x20;
const std::string kSlow = "00 06 05 DC";  // 1500 x 0.2 rpm
const std::string kFast = "00 06 0B B8";  // twice that

TEST(DpSync, SyncHoldsTheSetpoints) {
  PROVES("DP-SYNC-01", "DP-SYNC-03", "DP-SYNC-08", "DP-SYNC-09", "DP-DIAG-14");
  HandPlant bench(dp_line() + mc31_station());
  bench.start("F1", prm_data(kModes));
  const auto later = [&] {
    bench.run_on(2 * kSecond);
    return bench.speed();
  };
  bench.exchange(kSlow);
  EXPECT_EQ(later(), 300'000);
  EXPECT_EQ(bench.control(kSync), "-") << "nobody answers";
  EXPECT_TRUE(bench.meaning.ends_with("Sync, all")) << bench.meaning;
  EXPECT_EQ(bench.diag(), "00 24 00 01 31 00");
  bench.exchange(kFast);
  EXPECT_EQ(later(), 300'000) << "a new word waits";
  EXPECT_EQ(bench.outputs(), kSlow);
  bench.control(kSync);
  EXPECT_EQ(later(), 600'000) << "until the next Sync";
  bench.exchange(kSlow);
  EXPECT_EQ(later(), 600'000);
  bench.control(kUnsync);
  EXPECT_EQ(bench.diag(), "00 04 00 01 31 00");
  EXPECT_EQ(later(), 300'000) << "what waited acts with Unsync";
  bench.exchange(kFast);
  EXPECT_EQ(bench.outputs(), kFast) << "from now on in the next cycle";
  EXPECT_EQ(later(), 600'000);
  // Both at once end the mode.
  bench.control(kSync);
  bench.exchange(kSlow);
  EXPECT_EQ(bench.outputs(), kFast);
  bench.control(kSync | kUnsync);
  EXPECT_EQ(bench.diag(), "00 04 00 01 31 00");
  EXPECT_EQ(bench.outputs(), kSlow);
  // Sync and Freeze together, and each ends alone.
  for (const auto& [command, octet] : {std::pair(kSync | kFreeze, "34"), {kUnfreeze, "24"}, {kFreeze, "34"}, {kUnsync, "14"},
                                       {kFreeze | kUnfreeze, "04"}, {kFreeze, "14"}, {kUnfreeze, "04"}}) {
    bench.control(static_cast<uint8_t>(command));
    EXPECT_EQ(bench.diag(), std::string("00 ") + octet + " 00 01 31 00") << command;
  }
}

// 7500 digits in 10 s for 50 Hz: a run-up that lasts.
const std::string kRunUp = "00 06 1D 4C 27 10";

uint16_t speed_in(const std::string& inputs) {
  const Octets octets = hex(inputs);
  return static_cast<uint16_t>(octets[2] << 8 | octets[3]);
}

TEST(DpSync, FreezeHoldsTheActualValues) {
  PROVES("DP-SYNC-04", "DP-SYNC-06");
  HandPlant bench(dp_line() + mc31_station());
  bench.start("F2", prm_data(kModes));
  bench.exchange(kRunUp);
  bench.run_on(kSecond);
  for (int n = 0; n < 2; ++n) {
    const int32_t speed = bench.speed();
    bench.control(kFreeze);
    const std::string frozen = bench.inputs();
    EXPECT_NEAR(speed_in(frozen), speed / 200.0, 3) << "0.2 rpm a digit, at that instant";
    for (int reads = 0; reads < 20; ++reads) {
      bench.run_on(50 * kMillisecond);
      EXPECT_EQ(bench.exchange(kRunUp).substr(3), frozen);
      EXPECT_EQ(bench.inputs(), frozen);
    }
    EXPECT_GT(bench.speed(), speed + 100'000) << "the drive accelerates";
  }
  bench.control(kUnfreeze);
  for (int reads = 0; reads < 10; ++reads) {
    bench.run_on(100 * kMillisecond);
    EXPECT_NEAR(speed_in(bench.exchange(kRunUp).substr(3)), bench.speed() / 200.0, 3) << "current again";
  }
}

// Stations 8 and 9 of group 1, 10 of group 2.
struct ThreeSlaves : HandPlant {
  ThreeSlaves() : HandPlant(dp_line() + mc31_station("", "", "a", 8) + mc31_station("", "", "b", 9) + mc31_station("", "", "c", 10)) {
    for (to = 8; to <= 10; ++to) start("F2", prm_data(kModes, "31 00", to == 10 ? "02" : "01"));
  }
  // One after the other, with a while between them.
  void send_all(const std::string& words) {
    for (to = 8; to <= 10; ++to) {
      exchange(words);
      run_on(100 * kMillisecond);
    }
  }
  std::vector<int32_t> speeds() { return {speed(0), speed(1), speed(2)}; }
};

TEST(DpSync, SyncMovesAllAtOneTime) {
  PROVES("DP-SYNC-02");
  ThreeSlaves three;
  three.send_all(kSlow + " 00 00");
  three.run_on(2 * kSecond);
  three.control(kSync);
  three.send_all(kFast + " 00 00");
  EXPECT_EQ(three.speeds(), (std::vector<int32_t>{300'000, 300'000, 300'000}));
  three.control(kSync);
  std::set<int32_t> met;
  for (int n = 0; n < 2000; ++n) {
    three.run_on(kMillisecond);
    ASSERT_EQ(three.speed(0), three.speed(1)) << n;
    ASSERT_EQ(three.speed(0), three.speed(2)) << n;
    met.insert(three.speed());
  }
  EXPECT_GT(met.size(), 50U) << "a ramp that all three went through together";
  EXPECT_EQ(three.speed(), 600'000);
}

TEST(DpSync, FreezeTakesAllAtOneTime) {
  PROVES("DP-SYNC-05");
  ThreeSlaves three;
  three.send_all(kRunUp);  // 100 ms apart: each has its own speed
  three.run_on(kSecond);
  for (int n = 0; n < 2; ++n) {
    const std::vector<int32_t> at = three.speeds();
    ASSERT_GT(at[0], at[1] + 10'000);
    ASSERT_GT(at[1], at[2] + 10'000);
    three.control(kFreeze);
    for (three.to = 8; three.to <= 10; ++three.to) {
      three.run_on(200 * kMillisecond);
      EXPECT_NEAR(speed_in(three.inputs()), at[three.to - 8U] / 200.0, 3) << "of the instant of the command, whenever it is read";
    }
  }
}

TEST(DpSync, GroupsAndNoAnswer) {
  PROVES("DP-SYNC-07");
  ThreeSlaves three;
  three.send_all(kSlow + " 00 00");
  three.run_on(2 * kSecond);
  EXPECT_EQ(three.control(kSync, 0x01), "-");
  EXPECT_EQ(three.heard.size(), 1U) << "the command alone is on the line";
  EXPECT_TRUE(three.meaning.ends_with("Sync, groups 01h")) << three.meaning;
  three.send_all(kFast + " 00 00");
  three.run_on(2 * kSecond);
  EXPECT_EQ(three.speeds(), (std::vector<int32_t>{300'000, 300'000, 600'000}));
  three.control(kSync, 0x02);
  three.run_on(2 * kSecond);
  EXPECT_EQ(three.speeds(), (std::vector<int32_t>{300'000, 300'000, 600'000})) << "not for them";
  three.control(kUnsync);
  three.run_on(2 * kSecond);
  EXPECT_EQ(three.speeds(), (std::vector<int32_t>{600'000, 600'000, 600'000})) << "groups 0: all";
}

// The same by the keys of a plant file.
TEST(DpSync, CommandsOfThePlantFile) {
  std::string text = dp_line() + mc31_station("", "", "a", 8) + mc31_station("", "", "b", 9) + mc31_station("", "", "c", 10) +
                     "[[control]]\nname = \"plc\"\nprofibus = \"dp\"\n";
  for (const char* rest : {"8\ngroups = 1\n", "9\ngroups = 1\n", "10\ngroups = 2\n"})
    text += std::string("[[control.slave]]\naddress = ") + rest + "po = [6, 1500]\n[[control.slave.change]]\nat = \"3s\"\npo = [6, 3000]\n";
  for (const char* command : {"\"2s\"\ncommand = \"sync\"\ngroups = 1\n", "\"5s\"\ncommand = \"sync\"\n", "\"8s\"\ncommand = \"unsync\"\n"})
    text += std::string("[[control.command]]\nat = ") + command;
  DpPlant bench(text);
  const auto speeds = [&] { return std::vector<int32_t>{bench.speed(0), bench.speed(1), bench.speed(2)}; };
  bench.run(4900 * kMillisecond);
  EXPECT_EQ(speeds(), (std::vector<int32_t>{300'000, 300'000, 600'000}));
  for (int n = 0; n < 500; ++n) {
    bench.run_on(kMillisecond);
    ASSERT_EQ(bench.speed(0), bench.speed(1)) << n;
  }
  bench.run(7 * kSecond);
  EXPECT_EQ(speeds(), (std::vector<int32_t>{600'000, 600'000, 600'000}));
}

}  // namespace
}  // namespace ipos::tests
