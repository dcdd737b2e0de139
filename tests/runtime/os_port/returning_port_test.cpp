// Ports that go away and come back, over fakes: when they are opened again, and what is lost meanwhile.
#include "runtime/os_port/returning_port.hpp"

#include <gtest/gtest.h>

#include "tests/runtime/os_port/port_rig.hpp"

namespace ipos::tests {
namespace {

using namespace ipos::runtime;  // NOLINT: everything here is about the runtime

// A device that is there or not, and how often somebody has tried to open it.
struct Socket {
  ManualClock clock;
  LoopbackPort* plugged = nullptr;  // the last one
  bool empty = false;
  int attempts = 0;

  CanPortResult open() {
    ++attempts;
    if (empty) return tl::unexpected(port_error(PortFault::NoSuchDevice, "loop"));
    auto port = std::make_unique<LoopbackPort>(clock);
    plugged = port.get();
    return port;
  }
};

TEST(ReturningPort, ACanPortIsOpenedAgainOnceASecond) {
  Socket socket;
  const auto opened = open_returning([&] { return socket.open(); }, socket.clock);
  ASSERT_TRUE(opened);
  CanPort& port = **opened;
  EXPECT_EQ(port.absence(), "");
  port.send(frame(1));
  EXPECT_EQ(socket.plugged->outgoing.size(), 1U);

  socket.empty = true;
  socket.plugged->gone_at = socket.clock.now();
  const auto nothing = port.receive();
  ASSERT_TRUE(nothing) << "it is no error for the run";
  EXPECT_FALSE(nothing->has_value());
  EXPECT_EQ(port.absence(), "the device has gone");
  EXPECT_EQ(port.needs().descriptor, -1) << "nothing to wake the loop";
  port.send(frame(2));
  EXPECT_EQ(port.counts().lost_out, 1U);
  const int before = socket.attempts;
  for (int ms = 0; ms < 2'500; ++ms) {
    socket.clock.advance(kMillisecond);
    ASSERT_TRUE(port.flush());
    ASSERT_TRUE(port.receive());
  }
  EXPECT_EQ(socket.attempts - before, 2);
  EXPECT_EQ(port.absence(), "the device has gone") << "why it went, not why it is not back";

  socket.empty = false;
  socket.clock.advance(kReopenPause);
  ASSERT_TRUE(port.flush());
  EXPECT_EQ(port.absence(), "");
  port.send(frame(3));
  ASSERT_EQ(socket.plugged->outgoing.size(), 1U);
  EXPECT_EQ(socket.plugged->outgoing[0].frame.id, 3U) << "what was lost does not come later";
  EXPECT_EQ(port.counts().lost_out, 1U);
}

TEST(ReturningPort, OneThatIsNotThereAtTheStartIsAnError) {
  Socket socket;
  socket.empty = true;
  EXPECT_EQ(open_returning([&] { return socket.open(); }, socket.clock).error().text,
            "loop: there is no such device");
}

// Reading fails from a time on.
class Pulled final : public BytePort {
 public:
  Pulled(std::string name, const bool& pulled) : name_(std::move(name)), pulled_(pulled) {}
  const std::string& name() const override { return name_; }
  PortNeeds needs() const override { return {5, false, kNever}; }
  tl::expected<void, PortError> flush() override { return {}; }
  size_t waiting() const override { return 3; }
  const PortCounts& counts() const override { return counts_; }
  std::vector<std::string> take_notes() override { return {"a note"}; }
  bool has_parity() const override { return true; }
  bool paces() const override { return true; }
  Time latency() const override { return 16 * kMillisecond; }
  void send(std::span<const uint8_t> bytes) override {
    counts_.sent += bytes.size();
    counts_.received += 2 * bytes.size();
    counts_.lost_out += 3 * bytes.size();
    counts_.lost_in += 5 * bytes.size();
    counts_.waited += 7 * bytes.size();
  }
  std::vector<std::string> repeats() const override { return {"a note: 2 times"}; }
  tl::expected<size_t, PortError> receive(std::span<ByteArrival>) override {
    if (pulled_) return tl::unexpected(port_error(PortFault::Gone, name_, "Input/output error"));
    return size_t{0};
  }

 private:
  std::string name_;
  const bool& pulled_;
  PortCounts counts_;
};

// What it says of its kind it says while it is away, too; its counts go on.
TEST(ReturningPort, ASerialPortKeepsItsNature) {
  ManualClock clock;
  bool pulled = false;
  int opened = 0;
  const auto plug = [&]() -> SerialPortResult {
    ++opened;
    return std::make_unique<Pulled>("/dev/ttyUSB0@16ms", pulled);
  };
  const auto port = open_returning(plug, clock);
  ASSERT_TRUE(port);
  const std::array<uint8_t, 4> bytes{};
  std::array<ByteArrival, 8> into{};
  (*port)->send(bytes);
  pulled = true;
  EXPECT_EQ((*port)->receive(into).value(), 0U);
  EXPECT_EQ((*port)->absence(), "the device has gone: Input/output error");
  EXPECT_TRUE((*port)->has_parity() && (*port)->paces());
  EXPECT_EQ((*port)->latency(), 16 * kMillisecond);
  EXPECT_EQ((*port)->waiting(), 0U);
  EXPECT_TRUE((*port)->repeats().empty());
  const PortNeeds away = (*port)->needs();
  EXPECT_EQ(std::tuple(away.descriptor, away.output, away.wake),
            std::tuple(-1, false, clock.now() + kReopenPause));
  EXPECT_EQ((*port)->take_notes(), std::vector<std::string>{"a note"}) << "said before it went";
  (*port)->send(bytes);
  pulled = false;
  clock.advance(kReopenPause);
  ASSERT_TRUE((*port)->flush());
  EXPECT_EQ(opened, 2);
  (*port)->send(bytes);
  EXPECT_EQ((*port)->needs().descriptor, 5);
  EXPECT_EQ((*port)->waiting(), 3U);
  EXPECT_EQ((*port)->repeats(), std::vector<std::string>{"a note: 2 times"});
  const PortCounts& counts = (*port)->counts();
  EXPECT_EQ(std::tuple(counts.sent, counts.received, counts.lost_in, counts.waited),
            std::tuple(8U, 16U, 40U, 56U))
      << "of both times that it was there";
  EXPECT_EQ(counts.lost_out, 3U * 8U + 4U) << "and what it got while it was away";
}

// Not before the pause is over, and again a pause later.
TEST(ReturningPort, IsOpenedAgainWhenThePauseIsOver) {
  Socket socket;
  const auto opened = open_returning([&] { return socket.open(); }, socket.clock);
  ASSERT_TRUE(opened);
  CanPort& port = **opened;
  socket.empty = true;
  socket.plugged->gone_at = socket.clock.now();
  ASSERT_TRUE(port.receive());
  for (const int attempts : {2, 3}) {
    socket.clock.advance(kReopenPause - 1);
    ASSERT_TRUE(port.flush());
    EXPECT_EQ(socket.attempts, attempts - 1);
    socket.clock.advance(1);
    EXPECT_EQ(port.needs().wake, socket.clock.now());
    ASSERT_TRUE(port.flush());
    EXPECT_EQ(socket.attempts, attempts);
  }
}

// The next program that wants a pseudo-terminal may have got the number.
TEST(ReturningPort, ANumberedPseudoTerminalDoesNotComeBack) {
  ManualClock clock;
  bool pulled = false;
  int opened = 0;
  const auto plug = [&]() -> SerialPortResult {
    ++opened;
    return std::make_unique<Pulled>("/dev/pts/3", pulled);
  };
  const auto port = open_returning(plug, clock);
  pulled = true;
  std::array<ByteArrival, 8> into{};
  ASSERT_TRUE((*port)->receive(into));
  clock.advance(100 * kSecond);
  ASSERT_TRUE((*port)->flush());
  EXPECT_EQ(opened, 1);
  EXPECT_EQ((*port)->absence(), "the device has gone: Input/output error");
}

}  // namespace
}  // namespace ipos::tests
