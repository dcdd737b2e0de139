// `ipos bus monitor`: logs, slcan in both directions and a serial line, over pseudo-terminals. SocketCAN is
// in tests/realbus.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <regex>
#include <sstream>

#include "tests/harness/contains.hpp"
#include "tests/harness/proves.hpp"
#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

// Without the time stamps, which are those of the day.
std::vector<std::string> without_times(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    EXPECT_TRUE(std::regex_search(line, std::regex(R"(^\(\d{10}\.\d{6}\) )"))) << line;
    lines.push_back(line.substr(line.find(' ') + 1));
  }
  return lines;
}

// A log of the MOVLNK sample (1053 1610 p. 48): 523 = 8 * 1 + 515, and so on; 531 is for address 2.
constexpr const char* kLog =
    "(1000000000.000000) can0 20B#3100207E00000000\n"
    "(1000000000.002000) can0 20C#3100207E000F4240\n"
    "(1000000000.003000) can0 213#3100207E00000000\n"
    "(1000000000.500000) can0 7D0#AB\n"
    "(1000000001.000000) can0 00B#000613883A98\n";

TEST(Monitor, ALogInWords) {
  const TemporaryFolder folder;
  folder.write("a.log", kLog);
  const CommandResult all = run_ipos({"bus", "monitor", "a.log"}, folder.path());
  EXPECT_EQ(all.exit_code, 0);
  EXPECT_EQ(all.out,
            "(1000000000.000000) can0 20B read 8318 Speed -> address 1\n"
            "(1000000000.002000) can0 20C read 8318 Speed = 1000.000 rpm <- address 1\n"
            "(1000000000.003000) can0 213 read 8318 Speed -> address 2\n"
            "(1000000000.500000) can0 7D0 AB\n"
            "(1000000001.000000) can0 00B PO 0006h, 1388h, 3A98h -> address 1\n");
  EXPECT_EQ(all.err, "ipos: 5 telegrams, 5 shown\nipos: nothing is known about 1 identifiers: 7D0h (2000)\n");
  const CommandResult one =
      run_ipos({"bus", "monitor", "a.log", "--station", "1", "--count", "2"}, folder.path());
  EXPECT_EQ(without_times(one.out),
            (std::vector<std::string>{"can0 20B read 8318 Speed -> address 1",
                                      "can0 20C read 8318 Speed = 1000.000 rpm <- address 1"}));
  const CommandResult early = run_ipos({"bus", "monitor", "a.log", "--for", "500ms"}, folder.path());
  EXPECT_EQ(without_times(early.out).size(), 3U);
  EXPECT_EQ(early.exit_code, 0);
  const CommandResult two = run_ipos({"bus", "monitor", "a.log", "--station", "2"}, folder.path());
  EXPECT_EQ(without_times(two.out), (std::vector<std::string>{"can0 213 read 8318 Speed -> address 2"}));
}

TEST(Monitor, NamesAndStationsOfAPlant) {
  const TemporaryFolder folder;
  const std::string plant = project("examples/sbus-line/line.toml").string();
  ASSERT_EQ(run_ipos({"run", plant, "--for", "1s", "--log", "a.log"}, folder.path()).exit_code, 0);
  const CommandResult decoded = run_ipos({"bus", "decode", "a.log", "--names", plant}, folder.path());
  const CommandResult all = run_ipos({"bus", "monitor", "a.log", "--plant", plant}, folder.path());
  EXPECT_EQ(all.out, decoded.out) << "the same words as decode";
  // inverter3 has address 11: its PO 91 and PI 92 and the sync telegram, nothing of 1 (33: 268, 269).
  const CommandResult third =
      run_ipos({"bus", "monitor", "a.log", "--plant", plant, "--station", "inverter3"}, folder.path());
  EXPECT_TRUE(
      contains(third.out, " 05B PO CTRL. WORD 1 0006h (enable), SPEED 500.0 rpm, 0000h -> inverter3\n"));
  EXPECT_TRUE(contains(third.out, " 000 sync telegram\n"));
  EXPECT_FALSE(contains(third.out, "inverter1"));
  // Variable telegrams belong to their sender and to those that receive them.
  const CommandResult second = run_ipos(
      {"bus", "monitor", "a.log", "--plant", plant, "--station", "inverter2,inverter3"}, folder.path());
  EXPECT_TRUE(contains(second.out, " 400 lLength = 12346"));
  EXPECT_TRUE(contains(second.out, "-> inverter3"));
  EXPECT_FALSE(contains(second.out, "-> inverter1"));
}

TEST(Monitor, WrongUse) {
  const TemporaryFolder folder;
  folder.write("a.log", kLog);
  const auto code = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"bus", "monitor"});
    const CommandResult result = run_ipos(arguments, folder.path());
    EXPECT_NE(result.err, "");
    return result.exit_code;
  };
  EXPECT_EQ(code({"none.log"}), 66);
  EXPECT_EQ(code({"/nowhere/tty"}), 66);
  EXPECT_EQ(code({"can-of-a-name-that-is-too-long"}), 74);
  EXPECT_EQ(code({"/dev/null"}), 74);  // a device, but no serial one
  EXPECT_EQ(code({"a.log", "--station", "unit9"}), 64);
  EXPECT_EQ(code({"a.log", "--baud", "500000"}), 64);
  EXPECT_EQ(code({"a.log", "--count", "0"}), 64);
  EXPECT_EQ(code({"vcan0", "--follow"}), 64);
  EXPECT_EQ(code({"-", "--follow"}), 64);
  EXPECT_EQ(code({"pty:" + (folder.path() / "line").string(), "--baud", "19200"}), 74);
  folder.write("bad.log", std::string("nonsense\n") + kLog);
  const CommandResult bad = run_ipos({"bus", "monitor", "bad.log"}, folder.path());
  EXPECT_EQ(bad.exit_code, 65);
  EXPECT_TRUE(contains(bad.err, "bad.log:1:1: error: '(' expected\n"));
  EXPECT_EQ(without_times(bad.out).size(), 5U);
}

TEST(Monitor, ALogThatGrows) {
  const TemporaryFolder folder;
  const std::string path = folder.write("a.log", kLog);
  RunningIpos monitor({"bus", "monitor", "a.log", "--follow"}, folder.path());
  ASSERT_TRUE(monitor.prints(" 00B PO "));
  std::ofstream(path, std::ios::app) << "(1000000002.000000) can0 20B#31002";
  std::ofstream(path, std::ios::app) << "11600000000\n";
  ASSERT_TRUE(monitor.prints(" 20B read 8470 Ramp t11 UP CW -> address 1\n"));
  folder.write("a.log", "(1000000003.000000) can0 20B#3100211700000000\n");  // begun anew
  ASSERT_TRUE(monitor.prints(" 20B read 8471 Ramp t11 DOWN CW -> address 1\n"));
  monitor.signal(SIGINT);
  const CommandResult end = monitor.wait();
  EXPECT_EQ(end.exit_code, 130);
  EXPECT_TRUE(contains(end.err, "ipos: 7 telegrams, 7 shown\n")) << end.err;
  // It ends by itself, too.
  const CommandResult timed = run_ipos({"bus", "monitor", "a.log", "-f", "--for", "100ms"}, folder.path());
  EXPECT_EQ(timed.exit_code, 0);
  EXPECT_EQ(without_times(timed.out).size(), 1U);
}

// Whoever writes to a pipe may pause for longer than the monitor waits at a time.
TEST(Monitor, StandardInput) {
  const TemporaryFolder folder;
  folder.write("a.log", kLog);
  const auto monitor = [&](const std::string& before, const std::string& behind) {
    const std::string command = "cd '" + folder.path().string() + "' && " + before + "'" + ipos_program() +
                                "' bus monitor - > out 2> err" + behind;
    return WEXITSTATUS(std::system(command.c_str()));
  };
  // A single byte is no end either.
  const char* pauses = "(cat a.log; sleep 0.3; head -c 1 a.log; sleep 0.3; tail -c +2 a.log) | ";
  EXPECT_EQ(monitor(pauses, ""), 0) << read_text(folder.path() / "err");
  EXPECT_EQ(without_times(read_text(folder.path() / "out")).size(), 10U);
  EXPECT_EQ(monitor("", " < ."), 66);
  EXPECT_EQ(read_text(folder.path() / "err"), "ipos: -: Is a directory\n");
}

class MonitorAtPorts : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_pty()) GTEST_SKIP() << kNoPty;
  }
  std::string path() const { return (folder_.path() / "port").string(); }

  // Opens the other end once it is there.
  int attach() const {
    for (int n = 0; n < 1000; ++n) {
      const int descriptor = open(path().c_str(), O_RDWR | O_NOCTTY);
      if (descriptor >= 0) return descriptor;
      usleep(10'000);
    }
    return -1;
  }
  static void write_all(int descriptor, const std::string& bytes) {
    ASSERT_EQ(write(descriptor, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }

  // What has come and was not read.
  static std::string read_all(int descriptor) {
    fcntl(descriptor, F_SETFL, O_NONBLOCK);
    std::string text;
    char chunk[256];
    for (ssize_t size; (size = read(descriptor, chunk, sizeof chunk)) > 0;)
      text.append(chunk, static_cast<size_t>(size));
    return text;
  }

  TemporaryFolder folder_;
};

// A frame that a program puts on the bus reaches the receive object of a plant, and the plant's frames reach
// the program: the unit sends what it has received.
TEST_F(MonitorAtPorts, VariableTelegramsGoThroughAPort) {
  PROVES("VAR-01");
  folder_.write(
      "ECHO.IPC",
      "#include <const.h>\nSCTRCYCL T; SCREC R; long lOutLow, lOutHigh, lLow, lHigh;\nmain()\n{\n"
      " T.ObjectNo = 1024; T.CycleTime = 20; T.Offset = 0; T.Format = 8; T.DPointer = numof(lOutLow);\n"
      " _SBusCommDef(SCD_TRCYCL, T);\n R.ObjectNo = 1025; R.Format = 8; R.DPointer = numof(lLow);\n"
      " _SBusCommDef(SCD_REC, R);\n _SBusCommOn();\n"
      " while (1) { lOutLow = lLow; lOutHigh = lHigh + 1; }\n}\n");
  const std::string plant = folder_.write(
      "echo.toml",
      "[[bus]]\nname = \"sbus\"\nkind = \"can\"\nport = \"slcan:pty:" + path() +
          "\"\n[[station]]\nname = \"unit1\"\nunit = \"md60a\"\nprogram = \"ECHO.IPC\"\nsbus = \"sbus\"\n");
  RunningIpos run({"run", plant, "--realtime", "--for", "60s"});
  ASSERT_TRUE(run.tells("joined"));
  const int program = attach();
  ASSERT_GE(program, 0);
  write_all(program, "S6\rO\r");
  // MOTOROLA: the second variable in front, high bytes first.
  for (const auto& [sent, expected] : {std::pair{"t40185566778811223344\r", "t40085566778911223344\r"},
                                       {"t40180000000A0000000B\r", "t40080000000B0000000B\r"}}) {
    std::string heard;
    for (int n = 0; n < 500 && heard.find(expected) == std::string::npos; ++n) {
      write_all(program, sent);
      usleep(20'000);
      heard += read_all(program);
    }
    EXPECT_NE(heard.find(expected), std::string::npos) << heard;
  }
  close(program);
  run.signal(SIGTERM);
  EXPECT_EQ(run.wait().exit_code, 130);
}

// The monitor is the adapter; this test is the program that puts frames on the bus.
TEST_F(MonitorAtPorts, FramesOfAnSlcanProgram) {
  PROVES("M07-MON-10");  // it observes; the control mode: BusMonitor.ControlsOrObserves
  const time_t before = std::time(nullptr);
  RunningIpos monitor({"bus", "monitor", "slcan:pty:" + path(), "--program",
                       project("examples/scom/SCOM1.IPC").string(), "--count", "4"});
  ASSERT_TRUE(monitor.tells("monitoring slcan:pty:"));
  const int program = attach();
  ASSERT_GE(program, 0);
  write_all(program, "S6\rO\rt20B83100207E00000000\rt20C83100207E000F4240\r");
  ASSERT_TRUE(monitor.prints("1000.000 rpm"));
  // A line that is no frame, and one that is longer than any.
  write_all(program, "t20B9\r" + std::string(100, '0') + "\r");
  ASSERT_TRUE(monitor.prints("lost"));
  // It has answered the commands of the program and has put no frame on the bus.
  const std::string heard = read_all(program);
  write_all(program, "t40085566778811223344\rT000000070\r");
  const CommandResult end = monitor.wait();
  close(program);
  EXPECT_EQ(heard.find_first_of("tTrR"), std::string::npos) << heard;
  EXPECT_NE(heard.find('\r'), std::string::npos);
  EXPECT_EQ(end.exit_code, 0);
  // Time stamps are of the clock on the wall.
  const time_t first = std::stoll(end.out.substr(1, 10));
  EXPECT_GE(first, before);
  EXPECT_LE(first, std::time(nullptr));
  uint64_t lost = 0;
  std::vector<std::string> words;
  for (const std::string& line : without_times(end.out)) {
    std::smatch found;
    const std::string text = line.substr(line.find(' ') + 1);
    if (std::regex_match(text, found, std::regex("--- (\\d+) frames lost")))
      lost += std::stoull(found[1]);
    else
      words.push_back(text);
  }
  EXPECT_EQ(lost, 2U);
  // 1053 1610 p. 57: the second variable stands first.
  EXPECT_EQ(words,
            (std::vector<std::string>{
                "20B read 8318 Speed -> address 1", "20C read 8318 Speed = 1000.000 rpm <- address 1",
                "400 lTrDataLow = 287454020 (11223344h), lTrDataHigh = 1432778632 (55667788h) <- SCOM1",
                "00000007 no data"}));
  EXPECT_TRUE(contains(end.err, "is refused: 't20B9'")) << end.err;
  EXPECT_TRUE(contains(end.err, "4 telegrams, 4 shown, 2 lost")) << end.err;
  EXPECT_FALSE(std::filesystem::exists(std::filesystem::symlink_status(path()))) << "the link is left";
}

// The monitor is the program, a plant in real time has the adapter.
TEST_F(MonitorAtPorts, ASimulatedPlantLive) {
  for (const char* program : {"SCOM1.IPC", "SCOM2.IPC"})
    folder_.write(program, read_text(project("examples/scom") / program));
  const std::string plant =
      folder_.write("scom.toml", std::regex_replace(read_text(project("examples/scom/scom.toml")),
                                                    std::regex("kind = \"can\""),
                                                    "$&\nport = \"slcan:pty:" + path() + "\""));
  RunningIpos run({"run", plant, "--realtime", "--for", "60s"});
  ASSERT_TRUE(run.tells("joined"));
  RunningIpos monitor({"bus", "monitor", "slcan:" + path(), "--plant", plant, "--station", "unit2"});
  ASSERT_TRUE(monitor.prints("<- unit2"));
  ASSERT_TRUE(monitor.prints("<- unit1"));  // what unit2 receives
  monitor.signal(SIGINT);
  const CommandResult end = monitor.wait();
  EXPECT_EQ(end.exit_code, 130);
  EXPECT_TRUE(contains(end.out,
                       " 400 lTrDataLow = 287454020 (11223344h), "
                       "lTrDataHigh = 1432778632 (55667788h) <- unit1\n"))
      << end.out;
  EXPECT_TRUE(std::regex_search(end.err, std::regex("ipos: \\d+ telegrams, \\d+ shown"))) << end.err;
  // And for a time, with a station that has no telegrams here.
  const CommandResult quiet =
      run_ipos({"bus", "monitor", "slcan:" + path(), "--plant", plant, "--station", "60", "--for", "300ms"});
  EXPECT_EQ(quiet.exit_code, 0);
  EXPECT_EQ(quiet.out, "");
  run.signal(SIGTERM);
  EXPECT_EQ(run.wait().exit_code, 130);
}

// RS-485, built by the frame of 1053 1610 p. 18-24 (block check: exclusive or of all bytes): a request with
// 3PD answer), and one whose block check is wrong.
TEST_F(MonitorAtPorts, TelegramsOfASerialLine) {
  const std::string plant =
      folder_.write("plant.toml",
                    "[[bus]]\nname = \"line1\"\nkind = \"rs485\"\n[[station]]\nname = \"unit1\"\n"
                    "unit = \"md60a\"\nrs485 = \"line1\"\n[station.parameters]\nP810 = 1\n"
                    "P811 = 105\n");
  RunningIpos monitor(
      {"bus", "monitor", "pty:" + path(), "--plant", plant, "--station", "unit1", "--count", "5"});
  ASSERT_TRUE(monitor.tells("monitoring pty:"));
  const int program = attach();
  ASSERT_GE(program, 0);
  const auto hex = [](const std::string& text) {
    std::string bytes;
    std::istringstream in(text);
    for (std::string byte; in >> byte;) bytes += static_cast<char>(std::stoi(byte, nullptr, 16));
    return bytes;
  };
  // 02 01 05 00 06 13 88 0B B8 ..: control word 6, 5000 digits = 1000 rpm; the answer right behind it.
  write_all(program, hex("02 01 05 00 06 13 88 0B B8 28") + hex("1D 01 05 00 07 13 93 00 00 9E"));
  ASSERT_TRUE(monitor.prints("<- unit1"));
  usleep(500'000);  // nothing tells when the monitor has read what it does not show, so it gets a pause that is long
  write_all(program, hex("02 02 05 00 06 13 88 0B B8 2B"));  // for address 2: not shown
  usleep(500'000);
  write_all(program, hex("02 69 86 32 00 21 16 00 00 0B B8 5B"));  // group 105: P130 = 3 s
  ASSERT_TRUE(monitor.prints("group 105"));
  usleep(50'000);
  write_all(program, hex("02 01 05 00 06 13 88 0B B8 00"));  // wrong block check
  ASSERT_TRUE(monitor.prints("void"));
  usleep(50'000);
  write_all(program, hex("02 01 05"));  // broken off
  const CommandResult end = monitor.wait();
  close(program);
  EXPECT_EQ(end.exit_code, 0);
  std::vector<std::string> words;
  for (const std::string& line : without_times(end.out)) words.push_back(line.substr(line.find(' ') + 1));
  EXPECT_EQ(words, (std::vector<std::string>{
                       "3PD cyclic, PO CTRL. WORD 1 0006h (enable), SPEED 1000.0 rpm, 0BB8h -> unit1",
                       "3PD cyclic, PI STATUS WORD1 0007h (ready, output stage on, PO data on; state 0 not "
                       "ready), SPEED 1002.2 rpm, OUTP. CURRENT 0.0 % In <- unit1",
                       "PARAM acyclic, write 8470 Ramp t11 UP CW = 3.000 s -> group 105",
                       "void, BCC incorrect: 02 01 05 00 06 13 88 0B B8 00",
                       "void, character delay exceeded: 02 01 05"}));
  EXPECT_TRUE(contains(end.err, "6 telegrams, 5 shown, 2 void")) << end.err;
  EXPECT_TRUE(contains(end.err, "a pseudo-terminal has no parity")) << end.err;
}

}  // namespace
}  // namespace ipos::tests
