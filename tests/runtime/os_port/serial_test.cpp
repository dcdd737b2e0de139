// Serial ports: parity marks, a device (the far end of a pseudo-terminal does as one) and the links of
// pseudo-terminals.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <filesystem>

#include "runtime/os_port/descriptor.hpp"
#include "runtime/os_port/parity_marks.hpp"
#include "runtime/os_port/pty.hpp"
#include "runtime/os_port/serial_port.hpp"
#include "runtime/os_port/system_clock.hpp"
#include "runtime/os_port/tty_rate.hpp"
#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

using namespace ipos::runtime;  // NOLINT: everything here is about the runtime
namespace fs = std::filesystem;

// termios(3), PARMRK: good FF comes as FF FF, a bad byte X as FF 00 X, a break as FF 00 00.
TEST(ParityMarks, AreTakenOut) {
  ParityMarks marks;
  std::vector<std::pair<int, bool>> bytes;
  for (const int raw : {0x02, 0xFF, 0xFF, 0xFF, 0x00, 0x41, 0xFF, 0x00, 0x00, 0xFF, 0x00, 0xFF, 0x00, 0x10})
    if (const auto byte = marks.push(static_cast<uint8_t>(raw))) bytes.emplace_back(byte->value, byte->bad);
  const std::vector<std::pair<int, bool>> expected = {
      {0x02, false}, {0xFF, false}, {0x41, true}, {0x00, true}, {0xFF, true}, {0x00, false}, {0x10, false}};
  EXPECT_EQ(bytes, expected);
}

// What a port receives within a short time.
std::vector<ByteArrival> receive(BytePort& port, size_t wanted) {
  SystemClock clock;
  std::vector<ByteArrival> all;
  const Time end = clock.now() + kSecond;
  while (all.size() < wanted && clock.now() < end) {
    std::array<ByteArrival, 100> part{};
    const auto count = port.receive(part);
    if (!count) {
      ADD_FAILURE() << count.error().text;
      break;
    }
    all.insert(all.end(), part.begin(), part.begin() + static_cast<std::ptrdiff_t>(*count));
    if (*count == 0) clock.wait(clock.now() + kMillisecond, {});
  }
  return all;
}

TEST(SerialDevice, PassesAllBytesWithTheirTimes) {
  if (!has_pty()) GTEST_SKIP() << kNoPty;
  const Descriptor master(posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK));
  ASSERT_TRUE(master.is_open() && grantpt(master.get()) == 0 && unlockpt(master.get()) == 0);
  SystemClock clock;
  const SerialPortResult port = open_serial_port(ptsname(master.get()), {9600, true}, clock);
  ASSERT_TRUE(port) << port.error().text;
  EXPECT_FALSE((*port)->has_parity());  // this driver has none, and it is found out
  const std::vector<std::string> notes = (*port)->take_notes();
  ASSERT_EQ(notes.size(), 3U);
  EXPECT_TRUE(notes[0].starts_with("the device has no parity")) << notes[0];
  EXPECT_TRUE(notes[1].starts_with("the driver does not switch RS-485 direction")) << notes[1];
  EXPECT_TRUE(notes[2].starts_with("the driver has no low-latency flag")) << notes[2];

  std::array<uint8_t, 256> every{};
  for (size_t n = 0; n < every.size(); ++n) every[n] = static_cast<uint8_t>(n);
  ASSERT_EQ(write(master.get(), every.data(), every.size()), 256);
  const std::vector<ByteArrival> got = receive(**port, 256);
  ASSERT_EQ(got.size(), 256U);
  const Time now = clock.now();
  for (size_t n = 0; n < got.size(); ++n) {
    EXPECT_EQ(got[n].value, n);
    EXPECT_FALSE(got[n].bad);
    EXPECT_LE(got[n].at, now);
    EXPECT_GE(got[n].at, got[n - (n > 0 ? 1 : 0)].at);
  }
  // Bytes read together are a character time apart: 11 bits at 9600 baud.
  EXPECT_EQ(got[50].at - got[49].at, 11 * kSecond / 9600);

  (*port)->send(every);
  std::array<uint8_t, 512> out{};
  EXPECT_EQ(read(master.get(), out.data(), out.size()), 256);
  EXPECT_TRUE(std::equal(every.begin(), every.end(), out.begin()));
}

// 93.75 and 187.5 kbaud of PROFIBUS, and the names that termios(3) has. The driver of pseudo-terminals keeps any rate.
TEST(SerialDevice, TakesAnyRate) {
  if (!has_pty()) GTEST_SKIP() << kNoPty;
  const Descriptor master(posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK));
  ASSERT_TRUE(master.is_open() && grantpt(master.get()) == 0 && unlockpt(master.get()) == 0);
  for (const uint32_t baud : {9600U, 93'750U, 187'500U, 500'000U}) {
    SystemClock clock;
    const SerialPortResult port = open_serial_port(ptsname(master.get()), {baud, true, false}, clock);
    EXPECT_TRUE(port) << port.error().text;
    const auto has = set_any_rate(master.get(), baud);
    ASSERT_TRUE(has) << has.error();
    EXPECT_EQ(*has, baud);
  }
  SystemClock clock;
  const SerialPortResult port = open_serial_port(ptsname(master.get()), {5'000'000, true, false}, clock);
  ASSERT_FALSE(port);
  EXPECT_NE(port.error().text.find("the device does not take this baud rate"), std::string::npos) << port.error().text;
}

// A driver may round: 48 MHz / 16 / 32 is exact for 93750, 1.8432 MHz / 16 makes 115200 of it.
TEST(SerialDevice, ARateMayBeOffByAHundredth) {
  EXPECT_TRUE(is_close_rate(187'500, 187'500));
  EXPECT_TRUE(is_close_rate(187'500, 188'000));
  EXPECT_TRUE(is_close_rate(93'750, 93'000));
  EXPECT_FALSE(is_close_rate(93'750, 115'200));
  EXPECT_FALSE(is_close_rate(187'500, 9'600));
}

TEST(SerialDevice, AFileIsNoDeviceForARate) {
  const auto has = set_any_rate(STDIN_FILENO + 1000, 93'750);
  ASSERT_FALSE(has);
  EXPECT_EQ(has.error(), EBADF);
}

TEST(SerialDevice, IsForOneProgramAndIsGivenBackAsItWas) {
  if (!has_pty()) GTEST_SKIP() << kNoPty;
  const Descriptor master(posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK));
  ASSERT_TRUE(master.is_open() && grantpt(master.get()) == 0 && unlockpt(master.get()) == 0);
  SystemClock clock;
  termios before{}, after{};
  ASSERT_EQ(tcgetattr(master.get(), &before), 0);
  {
    const SerialPortResult port = open_serial_port(ptsname(master.get()), {57600, true}, clock);
    ASSERT_TRUE(port);
    ASSERT_EQ(tcgetattr(master.get(), &after), 0);
    EXPECT_EQ(cfgetospeed(&after), static_cast<speed_t>(B57600));
    EXPECT_NE(after.c_iflag & PARMRK, 0U);
    const SerialPortResult second = open_serial_port(ptsname(master.get()), {}, clock);
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().fault, PortFault::InUse);
  }
  ASSERT_EQ(tcgetattr(master.get(), &after), 0);
  EXPECT_EQ(cfgetospeed(&after), cfgetospeed(&before));
  EXPECT_EQ(after.c_iflag, before.c_iflag);
  EXPECT_EQ(after.c_lflag, before.c_lflag);
}

TEST(SerialDevice, ThatGoesIsAnError) {
  if (!has_pty()) GTEST_SKIP() << kNoPty;
  Descriptor master(posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK));
  ASSERT_TRUE(master.is_open() && grantpt(master.get()) == 0 && unlockpt(master.get()) == 0);
  SystemClock clock;
  const SerialPortResult port = open_serial_port(ptsname(master.get()), {}, clock);
  ASSERT_TRUE(port);
  master = Descriptor();
  std::array<ByteArrival, 10> bytes{};
  const auto count = (*port)->receive(bytes);
  ASSERT_FALSE(count);
  EXPECT_EQ(count.error().fault, PortFault::Gone);
}

TEST(PseudoTerminal, SaysOnceThatItHasNoParity) {
  if (!has_pty()) GTEST_SKIP() << kNoPty;
  const TemporaryFolder folder;
  SystemClock clock;
  const SerialPortResult port = open_serial_port("pty:" + (folder.path() / "line1").string(), {}, clock);
  ASSERT_TRUE(port) << port.error().text;
  EXPECT_FALSE((*port)->has_parity());
  EXPECT_EQ((*port)->take_notes(),
            std::vector<std::string>{"a pseudo-terminal has no parity: only the block check is left"});
  EXPECT_TRUE((*port)->take_notes().empty());
}

TEST(PseudoTerminal, SaysWhatItIs) {
  if (!has_pty()) GTEST_SKIP() << kNoPty;
  const TemporaryFolder folder;
  SystemClock clock;
  const std::string path = (folder.path() / "line1").string();
  for (const bool parity : {false, true}) {
    const SerialPortResult opened = open_serial_port("pty:" + path, {9'600, parity}, clock);
    ASSERT_TRUE(opened) << opened.error().text;
    BytePort& port = **opened;
    EXPECT_EQ(port.name(), "pty:" + path);
    EXPECT_FALSE(port.paces()) << "bytes are at the other end at once";
    EXPECT_EQ(port.latency(), 0);
    EXPECT_FALSE(port.has_parity());
    EXPECT_EQ(port.take_notes().size(), parity ? 1U : 0U);
    EXPECT_EQ(port.waiting(), 0U);
  }
}

// Bytes that went out, came in and found no room. Those that come have the time at which they are read.
TEST(PseudoTerminal, CountsItsBytes) {
  if (!has_pty()) GTEST_SKIP() << kNoPty;
  const TemporaryFolder folder;
  SystemClock clock;
  const std::string path = (folder.path() / "line1").string();
  const SerialPortResult opened = open_serial_port("pty:" + path, {9'600, false}, clock);
  ASSERT_TRUE(opened) << opened.error().text;
  BytePort& port = **opened;
  const Descriptor program(open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK));
  std::array<ByteArrival, 2> part{};
  ASSERT_EQ(port.receive(part), 0U);
  ASSERT_EQ(write(program.get(), "abc", 3), 3);
  const Time before = clock.now();
  const std::vector<ByteArrival> got = receive(port, 3);
  ASSERT_EQ(got.size(), 3U);
  for (size_t n = 0; n < 3; ++n) {
    EXPECT_EQ(got[n].value, 'a' + n);
    EXPECT_FALSE(got[n].bad);
    EXPECT_GE(got[n].at, before);
    EXPECT_LE(got[n].at, clock.now());
  }
  const std::array<uint8_t, 5> bytes{1, 2, 3, 4, 5};
  port.send(bytes);
  const PortCounts& counts = port.counts();
  EXPECT_EQ(std::tuple(counts.received, counts.sent, counts.lost_out), std::tuple(3U, 5U, 0U));
  EXPECT_TRUE(port.take_notes().empty());
  const std::vector<uint8_t> much(1'000, 'x');
  uint64_t tried = 5;
  for (; counts.lost_out == 0 && tried < 1'000'000; tried += much.size()) port.send(much);
  EXPECT_EQ(counts.lost_out, much.size());
  EXPECT_EQ(counts.sent + counts.lost_out, tried);
  EXPECT_GT(port.waiting(), kSerialPortQueue - much.size());
  EXPECT_EQ(port.take_notes(),
            std::vector<std::string>{"bytes are lost: the program at the other end does not read them"});
}

TEST(PseudoTerminal, LinkComesAndGoes) {
  if (!has_pty()) GTEST_SKIP() << kNoPty;
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "line1";
  {
    const auto pty = Pty::create(path.string(), 100);
    ASSERT_TRUE(pty) << pty.error().text;
    EXPECT_TRUE(fs::is_symlink(path));
    EXPECT_TRUE(fs::read_symlink(path).string().starts_with("/dev/pts/"));
  }
  EXPECT_FALSE(fs::exists(fs::symlink_status(path)));
}

// However the path is written, and also for the other kind of port; what the first one has is not touched.
TEST(PseudoTerminal, APathIsForOneRun) {
  if (!has_pty()) GTEST_SKIP() << kNoPty;
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "line1";
  fs::create_directory_symlink(folder.path(), folder.path() / "same");
  SystemClock clock;
  {
    const auto pty = Pty::create(path.string(), 100);
    ASSERT_TRUE(pty) << pty.error().text;
    const fs::path target = fs::read_symlink(path);
    const std::string relative = path.lexically_relative(fs::current_path()).string();
    for (const std::string& again : {path.string(), (folder.path() / "." / "line1").string(),
                                     (folder.path() / "same" / "line1").string(), relative}) {
      const auto second = Pty::create(again, 100);
      ASSERT_FALSE(second) << again;
      EXPECT_EQ(second.error().fault, PortFault::InUse);
      EXPECT_EQ(second.error().text,
                again + ": is in use by another program: another run of ipos has made its link there");
    }
    EXPECT_EQ(fs::read_symlink(path), target);
    EXPECT_TRUE(Pty::create((folder.path() / "line2").string(), 100)) << "another name in the same folder";
  }
  EXPECT_TRUE(Pty::create(path.string(), 100)) << "free again";
}

// A run that is killed removes nothing. The number of its pseudo-terminal may be somebody else's by now.
TEST(PseudoTerminal, TheLinkOfAKilledRunIsReplaced) {
  if (!has_pty()) GTEST_SKIP() << kNoPty;
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "line1";
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe(ends.data()), 0);
  const pid_t child = fork();
  if (child == 0) {
    const auto pty = Pty::create(path.string(), 100);
    const char made = pty ? 'y' : 'n';
    (void)!write(ends[1], &made, 1);
    for (;;) pause();
  }
  char made = 0;
  ASSERT_EQ(read(ends[0], &made, 1), 1);
  EXPECT_EQ(made, 'y');
  EXPECT_FALSE(Pty::create(path.string(), 100)) << "it lives";
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  EXPECT_TRUE(fs::is_symlink(path));
  const auto pty = Pty::create(path.string(), 100);
  EXPECT_TRUE(pty) << pty.error().text;
  close(ends[0]);
  close(ends[1]);
}

TEST(PseudoTerminal, ALinkLeftOverIsReplacedAndNothingElse) {
  if (!has_pty()) GTEST_SKIP() << kNoPty;
  const TemporaryFolder folder;
  const fs::path stale = folder.path() / "stale", file = folder.path() / "file",
                 link = folder.path() / "link";
  fs::create_symlink("/dev/pts/9999", stale);
  EXPECT_TRUE(Pty::create(stale.string(), 100));
  fs::create_symlink("/nowhere", stale);
  EXPECT_TRUE(Pty::create(stale.string(), 100));
  folder.write("file", "precious");
  fs::create_symlink(file, link);
  for (const fs::path& taken : {file, link, folder.path()}) {
    const auto refused = Pty::create(taken.string(), 100);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().fault, PortFault::PathTaken) << taken;
  }
  EXPECT_EQ(read_text(file), "precious");
  const auto nowhere = Pty::create((folder.path() / "no" / "line").string(), 100);
  ASSERT_FALSE(nowhere);
  EXPECT_EQ(nowhere.error().fault, PortFault::BadName);
}

// Somebody else's link of the same name is not ours to remove.
TEST(PseudoTerminal, LeavesALinkThatIsNoLongerItsOwn) {
  if (!has_pty()) GTEST_SKIP() << kNoPty;
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "line1";
  {
    const auto pty = Pty::create(path.string(), 100);
    ASSERT_TRUE(pty);
    fs::remove(path);
    fs::create_symlink("/dev/null", path);
  }
  EXPECT_TRUE(fs::is_symlink(path));
}

TEST(PseudoTerminal, BytesForNobodyAreGone) {
  if (!has_pty()) GTEST_SKIP() << kNoPty;
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "line1").string();
  SystemClock clock;
  const SerialPortResult port = open_serial_port("pty:" + path, {}, clock);
  ASSERT_TRUE(port);
  const std::array<uint8_t, 3> early{1, 2, 3}, later{4, 5, 6};
  std::array<ByteArrival, 10> none{};
  ASSERT_TRUE((*port)->receive(none));
  EXPECT_EQ((*port)->needs().descriptor, -1);
  (*port)->send(early);
  const Descriptor program(open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK));
  ASSERT_TRUE((*port)->receive(none));
  EXPECT_GE((*port)->needs().descriptor, 0);
  (*port)->send(later);
  std::array<uint8_t, 10> got{};
  EXPECT_EQ(read(program.get(), got.data(), got.size()), 3);
  EXPECT_EQ(got[0], 4);
}

}  // namespace
}  // namespace ipos::tests
