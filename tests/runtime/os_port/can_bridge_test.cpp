// The bridge between a simulated line and a port: order, no echo, acknowledge, and what happens when nobody
// is there.
#include <gtest/gtest.h>

#include "runtime/bus/can/frame_bits.hpp"
#include "tests/runtime/os_port/port_rig.hpp"

namespace ipos::tests {
namespace {

constexpr uint32_t kBaud = 500'000;
constexpr Time kBit = 2 * kMicrosecond;

struct Rig {
  ManualClock clock{0};
  EventQueue queue;
  CanLine line{queue, 0, "sbus", kBaud};
  LoopbackPort port{clock};
  CanBridge bridge{queue, 9, line, port};

  void arrive(Time at, const Frame& got) { port.incoming.push_back({at, std::nullopt, std::nullopt, got}); }
  void run(Time until) {
    clock.advance(until - clock.now());
    ASSERT_TRUE(bridge.collect(0));
    queue.run_until(until);
  }
};

TEST(CanBridge, FramesOfStationsGoOutOnceAndInOrder) {
  Rig rig;
  Node a(rig.line, "a"), b(rig.line, "b");
  a.port.send(frame(300, 1), 1);
  b.port.send(frame(200, 2), 1);
  b.port.send(frame(100, 3), 1);
  rig.run(10 * kMillisecond);
  ASSERT_EQ(rig.port.outgoing.size(), 3U);
  EXPECT_EQ(rig.port.outgoing[0].frame, frame(100, 3));  // as arbitration decides
  EXPECT_EQ(rig.port.outgoing[1].frame, frame(200, 2));
  EXPECT_EQ(rig.port.outgoing[2].frame, frame(300, 1));
  EXPECT_EQ(a.frames.size(), 2U);  // and nothing comes back
  EXPECT_EQ(b.frames.size(), 1U);
}

TEST(CanBridge, ALoneStationIsAcknowledged) {
  Rig rig;
  Node a(rig.line, "a");
  a.port.send(frame(300), 1);
  rig.run(10 * kMillisecond);
  EXPECT_EQ(a.sent, 1);
  EXPECT_EQ(a.not_sent, 0);
}

TEST(CanBridge, FramesFromThePortKeepTheirOrderAndDoNotGoBack) {
  Rig rig;
  Node a(rig.line, "a"), b(rig.line, "b");
  // A node with all of these at once would send the lowest identifier first.
  for (uint32_t n = 0; n < 50; ++n) rig.arrive(kMillisecond, frame(1000 - n, static_cast<uint8_t>(n)));
  rig.run(30 * kMillisecond);
  ASSERT_EQ(a.frames.size(), 50U);
  for (uint32_t n = 0; n < 50; ++n) EXPECT_EQ(a.frames[n].id, 1000 - n);
  EXPECT_EQ(b.frames, a.frames);
  EXPECT_TRUE(rig.port.outgoing.empty());
  EXPECT_EQ(rig.bridge.counts().undelivered, 0U);
}

TEST(CanBridge, AFrameGoesOnTheLineAtItsTimeOfArrival) {
  Rig rig;
  Node a(rig.line, "a");
  const Time at = 3 * kMillisecond + 100 * kMicrosecond;
  rig.arrive(at, frame(100));
  rig.run(10 * kMillisecond);
  ASSERT_EQ(a.times.size(), 1U);
  // From the next bit boundary to the end of the end-of-frame field: all bits but the 3 of intermission.
  EXPECT_EQ(a.times[0], at + kBit + static_cast<Time>(frame_bits(frame(100)) - kIntermissionBits) * kBit);
  EXPECT_EQ(rig.bridge.counts().late, 0U);
}

TEST(CanBridge, AFrameOfThePastIsPutOnTheLineAtOnceAndCounted) {
  Rig rig;
  Node a(rig.line, "a");
  rig.run(10 * kMillisecond);
  rig.arrive(4 * kMillisecond, frame(100));
  rig.run(20 * kMillisecond);
  ASSERT_EQ(a.times.size(), 1U);
  EXPECT_GT(a.times[0], 10 * kMillisecond);
  EXPECT_EQ(rig.bridge.counts().late, 1U);
  EXPECT_EQ(rig.bridge.counts().worst_late, 6 * kMillisecond);
}

TEST(CanBridge, WithoutAStationFramesGoNowhereAndThatIsTold) {
  Rig rig;
  for (uint32_t n = 0; n < 10; ++n) rig.arrive(n * kMillisecond, frame(n));
  rig.run(50 * kMillisecond);
  EXPECT_EQ(rig.bridge.counts().undelivered, 10U);
  EXPECT_EQ(rig.bridge.waiting(), 0U);
  EXPECT_EQ(rig.bridge.take_notes(),
            std::vector<std::string>{"loop: frames from it reach nobody: no simulated station "
                                     "takes part in sbus"});
}

TEST(CanBridge, AFloodWaitsAndLosesNothing) {
  Rig rig;
  Node a(rig.line, "a");
  constexpr uint32_t kFrames = 10'000;
  for (uint32_t n = 0; n < kFrames; ++n) {
    Frame numbered = frame(100);
    numbered.length = 2;
    numbered.data = {static_cast<uint8_t>(n >> 8), static_cast<uint8_t>(n)};
    rig.arrive(0, numbered);
  }
  rig.run(kMillisecond);
  EXPECT_EQ(rig.port.incoming.size() + rig.bridge.waiting() + a.frames.size(), kFrames);
  EXPECT_GT(rig.port.incoming.size(), 0U);  // the rest waits at the port
  EXPECT_EQ(rig.bridge.needs().descriptor, -1);
  for (Time at = 2 * kMillisecond; at < 3 * kSecond; at += kMillisecond) rig.run(at);
  ASSERT_EQ(a.frames.size(), kFrames);
  for (uint32_t n = 0; n < kFrames; ++n)
    ASSERT_EQ(a.frames[n].data[0] << 8 | a.frames[n].data[1], n & 0xFFFF);
}

TEST(CanBridge, TakesAsManyAsItHasRoomFor) {
  Rig rig;
  Node a(rig.line, "a");
  for (uint32_t n = 0; n < 4096; ++n) rig.arrive(0, frame(100));
  EXPECT_TRUE(rig.bridge.collect(0));
  EXPECT_EQ(rig.bridge.waiting(), 4096U);
  EXPECT_EQ(rig.bridge.take_notes(),
            std::vector<std::string>{
                "loop: 4096 frames wait for the simulated line: the real bus is faster than it"});
  rig.arrive(0, frame(101));
  EXPECT_TRUE(rig.bridge.collect(0));
  EXPECT_EQ(rig.port.incoming.size(), 1U);
  rig.run(10 * kMillisecond);
  EXPECT_EQ(rig.port.incoming.size(), 1U) << "of this moment none is over";
  rig.run(11 * kMillisecond);
  EXPECT_EQ(rig.port.incoming.size(), 0U);
}

// A moment that is now is not late; time counts from the epoch of the run.
TEST(CanBridge, LateIsWhatIsBeforeNow) {
  Rig rig;
  Node a(rig.line, "a");
  rig.run(10 * kMillisecond);
  rig.arrive(10 * kMillisecond, frame(100));
  EXPECT_TRUE(rig.bridge.collect(0));
  EXPECT_EQ(rig.bridge.counts().late, 0U);
  rig.arrive(10 * kMillisecond, frame(101));
  EXPECT_TRUE(rig.bridge.collect(1));
  EXPECT_EQ(rig.bridge.counts().late, 1U);
  EXPECT_EQ(rig.bridge.counts().worst_late, 1);
  rig.arrive(10 * kMillisecond, frame(102));
  EXPECT_TRUE(rig.bridge.collect(7));
  EXPECT_EQ(rig.bridge.counts().worst_late, 7) << "the worst one";
  rig.arrive(10 * kMillisecond, frame(103));
  EXPECT_TRUE(rig.bridge.collect(3));
  EXPECT_EQ(rig.bridge.counts().worst_late, 7);
  EXPECT_EQ(rig.bridge.counts().late, 3U);
}

TEST(CanBridge, ErrorFramesAreToldOnce) {
  Rig rig;
  // Class CAN_ERR_ACK (20h), and CAN_ERR_CRTL (4) with "error passive by transmit errors" (20h in byte 1).
  CanErrorFrame error{0x24, {}};
  error.data[1] = 0x20;
  for (int n = 0; n < 5; ++n) rig.port.incoming.push_back({0, std::nullopt, error, {}});
  rig.run(kMillisecond);
  EXPECT_EQ(rig.bridge.take_notes(),
            std::vector<std::string>{
                "loop: controller (error passive by transmit errors), no acknowledge: no other "
                "station on the bus, or another bit rate"});
}

// A simulated station sends other data on the identifier of a frame from the port, at the same moment, again
// and again: the frame from the port loses at its first different bit until the bridge is bus-off (32 times 8
// errors). It comes back as a controller would, and the frame is not lost.
TEST(CanBridge, ComesBackFromBusOff) {
  Rig rig;
  Node rival(rig.line, "rival"), listener(rig.line, "listener");
  listener.port.send(frame(1), 1);  // occupies the line, so that both begin behind it
  for (int n = 0; n < 60; ++n) rival.port.send(frame(100, 1), 1);
  rig.arrive(10 * kMicrosecond, frame(100, 2));
  rig.run(100 * kMillisecond);
  ASSERT_EQ(listener.frames.size(), 61U);
  EXPECT_EQ(std::count(listener.frames.begin(), listener.frames.end(), frame(100, 2)), 1);
  const std::vector<std::string> notes = rig.bridge.take_notes();
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_TRUE(notes[0].starts_with("loop: bus-off on the simulated line sbus")) << notes[0];
}

TEST(CanBridge, APortThatHasGoneIsAnErrorForGood) {
  Rig rig;
  rig.port.gone_at = kMillisecond;
  EXPECT_TRUE(rig.bridge.collect(0));
  rig.clock.advance(kMillisecond);
  EXPECT_FALSE(rig.bridge.collect(0));
  EXPECT_EQ(rig.bridge.take_notes(), std::vector<std::string>{"loop: the device has gone"});
}

}  // namespace
}  // namespace ipos::tests
