// Programs that know nothing of ipos attach to its pseudo-terminals: python3-can by slcan, python3-serial to
// a serial line and as a MOVILINK master. No kernel CAN is needed.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <future>
#include <regex>

#include "runtime/os_port/adapter_port.hpp"
#include "runtime/os_port/serial_port.hpp"
#include "runtime/os_port/system_clock.hpp"
#include "tests/harness/proves.hpp"
#include "tests/harness/reach.hpp"
#include "tests/realbus/script.hpp"
#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

using namespace ipos::runtime;  // NOLINT: ports and times

bool python_has(const std::string& module) {
  return run_script({kPython, "-c", "import " + module}).exit_code == 0;
}

std::string script(const std::string& name) { return project("tests/realbus/" + name).string(); }

TEST(PythonPeers, SlcanInterfaceOfPythonCan) {
  if (!has_pty()) GTEST_SKIP() << kNoPty;
  if (!python_has("can, serial")) GTEST_SKIP() << "there is no python3-can";
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "adapter").string();
  for (const char* program : {"SCOM1.IPC", "SCOM2.IPC"})
    folder.write(program, read_text(project("examples/scom") / program));
  const std::string plant = folder.write(
      "scom.toml", std::regex_replace(read_text(project("examples/scom/scom.toml")),
                                      std::regex("kind = \"can\""), "$&\nport = \"slcan:pty:" + path + "\""));
  const ScriptResult result =
      run_script({kPython, "-B", script("slcan_peer.py"), ipos_program(), plant, path});
  EXPECT_EQ(result.exit_code, 0) << result.output;
  expect_all_ok(result.output, 12);
  EXPECT_FALSE(std::filesystem::exists(std::filesystem::symlink_status(path))) << "the link is left";
}

TEST(PythonPeers, SerialLineOfPythonSerial) {
  if (!has_pty()) GTEST_SKIP() << kNoPty;
  if (!python_has("serial")) GTEST_SKIP() << "there is no python3-serial";
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "line1").string();
  SystemClock clock;
  const SerialPortResult port = open_serial_port("pty:" + path, {}, clock);
  ASSERT_TRUE(port) << port.error().text;
  std::future<ScriptResult> peer = std::async(std::launch::async, [&] {
    return run_script({kPython, "-B", script("serial_peer.py"), path});
  });
  Time last = 0;
  while (peer.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
    std::array<ByteArrival, 64> arrived{};
    const auto count = (*port)->receive(arrived);
    ASSERT_TRUE(count) << count.error().text;
    std::vector<uint8_t> answer;
    for (const ByteArrival& byte : std::span(arrived).first(*count)) {
      EXPECT_GE(byte.at, last);
      EXPECT_FALSE(byte.bad);
      last = byte.at;
      answer.push_back(static_cast<uint8_t>(~byte.value));
    }
    (*port)->send(answer);
    ASSERT_TRUE((*port)->flush());
    const std::array<PortNeeds, 1> needs{(*port)->needs()};
    clock.wait(clock.now() + kMillisecond, needs);
  }
  const ScriptResult result = peer.get();
  EXPECT_EQ(result.exit_code, 0) << result.output;
  expect_all_ok(result.output, 5);
  EXPECT_EQ((*port)->counts().received, 256U + 1 + 10 + 300);
  EXPECT_EQ((*port)->counts().lost_out, 0U);
}

// python3-can at the stand-ins for the libraries of adapters' makers, and a port of ours at another channel of the same bus.
TEST(PythonPeers, AdapterLibrariesOfPythonCan) {
  if (!python_has("can.interfaces.pcan.pcan, can.interfaces.kvaser, can.interfaces.vector, packaging"))
    GTEST_SKIP() << "there is no python3-can";
  const TemporaryFolder folder;
  setenv("IPOS_STAND_IN_BUS", (folder.path() / "bus").c_str(), 1);
  setenv("LD_LIBRARY_PATH", IPOS_STAND_INS, 1);
  SystemClock clock;
  const std::array<const char*, 4> rows[] = {{"pcan", "PCAN_USBBUS2", "libpcanbasic.so", "pcan:USB1"},
                                             {"kvaser", "1", "libcanlib.so", "kvaser:0"},
                                             {"vector", "1", "libvxlapi64.so", "vector:0"},
                                             {"ixxat", "1", "libvcinpl.so", "ixxat:0"}};
  for (const auto& [interface, channel, name, ours] : rows) {
    const std::string library = std::string(IPOS_STAND_INS "/") + name;
    const CanPortResult port = open_adapter_port(ours, 250'000, clock, library);
    ASSERT_TRUE(port) << port.error().text;
    std::future<ScriptResult> peer = std::async(std::launch::async, [&, its = interface, at = channel] {
      return run_script({kPython, "-B", script("adapter_peer.py"), its, at, library});
    });
    while (peer.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
      const auto got = (*port)->receive();
      ASSERT_TRUE(got) << got.error().text;
      if (*got && !(*got)->error) {
        Frame answer = (*got)->frame;
        answer.id = (answer.id + 1) % (answer.extended ? kExtendedIdLimit : kStandardIdLimit);
        for (uint8_t& byte : answer.data) byte = static_cast<uint8_t>(~byte);
        (*port)->send(canonical(answer));
      }
      ASSERT_TRUE((*port)->flush());
      const std::array<PortNeeds, 1> needs{(*port)->needs()};
      if (!*got) clock.wait(clock.now() + kMillisecond, needs);
    }
    const ScriptResult result = peer.get();
    EXPECT_EQ(result.exit_code, 0) << interface << ": " << result.output;
    expect_all_ok(result.output, 6);
    EXPECT_EQ((*port)->counts().received, 5U) << interface;
  }
}

// Some seconds of it; noise.py IPOS 600 is the long form.
TEST(PythonPeers, NoiseAtThePorts) {
  if (!has_pty()) GTEST_SKIP() << kNoPty;
  const ScriptResult result = run_script({kPython, "-B", script("noise.py"), ipos_program(), "4"});
  EXPECT_EQ(result.exit_code, 0) << result.output;
  expect_all_ok(result.output, 6);
}

TEST(PythonPeers, TheLogOfAKilledRun) {
  const ScriptResult result = run_script(
      {kPython, "-B", script("killed_log.py"), ipos_program(), project("examples/scom/scom.toml").string()});
  EXPECT_EQ(result.exit_code, 0) << result.output;
  expect_all_ok(result.output, 1);
}

TEST(PythonPeers, MovilinkMasterOfPythonSerial) {
  if (!has_pty()) GTEST_SKIP() << kNoPty;
  if (!python_has("serial")) GTEST_SKIP() << "there is no python3-serial";
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "line1").string();
  const std::string plant = folder.write(
      "movilink.toml", std::regex_replace(read_text(project("tests/realbus/movilink.toml")),
                                          std::regex("kind = \"rs485\""), "$&\nport = \"pty:" + path + "\""));
  const ScriptResult result =
      run_script({kPython, "-B", script("movilink_peer.py"), ipos_program(), plant, path});
  EXPECT_EQ(result.exit_code, 0) << result.output;
  expect_all_ok(result.output, 35);
}

// Three hundred SYNC cycles of it; the script takes any number (10000 take about a minute).
TEST(PythonPeers, CanopenMasterOfPythonCan) {
  if (!has_pty()) GTEST_SKIP() << kNoPty;
  if (!python_has("can, serial")) GTEST_SKIP() << "there is no python3-can";
  PROVES("MDB-TOC-06", "MDB-TOC-07", "MDB-TOC-08", "MDB-TOC-09", "MDB-TOC-10", "MDB-TOC-11", "MDB-TOC-12",
         "MDB-TOC-13", "MDB-TOC-14", "MDB-TOC-15", "MDB-TOC-16", "MDB-TOC-19");
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "adapter").string();
  const std::string log = (folder.path() / "can.log").string();
  const std::string plant =
      folder.write("canopen.toml",
                   std::regex_replace(read_text(project("tests/realbus/canopen.toml")),
                                      std::regex("kind = \"can\""), "$&\nport = \"slcan:pty:" + path + "\""));
  ASSERT_EQ(run_ipos({"canopen", "eds", plant, "a", "-o", "a.eds"}, folder.path()).exit_code, 0);
  const ScriptResult result = run_script({kPython, "-B", script("canopen_master.py"), ipos_program(), plant,
                                          path, (folder.path() / "a.eds").string(), log, "300"});
  EXPECT_EQ(result.exit_code, 0) << result.output;
  expect_all_ok(result.output, 19);
  // Every frame of the log has a meaning here, and for the dissector of others.
  const CommandResult decoded = run_ipos({"bus", "decode", log, "--plant", plant}, folder.path());
  EXPECT_EQ(decoded.exit_code, 0);
  EXPECT_EQ(decoded.err, "");
  if (run_script({"/usr/bin/tshark", "--version"}).exit_code != 0)
    GTEST_SKIP() << "tshark is not installed; install it to compare with Wireshark's dissector";
  const ScriptResult theirs =
      run_script({"/usr/bin/tshark", "-r", log, "-d", "can.subdissector,canopen", "-Y",
                  "canopen && !_ws.malformed", "-T", "fields", "-e", "frame.number"});
  // The frame numbers alone: to root it says something in front.
  const auto lines = [](const std::string& text) {
    const std::regex line("(^|\\n)[0-9(]");
    return std::distance(std::sregex_iterator(text.begin(), text.end(), line), {});
  };
  const auto remote = std::regex("guarding request");
  const auto requests =
      std::distance(std::sregex_iterator(decoded.out.begin(), decoded.out.end(), remote), {});
  EXPECT_EQ(lines(theirs.output) + requests, lines(decoded.out)) << theirs.output.substr(0, 200);
}

// Manual operation over RS-485 from a PC, without a controller: it takes control and setpoint and gives both back, and where the
// PC falls silent the drive's monitoring ends it.
TEST(PythonPeers, ManualOperationAtRs485) {
  if (!has_pty()) GTEST_SKIP() << kNoPty;
  PROVES("MDB-TOC-02");
  goes_through(kVerb);
  const ScriptResult result =
      run_script({kPython, "-B", project("tests/serve/jog_test.py").string(), ipos_program(), "GivenBack.test_control_and_setpoint",
                  "GivenBack.test_a_response_that_lets_it_go_on"});
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_NE(result.output.find("Ran 2 tests"), std::string::npos) << result.output;
  EXPECT_EQ(result.output.find("skipped"), std::string::npos) << result.output;
}

// Two slaves on one line in real time, noise, and a careless master. The long form is "1000000 100000 1000".
TEST(PythonPeers, ProfibusMasterOfClassOne) {
  if (!has_pty()) GTEST_SKIP() << kNoPty;
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "dp").string();
  const std::string plant = folder.write(
      "dp.toml", std::regex_replace(read_text(project("tests/realbus/profibus_plant.toml")),
                                    std::regex("kind = \"profibus\""), "$&\nport = \"pty:" + path + "\""));
  const ScriptResult result = run_script(
      {kPython, "-B", script("profibus_master.py"), ipos_program(), plant, path, "600", "800", "72"});
  EXPECT_EQ(result.exit_code, 0) << result.output;
  expect_all_ok(result.output, 14);
}

}  // namespace
}  // namespace ipos::tests
