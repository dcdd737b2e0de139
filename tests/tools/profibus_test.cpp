// ipos scan, param, bus monitor and bus load at a PROFIBUS line: a plant that runs in real time behind a pseudo-terminal, and
// logs. What stands in the frames is that of docs/reference/protocols/profibus.md.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <regex>

#include "tests/harness/contains.hpp"
#include "tests/harness/proves.hpp"
#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

constexpr const char* kLine = R"(
[[bus]]
name = "dp"
kind = "profibus"
baud = 500000
)";
constexpr const char* kStations = R"(
[[station]]
name = "belt"
unit = "mc31"
option = "ffp31"
profibus = "dp"
profibus_address = 8
[station.parameters]
P120 = "1.25 s"
[[station]]
name = "pump"
unit = "mc31"
option = "size0"
profibus = "dp"
profibus_address = 9
)";
// A controller that goes away without a watchdog: the slave stays locked, and nobody speaks.
constexpr const char* kController = R"(
[[control]]
name = "plc"
profibus = "dp"
address = 1
[[control.slave]]
address = 8
cfg = "F2"
po = [6, 1500, 0]
[[control.command]]
at = "600ms"
command = "stop"
)";

// `ipos run plant.toml --realtime` in a folder, until the end of its life.
class RunningLine {
 public:
  RunningLine(const TemporaryFolder& folder, const std::string& more = "") {
    const std::string port = "port = \"pty:" + (folder.path() / "dp").string() + "\"\n";
    folder.write("plant.toml", kLine + port + kStations + more);
    child_ = fork();
    if (child_ == 0) {
      const int null_file = open("/dev/null", O_RDWR);
      if (chdir(folder.path().c_str()) != 0) _exit(126);
      for (const int n : {0, 1, 2}) dup2(null_file, n);
      execl(ipos_program(), "ipos", "run", "plant.toml", "--realtime", "--for", "1000s", nullptr);
      _exit(127);
    }
    for (int n = 0; n < 3000 && !std::filesystem::exists(folder.path() / "dp"); ++n) usleep(20'000);
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "dp")) << "no pseudo-terminal dp within a minute";
  }
  ~RunningLine() {
    kill(child_, SIGTERM);
    int status = 0;
    waitpid(child_, &status, 0);
  }
  RunningLine(const RunningLine&) = delete;
  RunningLine& operator=(const RunningLine&) = delete;

 private:
  pid_t child_ = -1;
};

class ProfibusTools : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_pty()) GTEST_SKIP() << kNoPty;
  }
  std::string port() const { return (folder_.path() / "dp").string(); }
  CommandResult ipos(const std::vector<std::string>& arguments) {
    return run_ipos(arguments, folder_.path());
  }
  CommandResult scan() {
    return ipos({"scan", port(), "--profibus", "--from", "7", "--to", "10", "--quiet"});
  }
  CommandResult param(const std::string& action, int address, std::vector<std::string> words) {
    std::vector<std::string> all{
        "param", action, "--port", port(), "--profibus", "--address", std::to_string(address), "--quiet"};
    all.insert(all.end(), words.begin(), words.end());
    return ipos(all);
  }

  TemporaryFolder folder_;
};

TEST_F(ProfibusTools, ScanAndParametersOfFreeSlaves) {
  const RunningLine line(folder_);
  const CommandResult found = scan();
  EXPECT_EQ(found.exit_code, 0) << found.err;
  EXPECT_TRUE(std::regex_search(
      found.out, std::regex("(^|\n)8 +MOVITRAC 31 FFP 31 +3100h +F0 \\(1 PD\\) +waits for Set_Prm +-")))
      << found.out;
  EXPECT_TRUE(std::regex_search(found.out, std::regex("\n9 +MOVITRAC 31 size 0/DP +3111h"))) << found.out;
  EXPECT_EQ(std::count(found.out.begin(), found.out.end(), '\n'), 3);

  const CommandResult got = param("get", 8, {"P120", "P073"});
  EXPECT_EQ(got.exit_code, 0) << got.err;
  EXPECT_TRUE(contains(got.out, "= 1.25 s\n")) << got.out;
  EXPECT_TRUE(contains(got.out, "P073")) << got.out;
  EXPECT_TRUE(contains(got.out, "= 8\n")) << got.out;
  const CommandResult unmeant = param("set", 8, {"P120=2s"});
  EXPECT_EQ(unmeant.exit_code, 64);
  EXPECT_TRUE(contains(unmeant.err, "--yes")) << unmeant.err;
  const CommandResult set = param("set", 8, {"P120=2s", "--yes"});
  EXPECT_EQ(set.exit_code, 0) << set.err;
  EXPECT_TRUE(contains(set.out, "2.00 s (was 1.25 s)")) << set.out;
  const CommandResult refused = param("set", 8, {"P073=9", "--yes"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_TRUE(contains(refused.err, "refused: P073")) << refused.err;
  // It is given free.
  EXPECT_TRUE(contains(scan().out, "waits for Set_Prm")) << "still locked";
}

// FMS at a port: the same words as of a plant.
TEST_F(ProfibusTools, FmsAtAPort) {
  const RunningLine line(folder_);
  const auto fms = [&](std::vector<std::string> words) {
    std::vector<std::string> all{"fms", port(), "8", "--quiet", "--patience", "2s"};
    all.insert(all.end(), words.begin(), words.end());
    return ipos(all);
  };
  EXPECT_EQ(fms({"read", "1025"}).out, "00 00 01 25\n") << "P120 = 1.25 s in BCD";
  EXPECT_EQ(fms({"write", "1025", "0000", "0950"}).out, "done\n");
  EXPECT_EQ(fms({"read", "1025", "994"}).out, "00 00 09 50\n0B\n");
  const CommandResult refused = fms({"write", "1025", "99", "99", "99", "99"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_TRUE(contains(refused.err, "class 8 code 0 additional 15h")) << refused.err;
  const CommandResult nobody = ipos({"fms", port(), "7", "identify", "--quiet"});
  EXPECT_EQ(nobody.exit_code, 1);
  EXPECT_TRUE(contains(nobody.err, "nobody answers")) << nobody.err;
}

TEST(Fms, OfAPlant) {
  PROVES("FMS-CRL-11");
  TemporaryFolder folder;
  folder.write("plant.toml", std::string(kLine) + kStations + kController);
  const auto fms = [&](std::vector<std::string> words) {
    std::vector<std::string> all{"fms", "plant.toml"};
    all.insert(all.end(), words.begin(), words.end());
    return run_ipos(all, folder.path());
  };
  EXPECT_EQ(fms({"belt", "read", "1025"}).out, "00 00 01 25\n");
  EXPECT_EQ(fms({"belt", "read", "990", "--at", "500ms"}).out, "00 06 05 DC 00 00\n") << "of the DP master";
  EXPECT_EQ(fms({"belt", "ov", "991"}).out, "991: object code 7, data type 10, 2 octets, read all\n");
  EXPECT_TRUE(contains(fms({"belt", "identify"}).out, "SEW-Eurodrive GmbH & Co, MOVITRAC, 821"));
  EXPECT_EQ(fms({"belt", "status"}).out, "00 00\n");
  const std::string list = fms({"belt", "crl"}).out;
  EXPECT_TRUE(contains(list, "2 MSZY O 20 All All 0 0 0 0 3000; 0 241 0 241; 00 00 00 00 20 00: Read.indication\n")) << list;
  EXPECT_TRUE(contains(list, "5 MSZY_SI O 23 All All 0 0 1 0 3000; 241 241 0 241; 00 00 10 00 10 00: Write.indication, "
                             "Event-Notification.request\n"));
  EXPECT_TRUE(contains(list, "7 MSAZ O 25 All All 0 1 0 0 0; 0 241 0 241; 00 00 00 80 33 00: Get-OV-long.indication, Read.indication, "
                             "Write.indication, Phys.-Read.indication, Phys.-Write.indication\n"));
  EXPECT_EQ(std::count(list.begin(), list.end(), '\n'), 8);
  EXPECT_EQ(fms({"pump", "read", "1025"}).exit_code, 1) << "size 0 has no FMS";
  EXPECT_EQ(fms({"pump", "crl"}).exit_code, 1);
  const std::pair<std::vector<std::string>, const char*> kWrong[] = {{{"nobody", "status"}, "has no station 'nobody'"},
                                                                     {{"belt", "go"}, "'go' is no service"},
                                                                     {{"belt", "read"}, "needs the index"},
                                                                     {{"belt", "read", "x"}, "is no index"},
                                                                     {{"belt", "write", "1025"}, "write needs"},
                                                                     {{"belt", "write", "1025", "0x1"}, "are no octets"},
                                                                     {{"belt", "status", "1"}, "takes no more words"}};
  for (const auto& [words, text] : kWrong) {
    const CommandResult result = fms(words);
    EXPECT_EQ(result.exit_code, 64) << text;
    EXPECT_TRUE(contains(result.err, text)) << result.err;
  }
}

// A slave answers on a connection to the master alone that has opened it.
TEST(Fms, AConnectionThatAMasterOfThePlantHas) {
  TemporaryFolder folder;
  folder.write("plant.toml", std::string(kLine) + kStations +
                                 "[[control]]\nname = \"panel\"\nkind = \"fms\"\nprofibus = \"dp\"\n[[control.slave]]\naddress = 8\n"
                                 "[[control.slave.request]]\nat = \"300ms\"\nread = 991\n");
  const CommandResult held = run_ipos({"fms", "plant.toml", "belt", "status"}, folder.path());
  EXPECT_EQ(held.exit_code, 1);
  EXPECT_TRUE(contains(held.err, "belt: nobody answers; 'panel', a master of the plant, has connection 7: --connection takes another one"))
      << held.err;
  EXPECT_EQ(run_ipos({"fms", "plant.toml", "belt", "status", "--connection", "6"}, folder.path()).out, "00 00\n");
}

// Switches as steps of a test file: the address acts from the next power-on, and the master then looks for its slave in vain.
TEST(Fms, SwitchesOfATestFile) {
  TemporaryFolder folder;
  folder.write("plant.toml", std::string(kLine) + kStations + "[[control]]\nname = \"plc\"\nprofibus = \"dp\"\n[[control.slave]]\naddress = 8\n"
                                                              "cfg = \"F2\"\npo = [6, 1500, 0]\n");
  const auto tested = [&](const std::string& name, const std::string& set) {
    folder.write("s.test.toml",
                 "plant = \"plant.toml\"\n[[step]]\nuntil = \"3s\"\n[[step]]\nstation = \"belt\"\nswitch = \"" + name + "\"\nset = " + set +
                     "\n[[expect]]\nstation = \"belt\"\nsignal = \"BUS_FAULT\"\nat = \"4s\"\nequals = 0\n"
                     "[[step]]\nstation = \"belt\"\npower = \"off\"\n[[step]]\nwait = \"100ms\"\n[[step]]\nstation = \"belt\"\npower = \"on\"\n"
                     "[[expect]]\nstation = \"belt\"\nsignal = \"BUS_FAULT\"\nat = \"9s\"\nequals = 1\n");
    return run_ipos({"test", "s.test.toml"}, folder.path());
  };
  const CommandResult moved = tested("profibus_address", "10");
  EXPECT_EQ(moved.exit_code, 0) << moved.out;
  EXPECT_EQ(tested("profibus_address", "8").exit_code, 1) << "the same address: it is found again";
  for (const auto& [name, set, text] : {std::tuple("profibus_adress", "9", "is no switch; known are fms_switch, profibus_address"),
                                        std::tuple("profibus_address", "128", "profibus_address is 0 to 127"),
                                        std::tuple("s13", "2", "s13 is 0 to 1"), std::tuple("fms_switch", "\"on\"", "set must be a whole number")}) {
    const CommandResult wrong = tested(name, set);
    EXPECT_NE(wrong.exit_code, 0) << name;
    EXPECT_TRUE(contains(wrong.out + wrong.err, text)) << wrong.out << wrong.err;
  }
}

TEST_F(ProfibusTools, WrongUseAndRefusalsSayWhy) {
  const RunningLine line(folder_);
  const CommandResult nobody = param("get", 30, {"P120"});
  EXPECT_EQ(nobody.exit_code, 74);
  EXPECT_TRUE(contains(nobody.err, "unit 30 at")) << nobody.err;
  EXPECT_TRUE(contains(nobody.err, "P073")) << nobody.err;
  const CommandResult configuration = param("get", 8, {"P120", "--cfg", "F3 F3"});
  EXPECT_EQ(configuration.exit_code, 1);
  EXPECT_TRUE(contains(configuration.err, "refuses the configuration F3 F3 (Cfg_Fault)"))
      << configuration.err;
  const CommandResult no_channel = param("get", 8, {"P120", "--cfg", "F2"});
  EXPECT_EQ(no_channel.exit_code, 64);
  EXPECT_TRUE(contains(no_channel.err, "has no parameter channel")) << no_channel.err;
  EXPECT_EQ(param("set", 8, {"P120=1s", "--volatile"}).exit_code, 64);
  EXPECT_EQ(ipos({"scan", "can0", "--profibus"}).exit_code, 64);
  EXPECT_EQ(ipos({"scan", port(), "--profibus", "--baud", "57600"}).exit_code, 64);
}

TEST_F(ProfibusTools, ASlaveThatIsLockedSaysByWhom) {
  const RunningLine line(folder_, kController);
  // The master orders 0006 05DC after some time, when the slave has found the rate.
  CommandResult found = scan();
  for (int tries = 0; tries < 60 && !contains(found.out, "00 06 05 DC 00 00"); ++tries) {
    usleep(100'000);
    found = scan();
  }
  EXPECT_EQ(found.exit_code, 0) << found.err;
  EXPECT_TRUE(contains(found.out, "data exchange with master 1")) << found.out;
  EXPECT_TRUE(contains(found.out, "F2 (3 PD)")) << found.out;
  EXPECT_TRUE(contains(found.out, "00 06 05 DC 00 00")) << found.out;
  const CommandResult locked = param("get", 8, {"P120"});
  EXPECT_EQ(locked.exit_code, 1);
  EXPECT_TRUE(contains(locked.err, "master 1 has locked it")) << locked.err;
}

TEST_F(ProfibusTools, AMasterThatSpeaksIsNotDisturbedAndIsMonitored) {
  std::string controller = kController;
  controller = controller.substr(0, controller.find("[[control.command]]"));
  const RunningLine line(folder_, controller);
  const CommandResult found = scan();
  EXPECT_EQ(found.exit_code, 74);
  EXPECT_TRUE(contains(found.err, "master 1 speaks on the line")) << found.err;
  const auto monitor = [this] {
    return ipos({"bus", "monitor", port(), "--profibus", "--count", "40", "--for", "20s"});
  };
  // The slave looks for the rate first.
  CommandResult heard = monitor();
  for (int tries = 0; tries < 100 && !contains(heard.out, "Data_Exchange answer"); ++tries) {
    usleep(200'000);
    heard = monitor();
  }
  EXPECT_EQ(heard.exit_code, 0) << heard.err;
  EXPECT_TRUE(contains(heard.out, "1 -> 8 Data_Exchange")) << heard.out;
  EXPECT_TRUE(contains(heard.out, "8 -> 1 Data_Exchange answer")) << heard.out;
  EXPECT_TRUE(contains(heard.err, ", 40 shown")) << heard.err;
}

// pcapng and the log of serial lines of one run tell the same, also of frames that the line damaged: a parity error is not
// in the octets.
TEST(ProfibusLogs, PcapngHasTheFramesOfTheSerialLog) {
  const TemporaryFolder folder;
  std::string controller = kController;
  controller = controller.substr(0, controller.find("[[control.command]]"));
  folder.write("plant.toml",
               std::string(kLine) + kStations + controller +
                   "[[fault]]\nbus = \"dp\"\nkind = \"parity\"\nfrom = \"100ms\"\nuntil = \"110ms\"\n");
  const auto run = [&](const char* option, const char* log) {
    const CommandResult result =
        run_ipos({"run", "plant.toml", "--for", "200ms", option, log}, folder.path());
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const CommandResult decoded = run_ipos({"bus", "decode", log, "--format", "json"}, folder.path());
    EXPECT_EQ(decoded.exit_code, 0) << decoded.err;
    return decoded.out;
  };
  const std::string serial = run("--serial-log", "dp.log"), pcapng = run("--log", "dp.pcapng");
  EXPECT_EQ(serial, pcapng);
  EXPECT_TRUE(contains(serial, "\"void\":\"parity error\"")) << serial.substr(0, 2000);
  EXPECT_GT(std::count(serial.begin(), serial.end(), '\n'), 100);
  const CommandResult empty =
      run_ipos({"run", "plant.toml", "--for", "10ms", "--log", "dp.log"}, folder.path());
  EXPECT_TRUE(contains(empty.err, "warning: dp.log stays empty")) << empty.err;
}

// 11 bits an octet: the request of 11 octets, the answer of 17, and the request again 1 ms later: 121, 187, 121. From the
// first begin to the last end it is 1 ms and 242 us, 621 bits at 500 kbaud.
TEST(ProfibusLoadOfALog, CountsBitsByKindOfFrame) {
  const TemporaryFolder folder;
  folder.write("dp.log",
               "0.000000 0.000242 dp 68 05 05 68 88 81 6D 3C 3E F0 16 | 1 -> 8 Slave_Diag\n"
               "0.000264 0.000638 dp 68 0B 0B 68 81 88 08 3E 3C 02 05 00 FF 31 00 C2 16 | 8 -> 1\n"
               "0.001000 0.001242 dp 68 05 05 68 88 81 6D 3C 3E F0 16 | 1 -> 8 Slave_Diag\n");
  const CommandResult text = run_ipos({"bus", "load", "dp.log", "--baud", "500000"}, folder.path());
  EXPECT_EQ(text.exit_code, 0) << text.err;
  EXPECT_TRUE(std::regex_search(text.out, std::regex("\n1 -> 8 Slave_Diag +2 +242 +38\\.97 +1\\.000\n")))
      << text.out;
  EXPECT_TRUE(std::regex_search(text.out, std::regex("\n8 -> 1 Slave_Diag answer +1 +187 +30\\.11 +-\n")))
      << text.out;
  const CommandResult json =
      run_ipos({"bus", "load", "dp.log", "--baud", "500000", "--format", "json"}, folder.path());
  const auto report = nlohmann::json::parse(json.out);
  EXPECT_EQ(report["all"]["bits"], 121 + 187 + 121);
  EXPECT_NEAR(report["all"]["percent"].get<double>(), 100.0 * 429 / 621, 0.01);
  EXPECT_EQ(report["frames"].size(), 2U);

  folder.write(
      "mixed.log",
      "0.000000 0.000242 dp 68 05 05 68 88 81 6D 3C 3E F0 16 | x\n(0946684800.009242) sbus 20B#01\n");
  const CommandResult mixed = run_ipos({"bus", "load", "mixed.log", "--baud", "500000"}, folder.path());
  EXPECT_EQ(mixed.exit_code, 0);
  EXPECT_TRUE(contains(mixed.err, "mixed.log: note: 1 telegram of another kind of bus left out")) << mixed.err;
}

}  // namespace
}  // namespace ipos::tests
