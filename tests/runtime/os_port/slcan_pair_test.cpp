// Both ends of slcan on one pseudo-terminal, and the adapter's end against a program that does everything
// wrong.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

#include <cstdlib>
#include <random>

#include "runtime/os_port/descriptor.hpp"
#include "runtime/os_port/slcan_text.hpp"
#include "runtime/os_port/system_clock.hpp"
#include "tests/runtime/os_port/port_rig.hpp"
#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

class SlcanPair : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_pty()) GTEST_SKIP() << kNoPty;
  }
  std::unique_ptr<CanPort> open(const std::string& name, uint32_t baud = 500'000) {
    CanPortResult port = open_can_port(name, baud, clock_);
    EXPECT_TRUE(port) << (port ? "" : port.error().text);
    return port ? std::move(*port) : nullptr;
  }
  std::string path() const { return (folder_.path() / "can").string(); }

  // What `port` receives, until there are as many frames or for some time.
  std::vector<Frame> receive(CanPort& port, size_t wanted, CanPort* other = nullptr) {
    std::vector<Frame> frames;
    const Time end = clock_.now() + (wanted == 0 ? 100 * kMillisecond : 2 * kSecond);
    while ((frames.size() < wanted || wanted == 0) && clock_.now() < end) {
      if (other != nullptr) {
        EXPECT_TRUE(other->receive());
        EXPECT_TRUE(other->flush());
      }
      auto got = port.receive();
      if (!got) {
        ADD_FAILURE() << got.error().text;
        break;
      }
      if (*got)
        frames.push_back((*got)->frame);
      else
        clock_.wait(clock_.now() + kMillisecond, {});
    }
    return frames;
  }

  TemporaryFolder folder_;
  SystemClock clock_;
};

TEST_F(SlcanPair, FramesGoBothWays) {
  const auto adapter = open("slcan:pty:" + path());
  const auto client = open("slcan:" + path());
  Frame extended = frame(0x12345678, 1);
  extended.extended = true;
  Frame remote;
  remote.id = 5;
  remote.length = 8;
  remote.remote = true;
  const std::vector<Frame> frames = {frame(1, 0xFF), extended, remote, frame(0x7FF, 7)};
  for (const Frame& sent : frames) client->send(sent);
  EXPECT_EQ(receive(*adapter, frames.size()), frames);
  for (const Frame& sent : frames) adapter->send(sent);
  EXPECT_EQ(receive(*client, frames.size()), frames);
  EXPECT_TRUE(client->take_notes().size() <= 1U);  // the low-latency flag
  EXPECT_TRUE(adapter->take_notes().empty());
  EXPECT_EQ(adapter->counts().lost_in + adapter->counts().lost_out, 0U);
}

TEST_F(SlcanPair, TimeStampsOfTheAdapterGoOn) {
  const auto adapter = open("slcan:pty:" + path());
  const auto client = open("slcan:" + path());
  ASSERT_TRUE(adapter->receive());  // the opening commands are done
  adapter->send(frame(1));
  clock_.wait(clock_.now() + 50 * kMillisecond, {});
  adapter->send(frame(2));
  std::vector<Time> times;
  for (int n = 0; n < 1000 && times.size() < 2; ++n) {
    const auto got = client->receive();
    ASSERT_TRUE(got);
    if (*got) {
      ASSERT_TRUE((*got)->device_time);
      times.push_back(*(*got)->device_time);
    } else {
      clock_.wait(clock_.now() + kMillisecond, {});
    }
  }
  ASSERT_EQ(times.size(), 2U);
  const Time gap = (times[1] - times[0] + 60 * kSecond) % (60 * kSecond);
  EXPECT_GE(gap, 49 * kMillisecond);
  EXPECT_LT(gap, kSecond);
}

TEST_F(SlcanPair, AnotherBitRateIsRefusedAndTold) {
  const auto adapter = open("slcan:pty:" + path(), 500'000);
  const auto client = open("slcan:" + path(), 250'000);
  EXPECT_TRUE(receive(*client, 0, adapter.get()).empty());
  EXPECT_EQ(
      adapter->take_notes(),
      std::vector<std::string>{"refused to open: the program asks for 250000 bit/s, the bus has 500000"});
  const std::vector<std::string> notes = client->take_notes();
  ASSERT_FALSE(notes.empty());
  EXPECT_EQ(notes.back(), "the adapter refuses open (O)");
}

// A program at the adapter's end, byte by byte.
class SlcanAdapterCommands : public SlcanPair {
 protected:
  void SetUp() override {
    if (!has_pty()) GTEST_SKIP() << kNoPty;
    adapter_ = open("slcan:pty:" + path());
    attach();
  }
  void attach() {
    program_ = Descriptor(::open(path().c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK));
    ASSERT_TRUE(program_.is_open());
  }
  // The answer to what a program writes; frames go to `got_`. The system hands on what is written a little
  // later, now and then in two pieces: each line has an answer that ends in CR or BEL, which is waited for.
  std::string talk(const std::string& text) {
    EXPECT_EQ(::write(program_.get(), text.data(), text.size()), static_cast<ssize_t>(text.size()));
    const auto lines = std::count(text.begin(), text.end(), '\r');
    std::string answer;
    for (int waits = 0;; ++waits) {
      take_frames();
      answer += heard();
      const auto ends =
          std::count_if(answer.begin(), answer.end(), [](char c) { return c == '\r' || c == '\a'; });
      if (ends >= lines || waits == 20) return answer;
      ::poll(nullptr, 0, 5);
    }
  }
  void take_frames() {
    for (;;) {
      auto got = adapter_->receive();
      EXPECT_TRUE(got);
      if (!got || !*got) return;
      got_.push_back((*got)->frame);
    }
  }
  std::string heard() {
    EXPECT_TRUE(adapter_->flush());
    std::array<char, 4096> buffer{};
    const ssize_t size = ::read(program_.get(), buffer.data(), buffer.size());
    return size > 0 ? std::string(buffer.data(), static_cast<size_t>(size)) : std::string();
  }

  std::unique_ptr<CanPort> adapter_;
  Descriptor program_;
  std::vector<Frame> got_;
};

TEST_F(SlcanAdapterCommands, AnswersOfTheProtocol) {
  EXPECT_EQ(talk("C\r"), "\r");
  EXPECT_EQ(talk("\r\r"), "\r\r");
  EXPECT_EQ(talk("V\r"), "V0101\r");
  EXPECT_EQ(talk("N\r"), "NIPOS\r");
  EXPECT_EQ(talk("t1000\r"), "\a");  // the channel is closed
  EXPECT_EQ(talk("F\r"), "\a");
  EXPECT_EQ(talk("S9\r"), "\a");
  EXPECT_EQ(talk("S6\r"), "\r");
  EXPECT_EQ(talk("Z1\r"), "\r");
  EXPECT_EQ(talk("M00000000\r"), "\a");  // filters are not there: never silently ignored
  EXPECT_EQ(talk("X0\r"), "\a");
  EXPECT_EQ(talk("X1\r"), "\r");
  EXPECT_EQ(talk("O\r"), "\r");
  EXPECT_EQ(talk("O\r"), "\a");
  EXPECT_EQ(talk("S6\r"), "\a");  // not while it is open
  EXPECT_EQ(talk("F\r"), "F00\r");
  EXPECT_EQ(talk("t1001FF\r"), "z\r");
  EXPECT_EQ(talk("T000001000\r"), "Z\r");
  EXPECT_EQ(talk("t1002FF\r"), "\a");
  EXPECT_EQ(got_, (std::vector<Frame>{frame(0x100, 0xFF), {0x100, 0, {}, true, false}}));
  adapter_->send(frame(0x123, 0xAB));
  const std::string stamped = heard();
  EXPECT_EQ(stamped.substr(0, 7), "t1231AB");
  EXPECT_EQ(stamped.size(), 12U);  // four digits of stamp and CR
  EXPECT_EQ(talk("C\r"), "\r");
  adapter_->send(frame(0x123));
  EXPECT_EQ(heard(), "");
}

// S0 to S8 are rates, s four hexadecimal digits of timing registers, which nobody can compare; both while it is closed.
TEST_F(SlcanAdapterCommands, RatesAndTimingRegisters) {
  for (const char digit : std::string("012345678")) {
    EXPECT_EQ(talk(std::string("S") + digit + "\r"), "\r") << digit;
    EXPECT_EQ(talk("O\r"), digit == '6' ? "\r" : "\a") << digit << ": the bus has 500 kbit/s";
    EXPECT_EQ(talk("C\r"), "\r");
  }
  EXPECT_EQ(talk("S0\r"), "\r");
  EXPECT_EQ(talk("s031C\r"), "\r");
  EXPECT_EQ(talk("O\r"), "\r") << "in place of the rate";
  for (const char* not_now : {"s031C\r", "S6\r", "Z1\r", "Z0\r", "L\r", "O\r"})
    EXPECT_EQ(talk(not_now), "\a") << not_now;
  EXPECT_EQ(talk("C\r"), "\r");
  for (const char* wrong : {"s031\r", "s031CC\r", "s03XC\r", "x031C\r", "S\r", "S66\r", "s6\r", "S/\r",
                            "S:\r", "Z2\r", "Z\r", "v\r"})
    EXPECT_EQ(talk(wrong), "\a") << wrong;
  EXPECT_EQ(talk("Z1\r"), "\r");
  EXPECT_EQ(talk("Z0\r"), "\r");
  EXPECT_EQ(talk("saBcD\r"), "\r");
  EXPECT_EQ(talk("O\r"), "\r");
  adapter_->send(frame(0x123, 0xAB));
  EXPECT_EQ(heard(), "t1231AB\r") << "without a stamp again";
}

TEST_F(SlcanAdapterCommands, ListenOnlyHearsAndIsSilent) {
  EXPECT_EQ(talk("L\r"), "\r");
  EXPECT_EQ(talk("t1000\r"), "\a");
  adapter_->send(frame(0x123, 0xAB));
  EXPECT_EQ(heard(), "t1231AB\r");
  EXPECT_TRUE(got_.empty());
}

TEST_F(SlcanAdapterCommands, AProgramThatLeavesClosesTheChannel) {
  EXPECT_EQ(talk("O\r"), "\r");
  adapter_->send(frame(1));
  program_ = Descriptor();
  ASSERT_TRUE(adapter_->receive());
  adapter_->send(frame(2));  // nobody is there
  attach();
  ASSERT_TRUE(adapter_->receive());
  EXPECT_EQ(talk("V\r"), "V0101\r");  // and nothing of before
  adapter_->send(frame(3));
  EXPECT_EQ(heard(), "");
  EXPECT_EQ(adapter_->counts().lost_out, 0U);
}

// Milliseconds of the host's clock, which begin again every minute.
TEST_F(SlcanAdapterCommands, StampsAreMillisecondsOfTheMinute) {
  EXPECT_EQ(talk("Z1\r"), "\r");
  EXPECT_EQ(talk("O\r"), "\r");
  const Time before = clock_.now() / kMillisecond;
  adapter_->send(frame(0x123, 0xAB));
  const Time after = clock_.now() / kMillisecond;
  const std::string text = heard();
  ASSERT_EQ(text.size(), 12U);
  const Time stamp = std::stol(text.substr(7, 4), nullptr, 16);
  EXPECT_LT(stamp, 60'000);
  EXPECT_LE((stamp - before % 60'000 + 60'000) % 60'000, after - before);
}

// What one program has set up is not for the next one: neither rate nor stamps nor half a line.
TEST_F(SlcanAdapterCommands, TheNextProgramBeginsAnew) {
  EXPECT_EQ(talk("S4\rZ1\r"), "\r\r");
  EXPECT_EQ(talk("O\r"), "\a") << "the bus has 500 kbit/s";
  ASSERT_EQ(::write(program_.get(), "t10", 3), 3);
  take_frames();
  program_ = Descriptor();
  for (int n = 0; n < 20; ++n) take_frames();
  attach();
  EXPECT_EQ(talk("O\r"), "\r");
  adapter_->send(frame(0x123, 0xAB));
  EXPECT_EQ(heard(), "t1231AB\r");
}

// Frames that came, lines that were none, and frames that went out. What comes while the channel is closed, or may not
// send, is refused and not lost.
TEST_F(SlcanAdapterCommands, CountsWhatGoesThrough) {
  const auto counts = [&] {
    const PortCounts& all = adapter_->counts();
    return std::tuple(all.sent, all.received, all.lost_in, all.lost_out);
  };
  adapter_->send(frame(1));
  EXPECT_EQ(talk("t1000\rt1\r"), "\a\a");
  EXPECT_EQ(counts(), std::tuple(0U, 0U, 0U, 0U)) << "it is closed";
  EXPECT_EQ(talk("L\r"), "\r");
  EXPECT_EQ(talk("t1000\rt1\r"), "\a\a");
  adapter_->send(frame(1));
  EXPECT_EQ(heard(), "t001100\r");
  EXPECT_EQ(counts(), std::tuple(1U, 0U, 0U, 0U)) << "it only listens";
  EXPECT_EQ(talk("C\rO\r"), "\r\r");
  EXPECT_EQ(talk("t1000\rr1004\r"), "z\rz\r");
  EXPECT_EQ(talk("t1\rt10000001\r"), "\a\a") << "a stamp is not for us";
  EXPECT_EQ(counts(), std::tuple(1U, 2U, 2U, 0U));
  EXPECT_EQ(talk(std::string(60, 't') + "\r"), "\a") << "longer than any line";
  EXPECT_EQ(counts(), std::tuple(1U, 2U, 3U, 0U));
  EXPECT_EQ(adapter_->waiting(), 0U);
}

TEST_F(SlcanAdapterCommands, AProgramThatDoesNotReadLosesWholeFramesAndThatIsTold) {
  EXPECT_EQ(talk("O\r"), "\r");
  constexpr uint32_t kFrames = 10'000;
  for (uint32_t n = 0; n < kFrames; ++n) adapter_->send(frame(n % 2048, static_cast<uint8_t>(n)));
  const PortCounts& counts = adapter_->counts();
  EXPECT_GT(counts.lost_out, 0U);
  EXPECT_EQ(counts.sent + counts.lost_out, kFrames);
  EXPECT_EQ(adapter_->take_notes(),
            std::vector<std::string>{"frames are lost: the program at the other end does not read them"});
  std::string all, part;
  while (!(part = heard()).empty()) all += part;
  EXPECT_EQ(slcan_lines(all), counts.sent);
  for (size_t n = 0, at = 0; n < counts.sent; ++n, at += 8)  // in order from the first one
    ASSERT_EQ(all.substr(at, 8), slcan_text(frame(static_cast<uint32_t>(n % 2048), static_cast<uint8_t>(n))));
  EXPECT_EQ(talk("F\r"), "F08\r");  // data overrun, once
  EXPECT_EQ(talk("F\r"), "F00\r");
}

// A peer may write as fast as it can, nothing but garbage, every line another one: the port comes back after
// one reading, tells it once, and counts.
TEST_F(SlcanAdapterCommands, AFloodOfBrokenLinesKeepsNobodyBusy) {
  EXPECT_EQ(talk("O\r"), "\r");
  std::string flood;
  size_t lines = 0;
  for (; flood.size() < 3000; ++lines) flood += "t" + std::to_string(1000 + lines) + "\x1B!\r";
  ASSERT_EQ(::write(program_.get(), flood.data(), flood.size()), static_cast<ssize_t>(flood.size()));
  uint64_t before = 0;
  for (int rounds = 0; before < lines && rounds < 1000; ++rounds) {
    const auto got = adapter_->receive();
    ASSERT_TRUE(got);
    EXPECT_FALSE(*got);
    const uint64_t now = adapter_->counts().lost_in;
    EXPECT_LE(now - before, 1024U / 7 + 1) << "more than a reading at once";
    EXPECT_GE(adapter_->needs().descriptor, 0) << "what is left must wake the loop";
    if (now == before) ::poll(nullptr, 0, 1);
    before = now;
    heard();
  }
  EXPECT_EQ(before, lines);
  EXPECT_EQ(adapter_->take_notes(),
            std::vector<std::string>{"a line that is no frame is refused: 't1000\\x1B!'"});
  EXPECT_EQ(
      adapter_->repeats(),
      std::vector<std::string>{"a line that is no frame is refused: " + std::to_string(lines) + " times"});
}

TEST_F(SlcanPair, AFloodFromAnAdapterKeepsNobodyBusy) {
  const Descriptor master(posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK));
  ASSERT_TRUE(master.is_open() && grantpt(master.get()) == 0 && unlockpt(master.get()) == 0);
  const auto client = open(std::string("slcan:") + ptsname(master.get()));
  ASSERT_TRUE(client);
  client->take_notes();
  std::string flood;
  size_t lines = 0;
  for (; flood.size() < 3000; ++lines) flood += "t" + std::to_string(1000 + lines) + "!\r";
  ASSERT_EQ(::write(master.get(), flood.data(), flood.size()), static_cast<ssize_t>(flood.size()));
  uint64_t before = 0;
  for (int rounds = 0; before < lines && rounds < 1000; ++rounds) {
    const auto got = client->receive();
    ASSERT_TRUE(got);
    EXPECT_FALSE(*got);
    const uint64_t now = client->counts().lost_in;
    EXPECT_LE(now - before, 1024U / 6 + 1);
    if (now == before) ::poll(nullptr, 0, 1);
    before = now;
  }
  EXPECT_EQ(before, lines);
  EXPECT_EQ(client->take_notes(), std::vector<std::string>{"a broken line from the adapter: 't1000!'"});
}

TEST_F(SlcanAdapterCommands, AnyBytesNeverHurt) {
  std::mt19937 random(20010815);
  const std::string letters = "tTrRCOLSZVNFXMms0123456789ABCDEF\r\r\r\a\n";
  for (int round = 0; round < 2000; ++round) {
    std::string text;
    for (auto n = random() % 60; n > 0; --n)
      text += random() % 8 == 0 ? static_cast<char>(random()) : letters[random() % letters.size()];
    talk(text);
  }
  for (const Frame& frame_got : got_) EXPECT_TRUE(is_valid(frame_got));
  talk("\rC\r");
  while (!heard().empty()) {
  }
  EXPECT_EQ(talk("S6\r"), "\r");
  EXPECT_EQ(talk("O\r"), "\r");
  got_.clear();
  talk("t1000\r");
  EXPECT_EQ(got_.size(), 1U);
}

}  // namespace
}  // namespace ipos::tests
