// Real SocketCAN: a Linux guest (user-mode-linux) with vcan and slcan interfaces, in which ipos, can-utils
// and python3-can talk to each other (guest.sh). Here its findings are looked at; where the guest does not
// boot, all tests are skipped with the reason.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <regex>
#include <sstream>

#include "runtime/bus/can/frame_bits.hpp"
#include "runtime/bus/log/candump.hpp"
#include "tests/realbus/script.hpp"
#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

using runtime::Frame;
using runtime::LogEntry;

constexpr uint32_t kProbe = 0x7FF;
constexpr uint32_t kMark = 0x7FE;

class RealBus : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TemporaryFolder>();
    boot_ = run_script({"/bin/sh", project("tests/realbus/boot.sh").string(), folder_->path().string(),
                        IPOS_PROGRAM, project("").string()});
  }
  static void TearDownTestSuite() { folder_.reset(); }

  void SetUp() override {
    constexpr int kSkip = 77;
    if (boot_.exit_code == kSkip) GTEST_SKIP() << boot_.output;
    ASSERT_EQ(boot_.exit_code, 0) << boot_.output;
  }

  static std::string text(const std::string& name) { return read_text(folder_->path() / name); }
  static std::vector<LogEntry> log(const std::string& name) {
    auto entries = runtime::parse_candump(text(name));
    if (!entries) {
      ADD_FAILURE() << name << ":" << entries.error().line << ": " << entries.error().message;
      return {};
    }
    return *entries;
  }
  // The frames on vcan0 between mark `part` and the next one.
  static std::vector<LogEntry> part(uint8_t number) {
    std::vector<LogEntry> found;
    uint8_t current = 0;
    for (const LogEntry& entry : log("all.log")) {
      if (entry.frame.id == kMark)
        current = entry.frame.data[0];
      else if (current == number)
        found.push_back(entry);
    }
    return found;
  }

 private:
  static inline std::unique_ptr<TemporaryFolder> folder_;
  static inline ScriptResult boot_;
};

std::string data_of(const Frame& frame) {
  const std::string line = runtime::candump_line(0, "x", frame);
  return line.substr(line.find('#') + 1);
}

std::vector<LogEntry> with_id(const std::vector<LogEntry>& log, uint32_t id) {
  std::vector<LogEntry> found;
  for (const LogEntry& entry : log)
    if (entry.frame.id == id) found.push_back(entry);
  return found;
}

// Mean distance in milliseconds (least squares, so that one late frame does not decide).
double period_ms(const std::vector<LogEntry>& frames) {
  const double n = static_cast<double>(frames.size());
  double sum_t = 0, sum_kt = 0;
  for (size_t k = 0; k < frames.size(); ++k) {
    const double t = static_cast<double>(frames[k].time - frames[0].time) / 1e6;
    sum_t += t;
    sum_kt += static_cast<double>(k) * t;
  }
  return (sum_kt - (n - 1) / 2 * sum_t) * 12 / (n * (n * n - 1));
}

// 1053 1610 p. 57 to 59: unit 1 sends 1024 every 100 ms, unit 2 1025 every 120 ms, 8 bytes in MOTOROLA
// format: second variable first, each with its high byte first.
TEST_F(RealBus, CandumpSeesTheFramesOfTheScomExample) {
  const struct {
    uint32_t id;
    const char* data;
    double period;
    size_t frames;  // in 3 s
  } rows[] = {{1024, "5566778811223344", 100.0, 30}, {1025, "8877665544332211", 120.0, 25}};
  const std::vector<LogEntry> frames = part(1);
  for (const auto& row : rows) {
    const std::vector<LogEntry> mine = with_id(frames, row.id);
    EXPECT_NEAR(static_cast<double>(mine.size()), static_cast<double>(row.frames), 1.0) << row.id;
    for (const LogEntry& entry : mine) EXPECT_EQ(data_of(entry.frame), row.data) << row.id;
    ASSERT_GE(mine.size(), 2U);
    EXPECT_NEAR(period_ms(mine), row.period, row.period / 100) << row.id;
  }
  EXPECT_EQ(text("scom.code"), "0\n") << text("scom.err");
  EXPECT_NE(text("scom.err").find("26 of 26 expectations met"), std::string::npos) << text("scom.err");
}

// What ipos logs of its line in virtual time is what candump saw on the interface, frame by frame.
TEST_F(RealBus, TheLineAndTheInterfaceCarryTheSameFrames) {
  std::vector<std::string> line, interface;
  for (const LogEntry& entry : log("scom.log")) line.push_back(runtime::candump_line(0, "x", entry.frame));
  for (const LogEntry& entry : part(1)) interface.push_back(runtime::candump_line(0, "x", entry.frame));
  // A request crosses the frames that are under way on the other side.
  std::sort(line.begin(), line.end());
  std::sort(interface.begin(), interface.end());
  EXPECT_EQ(line, interface);
  EXPECT_GE(line.size(), 55U);
}

// Request 8a + 515, answer 8a + 516 (1053 1610 p. 38). P130, index 8470 = 2116h, is 2000 by factory setting
// (p. 72); P000, index 8318 = 207Eh, is read-only: class 8, additional code 12h (p. 46).
TEST_F(RealBus, CansendOfAParameterRequestIsAnswered) {
  const std::vector<LogEntry> frames = part(1);
  const std::vector<LogEntry> requests = with_id(frames, 523);
  const std::vector<LogEntry> answers = with_id(frames, 524);
  ASSERT_EQ(requests.size(), 2U);
  ASSERT_EQ(answers.size(), 2U);
  EXPECT_EQ(data_of(answers[0].frame), "31002116000007D0");
  EXPECT_EQ(data_of(answers[1].frame), "B200207E08000012");
}

TEST_F(RealBus, PythonCanDrivesAStationThroughItsProfile) {
  expect_all_ok(text("profile.txt"), 28);
  EXPECT_EQ(text("profile.code"), "130\n") << text("profile.err");  // ended by a signal, in good order
}

// canbusload prints frames, bits, data bits and percent of each second. The traffic begins and ends within
// its seconds, so their sum is the traffic.
TEST_F(RealBus, CanbusloadAgreesWithOurLengths) {
  uint64_t bits = 0, frames = 0;
  size_t probes_end = 0;
  const std::vector<LogEntry> all = log("all.log");
  for (size_t n = 0; n < all.size(); ++n)
    if (all[n].frame.id == kProbe) probes_end = n + 1;
  for (size_t n = probes_end; n < all.size(); ++n) {
    ++frames;
    bits += runtime::frame_bits(all[n].frame);
  }
  uint64_t their_bits = 0, their_frames = 0;
  const std::string load = text("load.txt");
  const std::regex row(R"(vcan0@500000\s+(\d+)\s+(\d+)\s+(\d+)\s+(\d+)%)");
  for (std::sregex_iterator it(load.begin(), load.end(), row), end; it != end; ++it) {
    their_frames += std::stoull((*it)[1]);
    their_bits += std::stoull((*it)[2]);
    // The percentage is that of the bits, rounded down.
    EXPECT_EQ(std::stoull((*it)[4]), std::stoull((*it)[2]) * 100 / 500'000);
  }
  EXPECT_EQ(their_frames, frames);
  EXPECT_GE(frames, 100U);
  EXPECT_NEAR(static_cast<double>(their_bits), static_cast<double>(bits), static_cast<double>(bits) / 100);
}

TEST_F(RealBus, InterfacesThatCannotBeUsedSayWhy) {
  const std::string refused = text("refused.txt");
  for (const char* wanted : {"refused.toml:8:8: error: vcan1: the interface is down: ip link set vcan1 up",
                             "error: lo: is a network interface, but not for CAN",
                             "error: can7: there is no such network interface"})
    EXPECT_NE(refused.find(wanted), std::string::npos) << refused;
  EXPECT_NE(text("rate.txt")
                .find("error: slcan0: the interface has another bit rate than the bus: 250000 instead of "
                      "500000 bit/s"),
            std::string::npos)
      << text("rate.txt");
  EXPECT_NE(text("rate.txt").find("exit code 74"), std::string::npos);
}

// slcand and the kernel's driver attach to slcan:pty:PATH as to an adapter.
TEST_F(RealBus, TheKernelsSlcanAttachesToThePseudoTerminal) {
  const std::vector<LogEntry> frames = log("slcan.log");
  const std::vector<LogEntry> cyclic = with_id(frames, 1024);
  ASSERT_GE(cyclic.size(), 5U);
  for (const LogEntry& entry : cyclic) EXPECT_EQ(data_of(entry.frame), "5566778811223344");
  const std::vector<LogEntry> answers = with_id(frames, 524);
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_EQ(data_of(answers[0].frame), "31002116000007D0");
  EXPECT_NE(text("slcan.err").find("refused to open: the program asks for 250000 bit/s, the bus has 500000"),
            std::string::npos)
      << text("slcan.err");
}

// The interface takes next to no frames for 0.6 s (ENOBUFS): they wait and go out in order, none is lost.
TEST_F(RealBus, FramesWaitInOrderWhileTheInterfaceIsFull) {
  std::vector<std::string> line, interface;
  for (const LogEntry& entry : log("load.log")) line.push_back(runtime::candump_line(0, "x", entry.frame));
  for (const LogEntry& entry : log("full.log"))
    interface.push_back(runtime::candump_line(0, "x", entry.frame));
  EXPECT_NEAR(static_cast<double>(line.size()), 300.0, 5.0);  // one every 5 ms for 1.5 s
  EXPECT_EQ(line, interface);
  const std::string told = text("load.err");
  EXPECT_TRUE(std::regex_search(told, std::regex("vcan2: \\d+ frames sent, 0 received, \\d+ times no room")))
      << told;
  EXPECT_EQ(told.find("lost"), std::string::npos) << told;
  EXPECT_EQ(told.find("not sent"), std::string::npos) << told;
}

}  // namespace
}  // namespace ipos::tests
