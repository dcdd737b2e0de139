// Names of ports, and the errors a user can make with them. Real interfaces are in tests/realbus.
#include <gtest/gtest.h>

#include <filesystem>

#include "runtime/os_port/can_port.hpp"
#include "runtime/os_port/port_names.hpp"
#include "runtime/os_port/serial_port.hpp"
#include "runtime/os_port/system_clock.hpp"
#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

using namespace ipos::runtime;  // NOLINT: everything here is about the runtime

PortError can_error(const std::string& name, uint32_t baud = 500'000) {
  SystemClock clock;
  const CanPortResult port = open_can_port(name, baud, clock);
  return port ? PortError{} : port.error();
}

PortError serial_error(const std::string& name, uint32_t baud = 9600) {
  SystemClock clock;
  const SerialPortResult port = open_serial_port(name, {baud, true}, clock);
  return port ? PortError{} : port.error();
}

TEST(PortNames, Can) {
  for (const char* name :
       {"", "a/b", "vcan 0", "sim:x", "averylongnamethatnointerfacehas", "slcan:", "slcan:ttyACM0",
        "slcan:/dev/ttyUSB0@fast", "slcan:/dev/ttyUSB0@115200x", "slcan:pty:"})
    EXPECT_EQ(can_error(name).fault, PortFault::BadName) << name;
  EXPECT_EQ(can_error("nocan7").fault, PortFault::NoSuchInterface);
  EXPECT_EQ(can_error("lo").fault, PortFault::NotCan);
  EXPECT_EQ(can_error("slcan:/dev/nothere").fault, PortFault::NoSuchDevice);
  EXPECT_EQ(can_error("slcan:/dev/null").fault, PortFault::NotSerial);
  EXPECT_EQ(can_error("slcan:/dev/null@1234").fault, PortFault::NoBaudRate);
  EXPECT_EQ(can_error("slcan:/dev/null", 300'000).fault, PortFault::NoBaudRate);
}

TEST(PortNames, CanErrorsAreOneClearLine) {
  EXPECT_EQ(can_error("nocan7").text,
            "nocan7: there is no such network interface: 'ip link' lists them; 'ip link add vcan0 type vcan' "
            "makes one; a serial device is written with its path, ./nocan7");
  EXPECT_EQ(can_error("slcan:/dev/null", 300'000).text,
            "/dev/null: the device does not take this baud rate: slcan has none for 300000 bit/s");
}

TEST(PortNames, Serial) {
  EXPECT_EQ(serial_error("ttyUSB0").fault, PortFault::BadName);
  EXPECT_EQ(serial_error("").fault, PortFault::BadName);
  EXPECT_EQ(serial_error("pty:").fault, PortFault::BadName);
  EXPECT_EQ(serial_error("/dev/nothere").fault, PortFault::NoSuchDevice);
  EXPECT_EQ(serial_error("/dev/null").fault, PortFault::NotSerial);
  EXPECT_EQ(serial_error("/dev/null", 19200).fault, PortFault::NoBaudRate);
}

TEST(PortNames, SayBothKinds) {
  for (const PortError& error : {can_error("a/b"), serial_error("ttyUSB0")}) {
    EXPECT_NE(error.text.find("a CAN port is can0"), std::string::npos) << error.text;
    EXPECT_NE(error.text.find("a serial port is /dev/ttyUSB0"), std::string::npos) << error.text;
  }
}

TEST(PortNames, OfBothKinds) {
  for (const char* name : {"/dev/ttyUSB0", "./tty1", "tty/1", "../line@16ms", "pty:line1", "pty:/tmp/line1"})
    EXPECT_EQ(kind_of_port(name), PortKind::Serial) << name;
  for (const char* name : {"can0", "vcan0", "ttyUSB0", "slcan:./tty1", "slcan:pty:line1", ""})
    EXPECT_EQ(kind_of_port(name), PortKind::Can) << name;
}

// Of a device or a link in the current folder.
TEST(PortNames, ByRelativePath) {
  if (!has_pty()) GTEST_SKIP() << kNoPty;
  const TemporaryFolder folder;
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  SystemClock clock;
  for (const char* own : {"pty:line1", "pty:./line1"}) {
    const SerialPortResult line = open_serial_port(own, {9600, true}, clock);
    ASSERT_TRUE(line) << line.error().text;
    EXPECT_TRUE(open_serial_port("./line1", {9600, true}, clock));
    EXPECT_TRUE(open_serial_port("line1@16ms", {9600, true}, clock));
    EXPECT_EQ(kind_of_port("line1"), PortKind::Serial);
  }
  const CanPortResult adapter = open_can_port("slcan:pty:can1", 500'000, clock);
  ASSERT_TRUE(adapter) << adapter.error().text;
  EXPECT_TRUE(open_can_port("slcan:can1", 500'000, clock));
  EXPECT_TRUE(open_can_port("slcan:./can1@115200", 500'000, clock));
  std::filesystem::current_path(before);
}

TEST(PortKey, NeedsRealTime) {
  const TemporaryFolder folder;
  const std::string plant = folder.write("p.toml",
                                         "[[bus]]\nname = \"sbus\"\nkind = \"can\"\nport = \"nocan7\"\n"
                                         "[[station]]\nname = \"a\"\nunit = \"md60a\"\nsbus = \"sbus\"\n");
  const CommandResult virtual_time = run_ipos({"run", plant, "--for", "1ms"});
  EXPECT_EQ(virtual_time.exit_code, 64);
  EXPECT_EQ(virtual_time.err,
            plant +
                ":4:8: error: bus 'sbus' is joined to port 'nocan7': run it with --realtime, as the "
                "world outside does not wait for virtual time\n");
  const CommandResult real_time = run_ipos({"run", plant, "--realtime", "--for", "1ms"});
  EXPECT_EQ(real_time.exit_code, 74);
  EXPECT_TRUE(real_time.err.starts_with(plant + ":4:8: error: nocan7: there is no such network interface"))
      << real_time.err;
}

TEST(PortKey, IsCheckedWhenThePlantIsRead) {
  const TemporaryFolder folder;
  const auto errors = [&](const std::string& buses) {
    return run_ipos({"run", folder.write("p.toml", buses + "[[station]]\nname = \"a\"\nunit = \"md60a\"\n"),
                     "--for", "1ms"})
        .err;
  };
  EXPECT_NE(errors("[[bus]]\nname = \"a\"\nkind = \"can\"\nport = 3\n").find("port must be a text in quotes"),
            std::string::npos);
  EXPECT_NE(errors("[[bus]]\nname = \"a\"\nkind = \"can\"\nport = \"\"\n").find("port must not be empty"),
            std::string::npos);
  EXPECT_NE(errors("[[bus]]\nname = \"a\"\nkind = \"can\"\nport = \"x\"\n"
                   "[[bus]]\nname = \"b\"\nkind = \"can\"\nport = \"x\"\n")
                .find("there are two of port 'x'"),
            std::string::npos);
}

}  // namespace
}  // namespace ipos::tests
