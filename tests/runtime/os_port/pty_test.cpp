// Pseudo-terminals by themselves: what a program finds at the other end, whether one is there, bytes for one that does
// not read, and paths where no link can be made.
#include "runtime/os_port/pty.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>

#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

using namespace ipos::runtime;  // NOLINT: everything here is about the runtime
namespace fs = std::filesystem;

class OwnPty : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_pty()) GTEST_SKIP() << kNoPty;
    auto made = Pty::create(path(), kLimit);
    ASSERT_TRUE(made) << made.error().text;
    pty_.emplace(std::move(*made));
  }
  static constexpr size_t kLimit = 100;
  std::string path(const std::string& name = "line") const { return (folder_.path() / name).string(); }
  Descriptor program() const { return Descriptor(::open(path().c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK)); }

  // What comes from the program, as soon as the system has handed it on.
  std::string take(size_t room = 64) {
    std::string bytes(room, '\0');
    for (int tries = 0; tries < 20'000; ++tries) {
      if (const size_t size = pty_->read(bytes)) return bytes.substr(0, size);
      usleep(500);
    }
    return "";
  }
  // The same for the program; `patience` is for what does not come, in fifths of a millisecond.
  static std::string heard(const Descriptor& program, int patience = 50'000) {
    std::array<char, 256> bytes{};
    for (int tries = 0; tries < patience; ++tries) {
      const ssize_t size = ::read(program.get(), bytes.data(), bytes.size());
      if (size > 0) return std::string(bytes.data(), static_cast<size_t>(size));
      usleep(200);
    }
    return "";
  }
  size_t look() {
    std::array<char, 8> none{};
    return pty_->read(none);
  }

  TemporaryFolder folder_;
  std::optional<Pty> pty_;
};

// --- what a program finds

TEST_F(OwnPty, IsRaw) {
  const Descriptor other = program();
  termios settings{};
  ASSERT_EQ(tcgetattr(other.get(), &settings), 0);
  EXPECT_EQ(settings.c_lflag & (ECHO | ICANON | ISIG), 0U);
  EXPECT_EQ(settings.c_iflag & (ICRNL | IXON), 0U);
  EXPECT_EQ(settings.c_oflag & OPOST, 0U);
  ASSERT_EQ(look(), 0U);
  EXPECT_TRUE(pty_->write("\x03\x04\r\n\x7F"));
  EXPECT_EQ(heard(other), "\x03\x04\r\n\x7F");
}

// The C library refuses parity that a pseudo-terminal has not got when nothing else changes, so something always does:
// each opening with 8E1 goes well.
TEST_F(OwnPty, ProgramsMayAskForParityAgainAndAgain) {
  for (int opening = 0; opening < 4; ++opening) {
    const Descriptor other = program();
    termios settings{};
    ASSERT_EQ(tcgetattr(other.get(), &settings), 0);
    cfmakeraw(&settings);
    cfsetspeed(&settings, B9600);
    settings.c_cflag |= PARENB;
    EXPECT_EQ(tcsetattr(other.get(), TCSANOW, &settings), 0) << opening;
    look();
  }
}

// The speed that nobody asks for is one of two by turns, and comes back when a program has set its own.
TEST_F(OwnPty, ASpeedOfItsOwnComesBack) {
  const Descriptor other = program();
  const auto speed = [&] {
    termios settings{};
    EXPECT_EQ(tcgetattr(other.get(), &settings), 0);
    return cfgetospeed(&settings);
  };
  EXPECT_EQ(speed(), static_cast<speed_t>(B50));
  for (const speed_t mark : {speed_t{B75}, speed_t{B50}, speed_t{B75}}) {
    termios settings{};
    ASSERT_EQ(tcgetattr(other.get(), &settings), 0);
    cfsetspeed(&settings, B57600);
    ASSERT_EQ(tcsetattr(other.get(), TCSANOW, &settings), 0);
    for (int n = 0; n < 2; ++n) {
      look();
      EXPECT_EQ(speed(), mark);
    }
  }
}

// --- whether a program is there

TEST_F(OwnPty, KnowsWhetherAProgramIsThere) {
  const auto expect_absent = [&] {
    EXPECT_FALSE(pty_->is_attached());
    EXPECT_EQ(pty_->absence(), "no program has its other end open");
    EXPECT_EQ(pty_->needs().descriptor, -1) << "the open end would wake the loop without pause";
  };
  expect_absent();
  EXPECT_EQ(look(), 0U);
  expect_absent();
  {
    const Descriptor other = program();
    EXPECT_EQ(look(), 0U);
    EXPECT_TRUE(pty_->is_attached());
    EXPECT_EQ(pty_->absence(), "");
    EXPECT_GE(pty_->needs().descriptor, 0);
    EXPECT_FALSE(pty_->needs().output);
    EXPECT_EQ(look(), 0U);
    EXPECT_TRUE(pty_->is_attached());
  }
  EXPECT_EQ(look(), 0U);
  expect_absent();
  // One that writes and goes: its bytes are read first.
  {
    const Descriptor other = program();
    ASSERT_EQ(::write(other.get(), "abc", 3), 3);
  }
  EXPECT_EQ(take(2), "ab");
  EXPECT_TRUE(pty_->is_attached());
  EXPECT_EQ(take(2), "c");
  EXPECT_EQ(look(), 0U);
  expect_absent();
}

TEST_F(OwnPty, WhatAProgramHasNotReadIsNotForTheNext) {
  const std::string early(kLimit, 'e');
  {
    const Descriptor other = program();
    look();
    while (pty_->write(early)) {
    }
    EXPECT_GT(pty_->waiting().size(), 0U);
    EXPECT_TRUE(pty_->needs().output);
  }
  look();
  EXPECT_EQ(pty_->waiting().size(), 0U);
  EXPECT_FALSE(pty_->needs().output);
  const Descriptor next = program();
  look();
  EXPECT_TRUE(pty_->write("new"));
  EXPECT_EQ(heard(next), "new");
}

// --- bytes for a program

TEST_F(OwnPty, WithoutAProgramBytesGoNowhere) {
  for (int n = 0; n < 3; ++n) EXPECT_TRUE(pty_->write(std::string(kLimit, 'x')));
  EXPECT_EQ(pty_->waiting(), "");
  const Descriptor other = program();
  look();
  EXPECT_EQ(heard(other, 50), "");
}

TEST_F(OwnPty, BytesWaitForAProgramThatDoesNotRead) {
  const Descriptor other = program();
  look();
  size_t sent = 0;
  const std::string part(kLimit, 'p');
  while (pty_->write(part)) sent += part.size();
  EXPECT_FALSE(pty_->write(part)) << "whole messages only";
  const size_t waiting = pty_->waiting().size();
  EXPECT_GT(waiting, 0U);
  EXPECT_LE(waiting, kLimit);
  std::string all;
  for (std::string got; !(got = heard(other, 500)).empty(); pty_->flush()) all += got;
  EXPECT_EQ(all.size(), sent);
  EXPECT_EQ(pty_->waiting(), "");
  EXPECT_TRUE(pty_->write(part));
}

// --- paths

TEST_F(OwnPty, NamesDifferInAnyLetter) {
  const auto mine = Pty::create(path("mine"), kLimit), pine = Pty::create(path("pine"), kLimit);
  EXPECT_TRUE(mine && pine) << "the first letter is of the name";
  const auto a = Pty::create(path("a"), kLimit), b = Pty::create(path("b"), kLimit),
             ab = Pty::create(path("ab"), kLimit);
  EXPECT_TRUE(a && b && ab);
  EXPECT_FALSE(Pty::create(path("ab"), kLimit));
}

TEST_F(OwnPty, WhereNoLinkCanBe) {
  const auto error = [](const std::string& path) {
    const auto made = Pty::create(path, kLimit);
    return made ? std::string("made") : made.error().text;
  };
  EXPECT_EQ(error(""), "pty:: is no name of a port: write pty:/path");
  EXPECT_EQ(error(path("no/line")), path("no/line") + ": is no name of a port: the folder does not exist");
  folder_.write("file", "");
  EXPECT_EQ(error(path("file/line")),
            path("file/line") + ": is no name of a port: the folder does not exist");
  EXPECT_EQ(error(path("file")), path("file") + ": something else is there already");
  EXPECT_EQ(error("/"), "/: something else is there already");
}

// Somebody else's terminal may have the number that a killed run had.
TEST_F(OwnPty, ALinkToATerminalIsLeftOver) {
  const Descriptor master(posix_openpt(O_RDWR | O_NOCTTY));
  ASSERT_TRUE(master.is_open() && grantpt(master.get()) == 0 && unlockpt(master.get()) == 0);
  fs::create_symlink(ptsname(master.get()), path("living"));
  ASSERT_TRUE(fs::exists(path("living")));
  const auto made = Pty::create(path("living"), kLimit);
  ASSERT_TRUE(made) << made.error().text;
  EXPECT_NE(fs::read_symlink(path("living")), fs::path(ptsname(master.get())));
}

TEST_F(OwnPty, AFolderThatCannotBeWrittenIsToldAsThat) {
  fs::create_directory(path("locked"));
  fs::create_symlink("/dev/pts/9999", path("locked/stale"));
  ASSERT_EQ(chmod(folder_.path().c_str(), 0755), 0);
  ASSERT_EQ(chmod(path("locked").c_str(), 0555), 0);
  const uid_t user = geteuid();
  constexpr uid_t kNobody = 65'534;
  ASSERT_EQ(seteuid(user == 0 ? kNobody : user), 0);  // root may write everywhere
  const auto fresh = Pty::create(path("locked/fresh"), kLimit);
  const auto stale = Pty::create(path("locked/stale"), kLimit);
  ASSERT_EQ(seteuid(user), 0);
  ASSERT_EQ(chmod(path("locked").c_str(), 0755), 0);
  ASSERT_FALSE(fresh);
  EXPECT_EQ(fresh.error().fault, PortFault::NoPermission) << fresh.error().text;
  ASSERT_FALSE(stale);
  EXPECT_EQ(stale.error().fault, PortFault::NoPermission) << stale.error().text;
}

}  // namespace
}  // namespace ipos::tests
