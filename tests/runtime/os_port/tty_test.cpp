// How a serial device is opened: its settings, its rate, what the driver can and cannot do, and what is given back at
// the end (termios(3), ioctl_tty(2), Documentation/driver-api/serial/serial-rs485.rst of Linux). The device is the far
// end of a pseudo-terminal, and the test answers for its driver where that has no such thing.
#include "runtime/os_port/tty.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/serial.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "runtime/os_port/descriptor.hpp"
#include "runtime/os_port/serial_port.hpp"
#include "tests/runtime/os_port/kernel_in_memory.hpp"
#include "tests/runtime/os_port/port_rig.hpp"
#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

using TtyNotes = std::vector<std::string>;
constexpr const char* kNoParity = "the device has no parity: neither sends it nor sees its errors";
constexpr const char* kNoDirection = "the driver does not switch RS-485 direction: the adapter has to do it";
constexpr const char* kNoLowLatency = "the driver has no low-latency flag: bytes may come late and in groups";

// struct termios2 of asm/termbits.h, which <termios.h> excludes.
struct AnyRate {
  uint32_t input, output, control, local;
  uint8_t line, characters[19];
  uint32_t input_rate, output_rate;
};
constexpr uint32_t kOwnRate = 0x1000;                         // BOTHER
constexpr uint32_t kRateBits = 0x100F, kInputRateShift = 16;  // CBAUD, IBSHIFT

// The driver of a serial device: it keeps what it is told.
struct Driver {
  serial_rs485 direction{};
  serial_struct serial{};
  AnyRate rate{};
  uint32_t makes_of_it = 0;  // rate; 0: what is wanted
  int rs485_error = 0, serial_error = 0, set_serial_error = 0, rate_error = 0, set_rate_error = 0,
      alone_error = 0;
  int rs485_asked = 0, set_serial_asked = 0, rate_asked = 0, alone = 0;

  std::optional<int> answer(unsigned long request, void* argument) {
    constexpr unsigned long kGetRate = 0x802C542A, kSetRate = 0x402C542B;  // TCGETS2, TCSETS2
    switch (request) {
      case TIOCSRS485: ++rs485_asked; return put(rs485_error, direction, argument);
      case TIOCGSERIAL: return get(serial_error, serial, argument);
      case TIOCSSERIAL: ++set_serial_asked; return put(set_serial_error, serial, argument);
      case kGetRate: return get(rate_error, rate, argument);
      case kSetRate:
        ++rate_asked;
        if (const int error = put(set_rate_error, rate, argument); error != 0) return error;
        if (makes_of_it != 0) rate.output_rate = makes_of_it;
        return 0;
      case TIOCEXCL: alone += alone_error == 0 ? 1 : 0; return alone_error;
      case TIOCNXCL: --alone; return 0;
      default: return std::nullopt;
    }
  }

 private:
  template <typename Value>
  static int put(int error, Value& value, const void* argument) {
    if (error == 0) std::memcpy(&value, argument, sizeof value);
    return error;
  }
  template <typename Value>
  static int get(int error, const Value& value, void* argument) {
    if (error == 0) std::memcpy(argument, &value, sizeof value);
    return error;
  }
};

class OpenTty : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_pty()) GTEST_SKIP() << kNoPty;
    master_ = Descriptor(posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK));
    ASSERT_TRUE(master_.is_open() && grantpt(master_.get()) == 0 && unlockpt(master_.get()) == 0);
    path_ = ptsname(master_.get());
    kernel_.driver = [this](unsigned long request, void* argument) {
      return driver_.answer(request, argument);
    };
  }
  tl::expected<Tty, PortError> open(const TtySettings& settings) {
    return Tty::open(path_, settings, notes_);
  }
  std::string error(const TtySettings& settings) {
    const auto tty = open(settings);
    EXPECT_FALSE(tty);
    return tty ? std::string() : tty.error().text;
  }
  termios settings() const {
    termios now{};
    EXPECT_EQ(tcgetattr(master_.get(), &now), 0);
    return now;
  }
  void be_a_device() { kernel_.major = 4; }  // as /dev/ttyS0 is; a pseudo-terminal has 136 to 143

  KernelInMemory kernel_;
  Driver driver_;
  Descriptor master_;
  std::string path_;
  PortNotes notes_;
};

// --- settings

TEST_F(OpenTty, IsRawWithEightBitsAndOneStopBit) {
  termios strange = settings();
  strange.c_cflag |= CSTOPB | CRTSCTS | PARODD;
  strange.c_cflag &= ~static_cast<tcflag_t>(CLOCAL);
  strange.c_iflag |= IXON | IXOFF | IXANY | IGNPAR | ICRNL | ISTRIP;
  strange.c_lflag |= ECHO | ICANON | ISIG;
  strange.c_oflag |= OPOST;
  ASSERT_EQ(tcsetattr(master_.get(), TCSANOW, &strange), 0);
  const termios before = settings();
  for (const bool parity : {false, true}) {
    {
      const auto tty = open({57'600, parity});
      ASSERT_TRUE(tty) << tty.error().text;
      const termios now = settings();
      EXPECT_EQ(now.c_cflag & (CSTOPB | PARODD | CRTSCTS | PARENB), 0U);
      EXPECT_EQ(now.c_cflag & CSIZE, static_cast<tcflag_t>(CS8));
      EXPECT_EQ(now.c_cflag & (CREAD | CLOCAL), static_cast<tcflag_t>(CREAD | CLOCAL));
      EXPECT_EQ(now.c_iflag & (IXON | IXOFF | IXANY | IGNPAR | ICRNL | ISTRIP), 0U);
      EXPECT_EQ(now.c_iflag & (INPCK | PARMRK), parity ? static_cast<tcflag_t>(INPCK | PARMRK) : 0U);
      EXPECT_EQ(now.c_lflag & (ECHO | ICANON | ISIG), 0U);
      EXPECT_EQ(now.c_oflag & OPOST, 0U);
      EXPECT_EQ(cfgetispeed(&now), static_cast<speed_t>(B57600));
      EXPECT_EQ(tty->marks_errors(), parity);
      EXPECT_FALSE(tty->has_parity());
      EXPECT_EQ(driver_.alone, 1) << "no other program";
    }
    const termios after = settings();
    EXPECT_EQ(
        std::tuple(after.c_cflag, after.c_iflag, after.c_lflag, after.c_oflag, cfgetospeed(&after)),
        std::tuple(before.c_cflag, before.c_iflag, before.c_lflag, before.c_oflag, cfgetospeed(&before)));
    EXPECT_EQ(driver_.alone, 0);
  }
}

// A pseudo-terminal is not asked for parity, which it would refuse; a device is, and what it has then is found out.
TEST_F(OpenTty, ParityIsThatOfTheDevice) {
  bool wants = false, has = true;
  kernel_.set = [&](termios& wanted) -> std::optional<int> {
    wants = (wanted.c_cflag & PARENB) != 0;
    wanted.c_cflag &= ~static_cast<tcflag_t>(PARENB);
    return std::nullopt;
  };
  kernel_.got = [&](termios& got) {
    if (wants && has) got.c_cflag |= PARENB;
  };
  for (const unsigned number : {4U, 135U, 136U, 140U, 143U, 144U, 188U}) {
    const bool pseudo =
        number >= 136 && number <= 143;  // Documentation/admin-guide/devices.txt: Unix98 PTY slaves
    kernel_.major = number;
    const auto tty = open({9'600, true});
    ASSERT_TRUE(tty) << number;
    EXPECT_EQ(wants, !pseudo) << number;
    EXPECT_EQ(tty->has_parity(), !pseudo) << number;
  }
  EXPECT_EQ(notes_.take(), TtyNotes{kNoParity}) << "of the pseudo-terminals, once";
  has = false;
  be_a_device();
  PortNotes other;
  const auto tty = Tty::open(path_, {9'600, true}, other);
  ASSERT_TRUE(tty);
  EXPECT_FALSE(tty->has_parity());
  EXPECT_EQ(other.take(), TtyNotes{kNoParity});
}

TEST_F(OpenTty, WithoutParityNothingIsSaidOfIt) {
  be_a_device();
  ASSERT_TRUE(open({9'600, false}));
  EXPECT_EQ(notes_.take(), TtyNotes{});
}

// --- what the driver can

TEST_F(OpenTty, TheDriverSwitchesTheDirectionIfItCan) {
  ASSERT_TRUE(open({9'600, false, false}));
  EXPECT_EQ(driver_.rs485_asked, 0) << "only where it is wanted";
  ASSERT_TRUE(open({9'600, false, true}));
  EXPECT_EQ(driver_.rs485_asked, 1);
  EXPECT_EQ(driver_.direction.flags, static_cast<uint32_t>(SER_RS485_ENABLED | SER_RS485_RTS_ON_SEND));
  EXPECT_EQ(notes_.take(), TtyNotes{});
  driver_.rs485_error = ENOTTY;
  ASSERT_TRUE(open({9'600, false, true}));
  EXPECT_EQ(notes_.take(), TtyNotes{kNoDirection});
}

TEST_F(OpenTty, BytesAreWantedAtOnce) {
  driver_.serial.flags = ASYNC_SPD_CUST;
  driver_.serial.baud_base = 115'200;
  ASSERT_TRUE(open({}));
  EXPECT_EQ(driver_.serial.flags, ASYNC_SPD_CUST | ASYNC_LOW_LATENCY);
  EXPECT_EQ(driver_.serial.baud_base, 115'200) << "and nothing else is changed";
  EXPECT_EQ(notes_.take(), TtyNotes{});
  driver_.set_serial_error = EPERM;
  ASSERT_TRUE(open({}));
  EXPECT_EQ(notes_.take(), TtyNotes{kNoLowLatency});
  driver_.set_serial_error = 0;
  driver_.set_serial_asked = 0;
  driver_.serial_error = ENOTTY;
  PortNotes other;
  ASSERT_TRUE(Tty::open(path_, {}, other));
  EXPECT_EQ(other.take(), TtyNotes{kNoLowLatency});
  EXPECT_EQ(driver_.set_serial_asked, 0) << "what has not been read is not written";
}

// --- rates

TEST_F(OpenTty, RatesWithANameHaveTheirCode) {
  const std::pair<uint32_t, speed_t> rates[] = {
      {9'600, B9600},       {19'200, B19200},      {38'400, B38400},      {57'600, B57600},
      {115'200, B115200},   {230'400, B230400},    {460'800, B460800},    {500'000, B500000},
      {921'600, B921600},   {1'000'000, B1000000}, {1'500'000, B1500000}, {2'000'000, B2000000},
      {3'000'000, B3000000}};
  be_a_device();
  for (const auto& [baud, code] : rates) {
    const auto tty = open({baud});
    ASSERT_TRUE(tty) << baud;
    const termios now = settings();
    EXPECT_EQ(cfgetospeed(&now), code) << baud;
    EXPECT_EQ(driver_.rate_asked, 0) << baud << " has a name";
  }
}

// From 9600 to 4000000 bit/s, and any rate between those that have names.
TEST_F(OpenTty, OtherRatesAreAskedOfTheDriver) {
  be_a_device();
  driver_.rate.control = 0x0000000F | 0x0F << kInputRateShift | CS8;
  driver_.rate.input = 0x5A;
  for (const uint32_t baud : {9'601U, 93'750U, 187'500U, 4'000'000U}) {
    driver_.rate_asked = 0;
    ASSERT_TRUE(open({baud})) << baud;
    EXPECT_EQ(driver_.rate_asked, 1) << baud;
    EXPECT_EQ(driver_.rate.output_rate, baud);
    EXPECT_EQ(driver_.rate.input_rate, baud);
    EXPECT_EQ(driver_.rate.control & kRateBits, kOwnRate);
    EXPECT_EQ(driver_.rate.control >> kInputRateShift & kRateBits, kOwnRate);
    EXPECT_EQ(driver_.rate.control & CSIZE, static_cast<tcflag_t>(CS8)) << "the other settings stay";
    EXPECT_EQ(driver_.rate.input, 0x5AU);
  }
  for (const uint32_t baud : {0U, 9'599U, 4'000'001U})
    EXPECT_EQ(error({baud}),
              path_ + ": the device does not take this baud rate: " + std::to_string(baud) + " bit/s");
  kernel_.major.reset();
  driver_.rate_asked = 0;
  ASSERT_TRUE(open({93'750}));
  EXPECT_EQ(driver_.rate_asked, 0) << "a pseudo-terminal has none";
}

// Both ends bear a rate that is 1 % off.
TEST_F(OpenTty, ADriverMayRoundARateALittle) {
  be_a_device();
  const std::string refused = path_ + ": the device does not take this baud rate: 187500 bit/s";
  for (const uint32_t near : {185'625U, 187'500U, 189'375U}) {
    driver_.makes_of_it = near;
    EXPECT_TRUE(open({187'500})) << near;
  }
  for (const uint32_t far : {9'600U, 185'624U, 189'376U}) {
    driver_.makes_of_it = far;
    EXPECT_EQ(error({187'500}), refused + ": it makes " + std::to_string(far) +
                                    " of it; an adapter with another clock is needed");
  }
  driver_.makes_of_it = 0;
  for (int* const fails : {&driver_.rate_error, &driver_.set_rate_error}) {
    *fails = ENOTTY;
    EXPECT_EQ(error({187'500}), refused + ": the driver has only the rates of termios");
    *fails = 0;
  }
}

// A driver that keeps its own rate says no error, so the rate is read back. That of a pseudo-terminal means nothing.
TEST_F(OpenTty, ADriverThatKeepsItsRateIsRefused) {
  kernel_.got = [](termios& got) { cfsetospeed(&got, B38400); };
  EXPECT_TRUE(open({57'600}));
  be_a_device();
  EXPECT_EQ(error({57'600}), path_ + ": the device does not take this baud rate: 57600 bit/s");
  EXPECT_TRUE(open({38'400}));
}

// --- errors

TEST_F(OpenTty, WhatTheDriverRefusesIsSaid) {
  int calls = 0;
  kernel_.set = [&](termios&) -> std::optional<int> {
    return ++calls == 1 ? std::optional(EINVAL) : std::nullopt;
  };
  EXPECT_EQ(error({}), system_error(EINVAL, path_).text);
  EXPECT_EQ(driver_.alone, 0);
  kernel_.set = nullptr;
  driver_.alone_error = EIO;
  EXPECT_EQ(error({}), system_error(EIO, path_).text);
}

TEST_F(OpenTty, OnlyOneProgramHasIt) {
  const auto first = open({});
  ASSERT_TRUE(first);
  EXPECT_EQ(error({}), path_ + ": is in use by another program");
}

TEST_F(OpenTty, WithoutPermissionTheGroupIsAskedFor) {
  const TemporaryFolder folder;
  const std::string path = folder.write("device", "");
  ASSERT_EQ(chmod(path.c_str(), 0), 0);
  const uid_t user = geteuid();
  constexpr uid_t kNobody = 65'534;
  ASSERT_EQ(seteuid(user == 0 ? kNobody : user), 0);  // root may read everything
  const auto tty = Tty::open(path, {}, notes_);
  ASSERT_EQ(seteuid(user), 0);
  ASSERT_FALSE(tty);
  EXPECT_EQ(tty.error().text, path + ": permission denied: is your user in group dialout?");
}

TEST_F(OpenTty, WhatCameBeforeIsNobodys) {
  ASSERT_EQ(write(master_.get(), "old\n", 4), 4);
  auto tty = open({});
  ASSERT_TRUE(tty);
  ASSERT_EQ(write(master_.get(), "new\n", 4), 4);
  std::array<char, 16> bytes{};
  size_t size = 0;
  for (int tries = 0; tries < 10'000 && size == 0; ++tries) {
    size = tty->read(bytes).value_or(0);
    if (size == 0) usleep(1'000);
  }
  EXPECT_EQ(std::string(bytes.data(), size), "new\n");
}

// --- the port of a device

class TtyPort : public OpenTty {
 protected:
  std::unique_ptr<BytePort> port(const SerialSettings& settings = {}, const std::string& latency = "") {
    SerialPortResult opened = open_serial_port(path_ + latency, settings, clock_);
    EXPECT_TRUE(opened) << (opened ? "" : opened.error().text);
    return opened ? std::move(*opened) : nullptr;
  }
  // As soon as the system has handed them on.
  static size_t receive(BytePort& port, std::span<ByteArrival> into) {
    for (int tries = 0; tries < 20'000; ++tries) {
      const auto count = port.receive(into);
      if (!count || *count != 0) return count.value_or(0);
      usleep(500);
    }
    return 0;
  }
  // What has been written to the device is there as a whole.
  void arrive(BytePort& port, const std::string& bytes) {
    ASSERT_EQ(write(master_.get(), bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
    int there = 0;
    for (int tries = 0; tries < 20'000 && there < static_cast<int>(bytes.size()); ++tries) {
      ASSERT_EQ(ioctl(port.needs().descriptor, FIONREAD, &there), 0);
      usleep(500);
    }
    ASSERT_EQ(there, static_cast<int>(bytes.size())) << "not all bytes are at the device after ten seconds";
  }
  ManualClock clock_;
};

TEST_F(TtyPort, SaysWhatItIs) {
  const auto device = port({}, "@16ms");
  EXPECT_EQ(device->name(), path_ + "@16ms");
  EXPECT_EQ(device->latency(), 16 * kMillisecond);
  EXPECT_TRUE(device->paces());
  EXPECT_EQ(device->waiting(), 0U);
  EXPECT_GE(device->needs().descriptor, 0);
  EXPECT_FALSE(device->needs().output);
  EXPECT_EQ(device->needs().wake, kNever);
  EXPECT_EQ(driver_.rs485_asked, 1) << "a line of RS-485";
  EXPECT_EQ(device->take_notes(), TtyNotes{kNoParity});
  EXPECT_EQ(device->take_notes(), TtyNotes{});
}

// Start bit, 8 data bits, parity bit and stop bit; the last byte of a reading has just come.
TEST_F(TtyPort, BytesReadTogetherAreACharacterApart) {
  for (const bool parity : {true, false}) {
    const auto device = port({9'600, parity});
    arrive(*device, "abcde");
    std::array<ByteArrival, 4> into{};
    ASSERT_EQ(receive(*device, into), 4U) << "as many as are asked for";
    const Time character = (parity ? 11 : 10) * kSecond / 9'600;
    for (size_t n = 0; n < 4; ++n) {
      EXPECT_EQ(into[n].at, clock_.now() - static_cast<Time>(3 - n) * character);
      EXPECT_EQ(into[n].value, 'a' + n);
    }
    // At the same moment: none is older than what was there.
    ASSERT_EQ(write(master_.get(), "fg", 2), 2);
    std::string rest;
    while (rest.size() < 3) {
      const size_t count = receive(*device, into);
      ASSERT_GT(count, 0U);
      for (size_t n = 0; n < count; ++n) {
        rest += static_cast<char>(into[n].value);
        EXPECT_EQ(into[n].at, clock_.now());
      }
    }
    EXPECT_EQ(rest, "efg");
    EXPECT_EQ(device->counts().received, 7U);
    clock_.advance(kSecond);
  }
}

// What the device does not take waits, and what finds no room is lost as a whole, counted and told once.
TEST_F(TtyPort, BytesWaitForASlowDevice) {
  const auto device = port();
  device->take_notes();
  const std::vector<uint8_t> part(1'000, 'x');
  uint64_t sent = 0;
  while (device->counts().lost_out == 0 && sent < 1'000'000) {
    device->send(part);
    sent += part.size();
  }
  const PortCounts& counts = device->counts();
  EXPECT_EQ(counts.lost_out, part.size());
  EXPECT_EQ(counts.sent, sent - part.size());
  EXPECT_GT(device->waiting(), kSerialPortQueue - part.size());
  EXPECT_LE(device->waiting(), kSerialPortQueue);
  EXPECT_TRUE(device->needs().output);
  EXPECT_GT(counts.waited, 0U);
  const uint64_t waited = counts.waited;
  ASSERT_TRUE(device->flush());
  EXPECT_EQ(counts.waited, waited + 1);
  device->send(part);
  EXPECT_EQ(counts.lost_out, 2 * part.size());
  EXPECT_EQ(device->take_notes(),
            TtyNotes{"bytes are lost: the device does not send them as fast as they come"});
  std::string all;
  std::array<char, 4'096> buffer{};
  for (int tries = 0; tries < 1'000 && all.size() < counts.sent; ++tries) {
    const ssize_t size = read(master_.get(), buffer.data(), buffer.size());
    if (size > 0) all.append(buffer.data(), static_cast<size_t>(size));
    ASSERT_TRUE(device->flush());
  }
  EXPECT_EQ(all.size(), counts.sent);
  EXPECT_EQ(device->waiting(), 0U);
  EXPECT_FALSE(device->needs().output);
  const uint64_t before = counts.waited;
  ASSERT_TRUE(device->flush());
  EXPECT_EQ(counts.waited, before) << "nothing waits";
}

TEST_F(TtyPort, ADeviceThatHasGoneIsAnErrorOfItsNextFlush) {
  const auto device = port();
  master_ = Descriptor();
  const std::array<uint8_t, 2> bytes{1, 2};
  device->send(bytes);
  const auto flushed = device->flush();
  ASSERT_FALSE(flushed);
  EXPECT_EQ(flushed.error().fault, PortFault::Gone);
}

}  // namespace
}  // namespace ipos::tests
