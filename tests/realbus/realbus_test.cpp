// Real SocketCAN: a Linux guest (user-mode-linux) with vcan and slcan interfaces, in which ipos, can-utils
// and python3-can talk to each other (guest.sh). Here its findings are looked at; where the guest does not
// boot, all tests are skipped with the reason.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
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
                        ipos_program(), project("").string(), IPOS_WIDE_REGISTERS});
  }
  static void TearDownTestSuite() { folder_.reset(); }

  void SetUp() override {
    constexpr int kSkip = 77;
    if (boot_.exit_code == kSkip) GTEST_SKIP() << boot_.output;
    ASSERT_EQ(boot_.exit_code, 0) << boot_.output;
    EXPECT_EQ(text("waits.txt"), "") << "the guest went on without it";
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
  // Of the run of the SCOM example, from its own words.
  static double worst_tick_ms() {
    std::smatch found;
    const std::string told = text("scom.err");
    return std::regex_search(told, found, std::regex("the worst ([0-9.]+) ms")) ? std::stod(found[1]) : 1e9;
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
    // By the clock only where the host was in time; the times of the line are always right.
    if (worst_tick_ms() < row.period / 100) {
      EXPECT_NEAR(period_ms(mine), row.period, row.period / 100) << row.id;
    }
    EXPECT_NEAR(period_ms(with_id(log("scom.log"), row.id)), row.period, row.period / 1000) << row.id;
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

// The master of python_peers_test.cpp, here at an interface of the kernel.
TEST_F(RealBus, PythonCanIsACanopenMaster) {
  EXPECT_EQ(text("canopen.code"), "0\n") << text("canopen.txt");
  expect_all_ok(text("canopen.txt"), 19);
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

// The same comparison with the verb, on the log that candump recorded.
TEST_F(RealBus, CanbusloadAgreesWithBusLoad) {
  // Frames behind the last probe, which canbusload may not have seen.
  const std::string all = text("all.log");
  const size_t probe = all.rfind("7FF#");
  ASSERT_NE(probe, std::string::npos);
  const TemporaryFolder folder;
  folder.write("seen.log", all.substr(all.find('\n', probe) + 1));
  const CommandResult result =
      run_ipos({"bus", "load", "seen.log", "--baud", "500000", "--format", "json"}, folder.path());
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto ours = nlohmann::json::parse(result.out);
  const std::string load = text("load.txt");
  const std::regex row(R"(vcan0@500000\s+(\d+)\s+(\d+)\s+(\d+)\s+(\d+)%)");
  uint64_t frames = 0, bits = 0, data_bits = 0;
  for (std::sregex_iterator it(load.begin(), load.end(), row), end; it != end; ++it) {
    frames += std::stoull((*it)[1]);
    bits += std::stoull((*it)[2]);
    data_bits += std::stoull((*it)[3]);
  }
  const auto exact_bits = ours["all"]["exact_bits"].get<double>();
  EXPECT_EQ(ours["all"]["frames"].get<uint64_t>(), frames);
  EXPECT_EQ(ours["all"]["data_bits"].get<uint64_t>(), data_bits);
  EXPECT_NEAR(exact_bits, static_cast<double>(bits), static_cast<double>(bits) / 100);
  // Both see the same share of the bus over the whole time, and windows are seconds with all frames in one.
  uint64_t in_windows = 0;
  for (const auto& window : ours["windows"]) in_windows += window["exact_bits"].get<uint64_t>();
  EXPECT_EQ(in_windows, ours["all"]["exact_bits"].get<uint64_t>());
}

// What the monitor shows of the SCOM example are the frames that candump logs, in words.
TEST_F(RealBus, TheMonitorShowsTheScomExampleInWords) {
  EXPECT_EQ(text("monitor.code"), "130\n") << text("monitor.err");
  const TemporaryFolder folder;
  std::string frames;
  for (const LogEntry& entry : part(1))
    frames += runtime::candump_line(entry.time, entry.bus, entry.frame) + "\n";
  folder.write("part.log", frames);
  const CommandResult decoded = run_ipos(
      {"bus", "decode", "part.log", "--names", project("examples/scom/scom.toml").string()}, folder.path());
  ASSERT_EQ(decoded.exit_code, 0) << decoded.err;
  // The mark of the part stands before.
  std::istringstream theirs(decoded.out), ours(text("monitor.txt"));
  const auto words = [](const std::string& line) { return line.substr(line.find(' ') + 1); };
  const auto stamp = [](const std::string& line) { return std::stod(line.substr(1)); };
  std::string expected, shown;
  ASSERT_TRUE(std::getline(ours, shown));
  EXPECT_EQ(words(shown), "vcan0 7FE 01");
  size_t rows = 0;
  while (std::getline(theirs, expected)) {
    ASSERT_TRUE(std::getline(ours, shown)) << "missing: " << expected;
    EXPECT_EQ(words(shown), words(expected));
    EXPECT_NEAR(stamp(shown), stamp(expected), 0.005) << "both have the kernel's stamps";
    ++rows;
  }
  EXPECT_FALSE(std::getline(ours, shown)) << shown;
  EXPECT_GE(rows, 55U);
  EXPECT_NE(text("monitor.txt").find(" 20C read 8470 Ramp t11 UP CW = 2.000 s <- unit2\n"),
            std::string::npos);
  EXPECT_NE(text("monitor.err").find(fmt::format("ipos: {} telegrams, {} shown\n", rows + 1, rows + 1)),
            std::string::npos)
      << text("monitor.err");
  // With a station and a count it ends by itself.
  const std::string one = text("monitor1.txt");
  EXPECT_EQ(std::count(one.begin(), one.end(), '\n'), 10);
  EXPECT_EQ(one.find("unit2 "), std::string::npos);
}

// Stopped while 12000 frames come, the monitor tells how many the kernel had no room for; with those it shows
// they are all.
TEST_F(RealBus, TheMonitorTellsLostFramesAndBusErrors) {
  const std::string shown = text("lost.txt");
  EXPECT_EQ(text("lost.code"), "130\n") << text("lost.err");
  size_t read = 0;
  uint64_t lost = 0;
  std::istringstream lines(shown);
  std::vector<std::string> rest;
  for (std::string line; std::getline(lines, line);) {
    const std::string what =
        line.substr(line.find("vcan3 ") == std::string::npos ? 0 : line.find("vcan3 ") + 6);
    std::smatch found;
    if (what == "20B read 8318 Speed -> address 1")
      ++read;
    else if (std::regex_match(what, found, std::regex("--- (\\d+) frames lost")))
      lost += std::stoull(found[1]);
    else
      rest.push_back(what);
  }
  EXPECT_EQ(read + lost, 12000U);
  EXPECT_GT(lost, 0U) << "the kernel had room for all of them";
  EXPECT_GT(read, 0U);
  ASSERT_EQ(rest.size(), 4U) << shown.substr(shown.size() > 2000 ? shown.size() - 2000 : 0);
  EXPECT_EQ(rest[0], "20C read 8318 Speed = 1000.000 rpm <- address 1");
  EXPECT_EQ(rest[1].substr(0, 29), "--- bus error: no acknowledge");
  EXPECT_EQ(rest[2], "--- the same error 2 more times");
  EXPECT_EQ(rest[3], "20C read 8470 Ramp t11 UP CW = 2.000 s <- address 1");
  const std::string told = text("lost.err");
  EXPECT_NE(told.find(fmt::format("{} lost, 3 bus errors", lost)), std::string::npos) << told;
  EXPECT_NE(told.find("frames from it are lost: they came faster than they were read"), std::string::npos)
      << told;
  EXPECT_NE(told.find("the interface has been set down"), std::string::npos) << told;
}

// The example's identifier 1024, each time three frames; each change of the port is told once.
TEST_F(RealBus, AServedPlantGoesOnWithoutItsInterfaceAndTakesItAgain) {
  EXPECT_EQ(text("served.code"), "0\n");
  EXPECT_EQ(with_id(log("up.log"), 1024).size(), 3U);
  EXPECT_EQ(with_id(log("anew.log"), 1024).size(), 3U);
  std::vector<std::string> told;
  std::istringstream lines(text("served.err"));
  for (std::string line; std::getline(lines, line);)
    if (line.find("sbus: port") != std::string::npos) told.push_back(line);
  const std::vector<std::string> wanted{"ipos: warning: sbus: port vcan5 is away: the interface is down",
                                        "ipos: sbus: port vcan5 is there again",
                                        "ipos: warning: sbus: port vcan5 is away: the device has gone",
                                        "ipos: sbus: port vcan5 is there again"};
  // The kernel sets an interface down before it removes it: who looks in between sees both.
  if (told.size() == 5 && told[2] == wanted[0]) told.erase(told.begin() + 2);
  ASSERT_EQ(told.size(), wanted.size()) << text("served.err");
  for (size_t n = 0; n < wanted.size(); ++n) EXPECT_EQ(told[n].substr(0, wanted[n].size()), wanted[n]);
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
