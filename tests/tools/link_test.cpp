// ipos param, watch and scan at units that answer over real ports: a plant that runs in real time, on RS-485
// over a pseudo-terminal and on SBus over an slcan adapter on one.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <nlohmann/json.hpp>
#include <regex>

#include "tests/harness/contains.hpp"
#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

// `ipos run plant.toml --realtime` in a folder, until the end of its life.
class RunningPlant {
 public:
  explicit RunningPlant(const std::filesystem::path& folder) : err_((folder / "run.err").string()) {
    child_ = fork();
    if (child_ == 0) {
      const int null_file = open("/dev/null", O_RDWR);
      const int err = open(err_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
      if (chdir(folder.c_str()) != 0) _exit(126);
      dup2(null_file, 0);
      dup2(null_file, 1);
      dup2(err, 2);
      execl(ipos_program(), "ipos", "run", "plant.toml", "--realtime", "--for", "1000s", nullptr);
      _exit(127);
    }
    constexpr int kBuses = 3;
    for (int n = 0; n < 3000; ++n) {
      const std::string text = read_text(err_);
      const std::regex joined("is joined to");
      if (std::distance(std::sregex_iterator(text.begin(), text.end(), joined), {}) == kBuses) return;
      usleep(20'000);
    }
    ADD_FAILURE() << "three buses were not joined within a minute: " << read_text(err_);
  }
  ~RunningPlant() {
    kill(child_, SIGTERM);
    int status = 0;
    waitpid(child_, &status, 0);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 130) << read_text(err_);
  }
  RunningPlant(const RunningPlant&) = delete;
  RunningPlant& operator=(const RunningPlant&) = delete;

 private:
  std::string err_;
  pid_t child_ = -1;
};

class Link : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_pty()) GTEST_SKIP() << kNoPty;
    folder_.write("SCOM1.IPC", read_text(project("examples/scom/SCOM1.IPC")));
    folder_.write("plant.toml",
                  "[[bus]]\nname = \"line1\"\nkind = \"rs485\"\nbaud = 57600\nport = \"pty:" + at("line1") +
                      "\"\n[[bus]]\nname = \"sbus\"\nkind = \"can\"\nport = \"slcan:pty:" + at("can1") +
                      "\"\n[[station]]\nname = \"unit1\"\nunit = \"mdxb\"\nfirmware = 12\n"
                      "program = \"SCOM1.IPC\"\nsbus = \"sbus\"\nrs485_xt = \"line1\"\n"
                      "[station.parameters]\nP810 = 3\nP881 = 5\nP130 = \"2.5 s\"\nP131 = \"750 ms\"\n"
                      "[[bus]]\nname = \"can\"\nkind = \"can\"\nport = \"slcan:pty:" +
                      at("can2") +
                      "\"\n[[station]]\nname = \"node\"\nunit = \"mdxb\"\nfirmware = 12\nsbus = \"can\"\n"
                      "[station.parameters]\nP880 = 1\nP886 = 100\nP130 = \"2.5 s\"\n");
    plant_.emplace(folder_.path());
  }
  std::string at(const std::string& name) const { return (folder_.path() / name).string(); }
  std::string file(const std::string& name) const { return read_text(at(name)); }
  CommandResult ipos(std::vector<std::string> arguments) { return run_ipos(arguments, folder_.path()); }
  // Options of a verb with --port, for both ways. On a loaded machine the plant's process answers late, and a write is never
  // asked twice.
  std::vector<std::string> serial() const {
    return {"--port", at("line1"), "--baud", "57600", "--address", "3", "--patience", "20s"};
  }
  std::vector<std::string> sbus() const { return {"--port", "slcan:" + at("can1"), "--address", "5", "--patience", "20s"}; }
  CommandResult param(const std::string& action, const std::vector<std::string>& link,
                      const std::vector<std::string>& words) {
    std::vector<std::string> all{"param", action};
    all.insert(all.end(), link.begin(), link.end());
    all.insert(all.end(), words.begin(), words.end());
    return ipos(all);
  }

  TemporaryFolder folder_;
  std::optional<RunningPlant> plant_;
};

TEST_F(Link, ParametersAreTheSameOverEveryWay) {
  for (const auto& way : {serial(), sbus()}) {
    const CommandResult got = param("get", way, {"P130", "8471", "P881", "H420", "P076"});
    EXPECT_EQ(got.exit_code, 0) << got.err;
    EXPECT_EQ(got.out,
              "P130 Ramp t11 UP CW = 2.500 s\nP131 Ramp t11 DOWN CW = 0.750 s\nP881 Address SBus 1 = 5\n"
              "H420 = 1024\nP076 Firmware basic unit = 822 609 7.12\n");
  }
  const CommandResult refused = param("set", sbus(), {"P130=3s"});
  EXPECT_EQ(refused.exit_code, 64);
  EXPECT_TRUE(contains(refused.err, "--yes")) << refused.err;
  EXPECT_EQ(param("set", sbus(), {"P130=3s", "--yes"}).out, "P130 Ramp t11 UP CW = 3.000 s (was 2.500 s)\n");
  const CommandResult only_read = param("set", serial(), {"P000=1", "P131=1s", "--volatile"});
  EXPECT_EQ(only_read.exit_code, 1);
  EXPECT_EQ(only_read.out, "P131 Ramp t11 DOWN CW = 1.000 s (was 0.750 s)\n");
  EXPECT_TRUE(contains(only_read.err, "refused: P000 Speed := 1.000 rpm: read access only")) << only_read.err;
  EXPECT_EQ(param("get", serial(), {"P130"}).out, "P130 Ramp t11 UP CW = 3.000 s\n");
}

// The same parameters by SDO, at an address that only CANopen has.
TEST_F(Link, ANodeOfCanopen) {
  const std::vector<std::string> node{"--port", "slcan:" + at("can2"), "--canopen", "--address", "100", "--patience", "20s"};
  EXPECT_EQ(
      param("get", node, {"P130", "P886", "P076"}).out,
      "P130 Ramp t11 UP CW = 2.500 s\nP886 CANopen address SBus 1 = 100\nP076 Firmware basic unit = 822 609 "
      "7.12\n");
  EXPECT_EQ(param("set", node, {"P130=3s", "--yes"}).out, "P130 Ramp t11 UP CW = 3.000 s (was 2.500 s)\n");
  const CommandResult refused = param("set", node, {"P000=1", "--yes"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_TRUE(contains(refused.err, "refused: P000 Speed := 1.000 rpm: read access only")) << refused.err;
  const CommandResult lost = param("set", node, {"P130=3s", "--volatile"});
  EXPECT_EQ(lost.exit_code, 64);
  EXPECT_TRUE(contains(lost.err, "a write over SDO is always stored")) << lost.err;
  const CommandResult scan =
      ipos({"scan", "slcan:" + at("can2"), "--canopen", "--from", "98", "--to", "101", "--quiet", "--patience", "1s"});
  EXPECT_EQ(scan.exit_code, 0) << scan.err;
  EXPECT_EQ(scan.out.substr(scan.out.find('\n') + 1),
            "100      MOVIDRIVE MDX60B/61B  822 609 7.12  no fault\n");
  const CommandResult nobody = ipos({"scan", "slcan:" + at("can2"), "--canopen", "--to", "2", "--quiet"});
  EXPECT_EQ(nobody.exit_code, 1);
  EXPECT_TRUE(contains(nobody.err, "nobody answers at 1..2")) << nobody.err;
  EXPECT_EQ(ipos({"scan", at("line1"), "--canopen"}).exit_code, 64);
}

TEST_F(Link, SavedFilesAreIdentical) {
  ASSERT_EQ(param("save", sbus(), {"sbus.settings"}).exit_code, 0);
  ASSERT_EQ(param("save", serial(), {"serial.settings"}).exit_code, 0);
  ASSERT_EQ(ipos({"param", "save", "plant.toml", "simulation.settings", "--station", "unit1"}).exit_code, 0);
  const std::string simulation = file("simulation.settings");
  EXPECT_GT(simulation.size(), 10'000U);
  EXPECT_TRUE(file("sbus.settings") == simulation);
  EXPECT_TRUE(file("serial.settings") == simulation);
  EXPECT_EQ(param("diff", sbus(), {"serial.settings"}).exit_code, 0);
  param("set", sbus(), {"P130=3s", "--volatile"});
  const CommandResult differs = param("diff", sbus(), {"serial.settings"});
  EXPECT_EQ(differs.exit_code, 1);
  EXPECT_TRUE(contains(differs.out, "P130    8470   Ramp t11 UP CW")) << differs.out;
  const CommandResult loaded = param("load", sbus(), {"serial.settings", "--volatile"});
  EXPECT_TRUE(contains(loaded.out, ": 1 written, ")) << loaded.out << loaded.err;
  EXPECT_EQ(param("diff", sbus(), {"serial.settings"}).exit_code, 0);
}

TEST_F(Link, WatchReadsVariablesByIndex) {
  const std::vector<std::string> names{"P130", "H420", "lTrDataLow@SCOM1.IPC:hex", "8471"};
  const std::string expected =
      "P130 Ramp t11 UP CW    2.500 s\nH420                   1024\nH426 lTrDataLow        11223344 h\n"
      "P131 Ramp t11 DOWN CW  0.750 s\n";
  for (const auto& way : {std::vector<std::string>{at("line1"), "3", "--baud", "57600", "--patience", "20s"},
                          std::vector<std::string>{"slcan:" + at("can1"), "5", "--patience", "20s"}}) {
    std::vector<std::string> arguments{"watch"};
    arguments.insert(arguments.end(), way.begin(), way.end());
    arguments.insert(arguments.end(), names.begin(), names.end());
    arguments.push_back("--once");
    const CommandResult once = ipos(arguments);
    EXPECT_EQ(once.exit_code, 0) << once.err;
    EXPECT_EQ(once.out, expected);
  }
  const CommandResult rows =
      ipos({"watch", "slcan:" + at("can1"), "5", "TrCycl@SCOM1.IPC", "--count", "3", "--every", "100ms", "--patience", "20s"});
  EXPECT_EQ(std::count(rows.out.begin(), rows.out.end(), '\n'), 4) << rows.out;
  EXPECT_TRUE(contains(rows.out, "TrCycl.ObjectNo")) << rows.out;
  const CommandResult json =
      ipos({"watch", "slcan:" + at("can1"), "5", "H420", "9999", "--count", "2", "--format", "json", "--patience", "20s"});
  EXPECT_EQ(json.exit_code, 1) << "9999 is refused";
  EXPECT_TRUE(contains(json.err, "index 9999: invalid parameter index")) << json.err;
  const auto row = nlohmann::json::parse(json.out.substr(0, json.out.find('\n')));
  EXPECT_EQ(row["values"][0]["value"], 1024);
  EXPECT_TRUE(row["values"][1]["value"].is_null());
}

TEST_F(Link, ScanShowsWhoAnswers) {
  const CommandResult serial_scan = ipos({"scan", at("line1"), "--baud", "57600", "--to", "4", "--patience", "1s"});
  const CommandResult can_scan = ipos({"scan", "slcan:" + at("can1"), "--from", "4", "--to", "6", "--patience", "1s"});
  const std::string head = "address  unit                  firmware      fault\n";
  EXPECT_EQ(serial_scan.out, head + "3        MOVIDRIVE MDX60B/61B  822 609 7.12  no fault\n")
      << serial_scan.err;
  EXPECT_EQ(can_scan.out, head + "5        MOVIDRIVE MDX60B/61B  822 609 7.12  no fault\n") << can_scan.err;
  const CommandResult nobody = ipos({"scan", "slcan:" + at("can1"), "--from", "6", "--to", "7"});
  EXPECT_EQ(nobody.exit_code, 1);
  EXPECT_TRUE(contains(nobody.err, "nobody answers at 6..7")) << nobody.err;
}

TEST_F(Link, NobodyAtTheAddress) {
  const CommandResult serial_get =
      ipos({"param", "get", "--port", at("line1"), "--baud", "57600", "--address", "9", "P130"});
  EXPECT_EQ(serial_get.exit_code, 74);
  EXPECT_TRUE(contains(serial_get.err, "response delay time elapsed; nothing came back")) << serial_get.err;
  // The plant sends every 100 ms. On a loaded machine it may not get to that while the tool listens, which
  // then rightly says that it hears nothing.
  bool heard = false;
  for (int n = 0; n < 20 && !heard; ++n) {
    const CommandResult can_get =
        ipos({"param", "get", "--port", "slcan:" + at("can1"), "--address", "9", "P130"});
    EXPECT_EQ(can_get.exit_code, 74);
    heard = contains(can_get.err, "is P813 (P881) = 9 anywhere?");
    EXPECT_TRUE(heard || contains(can_get.err, "nothing is heard at all")) << can_get.err;
  }
  EXPECT_TRUE(heard);
}

TEST(Watch, StationOfAPlant) {
  const CommandResult result = run_ipos({"watch", "examples/scom/scom.toml", "unit1", "lReDataLow:hex",
                                         "H420", "P130", "--count", "2", "--every", "150ms"},
                                        project(""));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out,
            "        s    lReDataLow          H420  P130 Ramp t11 UP CW\n"
            "    0.150    44332211 h          1024              2.000 s\n"
            "    0.300    44332211 h          1024              2.000 s\n");
}

TEST(Watch, MistakesAreTold) {
  const auto error = [](const std::vector<std::string>& words) {
    std::vector<std::string> all{"watch"};
    all.insert(all.end(), words.begin(), words.end());
    const CommandResult result = run_ipos(all, project(""));
    EXPECT_NE(result.exit_code, 0);
    return result.err;
  };
  EXPECT_TRUE(
      contains(error({"examples/scom/scom.toml", "unit7", "H1"}), "has no station 'unit7', only unit1"));
  EXPECT_TRUE(contains(error({"examples/scom/scom.toml", "unit1", "H1x"}), "has no parameter 'H1x'"));
  EXPECT_TRUE(contains(error({"/no/such/port", "1", "P000"}), "there is no such device"));
  EXPECT_TRUE(contains(error({"/no/such/port", "unit1", "P000"}), "is no address of a unit"));
  EXPECT_TRUE(contains(error({"/dev/null@3kg", "1", "P000"}), "is no name of a port"));
  EXPECT_TRUE(contains(error({"vcan0", "1", "P000", "--every", "0"}), "is no time of 1 ms or more"));
}

TEST(ParamPort, NeedsAnAddress) {
  const CommandResult result = run_ipos({"param", "get", "--port", "/dev/ttyUSB0", "P130"});
  EXPECT_EQ(result.exit_code, 64);
  EXPECT_TRUE(contains(result.err, "needs --address")) << result.err;
}

}  // namespace
}  // namespace ipos::tests
