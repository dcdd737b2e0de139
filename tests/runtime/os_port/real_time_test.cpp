// The real-time loop against a clock driven by hand: virtual time follows it, never runs ahead of an arrival,
// and late ticks are counted.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <random>

#include "runtime/bus/can/frame_bits.hpp"
#include "tests/runtime/os_port/port_rig.hpp"

namespace ipos::tests {
namespace {

constexpr Time kBit = 2 * kMicrosecond;  // 500 kbaud

struct Rig {
  ManualClock clock;
  EventQueue queue;
  CanLine line{queue, 0, "sbus", 500'000};
  Node station{line, "station"};
  Ticker ticker{queue, 1};
  LoopbackPort port{clock};
  CanBridge bridge{queue, 2, line, port};
  QueueSimulation simulation{queue};
  RealTimeLoop loop{clock, simulation};
  Time start = clock.now();

  Rig() { loop.add(bridge); }
  void arrive(Time at, const Frame& got) {
    port.incoming.push_back({start + at, std::nullopt, std::nullopt, got});
  }
};

TEST(RealTime, VirtualTimeFollowsTheClock) {
  Rig rig;
  rig.ticker.action = [&](Time now) { EXPECT_GE(rig.clock.now() - rig.start, now); };
  EXPECT_EQ(rig.loop.run(kSecond), RealTimeLoop::End::Reached);
  EXPECT_EQ(rig.ticker.ticks, 1001);  // at 0, 1, ..., 1000 ms
  EXPECT_EQ(rig.queue.now(), kSecond);
  EXPECT_EQ(rig.clock.now() - rig.start, kSecond);
  EXPECT_EQ(rig.loop.punctuality().late_ticks, 0U);
  EXPECT_EQ(rig.loop.punctuality().worst, 0);
  EXPECT_EQ(rig.loop.punctuality().first_late, -1);
  EXPECT_LE(rig.clock.waits, 1001);  // it waits, it does not look again and again
}

TEST(RealTime, AnArrivalIsOnTheLineAtItsTime) {
  Rig rig;
  rig.arrive(3'400 * kMicrosecond, frame(100));
  EXPECT_EQ(rig.loop.run(10 * kMillisecond), RealTimeLoop::End::Reached);
  ASSERT_EQ(rig.station.times.size(), 1U);
  EXPECT_EQ(rig.station.times[0], 3'400 * kMicrosecond + kBit +
                                      static_cast<Time>(frame_bits(frame(100)) - kIntermissionBits) * kBit);
}

TEST(RealTime, WhatAStationSendsIsOutsideNotBeforeItsTime) {
  Rig rig;
  rig.ticker.action = [&](Time now) {
    if (now == 5 * kMillisecond) rig.station.port.send(frame(7), 1);
  };
  rig.loop.run(10 * kMillisecond);
  ASSERT_EQ(rig.port.outgoing.size(), 1U);
  const Time wire = static_cast<Time>(frame_bits(frame(7)) - kIntermissionBits) * kBit;
  EXPECT_EQ(rig.port.outgoing[0].at - rig.start, 5 * kMillisecond + kBit + wire);
}

// Whatever the pauses of the host: every frame reaches the line at its own time, in order, and none is late.
TEST(RealTime, NeverRunsAheadOfAnArrival) {
  EXPECT_TRUE(rc::check([] {
    const auto seed = *rc::gen::arbitrary<uint32_t>();
    std::mt19937 random(seed);
    Rig rig;
    rig.clock.oversleep = [&] {
      return static_cast<Time>(random() % 10 == 0 ? random() % 20'000'000 : random() % 9'000);
    };
    std::vector<Time> arrivals;
    Time at = 0;
    for (uint32_t n = 0; n < 100; ++n) {
      at += static_cast<Time>(400'000 + random() % 5'000'000);  // farther apart than a frame is long
      arrivals.push_back(at);
      rig.arrive(at, frame(n + 1));
    }
    RC_ASSERT(rig.loop.run(at + 10 * kMillisecond) == RealTimeLoop::End::Reached);
    RC_ASSERT(rig.bridge.counts().late == 0U);
    RC_ASSERT(rig.station.frames.size() == arrivals.size());
    for (uint32_t n = 0; n < 100; ++n) {
      RC_ASSERT(rig.station.frames[n].id == n + 1);
      const Time wire = static_cast<Time>(frame_bits(frame(n + 1)) - kIntermissionBits) * kBit;
      const Time boundary = (arrivals[n] / kBit + 1) * kBit;
      RC_ASSERT(rig.station.times[n] == boundary + wire);
    }
  }));
}

// The wait for the tick of 5 ms ends at 10.2 ms: the ticks of 5, 6, 7, 8 and 9 ms are 5.2, 4.2, 3.2, 2.2
// and 1.2 ms late, that of 10 ms 0.2 ms, which is not counted.
TEST(RealTime, LateTicksAreCounted) {
  Rig rig;
  rig.clock.oversleep = [&]() -> Time {
    return rig.clock.now() - rig.start == 4 * kMillisecond ? 5'200 * kMicrosecond : 0;
  };
  rig.loop.run(20 * kMillisecond);
  EXPECT_EQ(rig.loop.punctuality().late_ticks, 5U);
  EXPECT_EQ(rig.loop.punctuality().worst, 5'200 * kMicrosecond);
  EXPECT_EQ(rig.loop.punctuality().first_late, 5 * kMillisecond);
  EXPECT_EQ(rig.loop.punctuality().lag, 0);
  EXPECT_EQ(rig.ticker.ticks, 21);  // all of them ran
}

// A simulation that needs 3 ms for a tick of 1 ms falls behind; arrivals still keep their times.
TEST(RealTime, ASlowSimulationFallsBehindAndSaysSo) {
  Rig rig;
  rig.ticker.action = [&](Time) { rig.clock.advance(3 * kMillisecond); };
  rig.arrive(2'500 * kMicrosecond, frame(100));
  rig.loop.run(10 * kMillisecond);
  EXPECT_EQ(rig.ticker.ticks, 11);
  EXPECT_GT(rig.loop.punctuality().late_ticks, 5U);
  // 11 ticks of 3 ms for 10 ms; a wait takes at least a nanosecond
  EXPECT_NEAR(static_cast<double>(rig.loop.punctuality().lag), 23e6, 10.0);
  ASSERT_EQ(rig.station.times.size(), 1U);
  EXPECT_LT(rig.station.times[0], 3 * kMillisecond);
}

// A process that is stopped for two seconds: what a station sends each 10 ms comes no faster than that afterwards but for the
// 200 ms that are made up for. Stopped for less, it sends all.
TEST(RealTime, WhatIsMuchTooLateIsNotMadeUpFor) {
  for (const Time stop : {2 * kSecond, 150 * kMillisecond}) {
    Rig rig;
    rig.ticker.action = [&](Time now) {
      if (now % (10 * kMillisecond) == 0) rig.station.port.send(frame(7), 1);
    };
    bool stopped = false;
    rig.clock.oversleep = [&]() -> Time {
      if (stopped || rig.clock.now() - rig.start < 500 * kMillisecond) return 0;
      stopped = true;
      return stop;
    };
    rig.arrive(600 * kMillisecond, frame(100));  // while it is stopped, or shortly afterwards
    EXPECT_EQ(rig.loop.run(kSecond), RealTimeLoop::End::Reached);
    const bool forgiven = stop > kForgiven;
    EXPECT_NEAR(static_cast<double>(rig.loop.punctuality().left_out), forgiven ? static_cast<double>(stop) : 0, 1e6);
    EXPECT_NEAR(static_cast<double>(rig.loop.punctuality().worst), static_cast<double>(stop), 1e6);
    EXPECT_EQ(rig.loop.punctuality().first_late / kMillisecond, 500);  // the end of the frame that is on the line
    EXPECT_NEAR(static_cast<double>(rig.clock.now() - rig.start), 1e9 + (forgiven ? static_cast<double>(stop) : 0), 1e6);
    size_t at_once = 0;  // sent within the millisecond behind the stop
    for (const CanArrival& sent : rig.port.outgoing)
      at_once += sent.at - rig.start >= 500 * kMillisecond + stop && sent.at - rig.start < 503 * kMillisecond + stop ? 1U : 0U;
    EXPECT_EQ(at_once, forgiven ? 1U : 16U);  // that frame, and those of 510 to 650 ms
    EXPECT_EQ(rig.port.outgoing.size(), 100U);  // virtual time is all there
    ASSERT_EQ(rig.station.frames.size(), 1U);
    EXPECT_EQ(rig.bridge.counts().late, forgiven ? 1U : 0U);
  }
}

TEST(RealTime, EndsWithTheSimulationAndWithAPort) {
  Rig stopped;
  stopped.simulation.stop_at = 5 * kMillisecond;
  EXPECT_EQ(stopped.loop.run(kSecond), RealTimeLoop::End::Stopped);
  EXPECT_EQ(stopped.queue.now(), 5 * kMillisecond);
  Rig gone;
  gone.port.gone_at = gone.start + 7 * kMillisecond;
  EXPECT_EQ(gone.loop.run(kSecond), RealTimeLoop::End::PortGone);
  EXPECT_EQ(gone.queue.now(), 7 * kMillisecond);
}

// Each round takes in, runs, and then sends; a port that fails in either ends the run, and the others are still served.
TEST(RealTime, EveryRoundCollectsAndFlushesEachMember) {
  struct Member final : RealTimeMember {
    PortNeeds needs() const override { return {}; }
    bool collect(Time) override { return ++collected != fails_to_collect; }
    bool flush() override { return ++flushed != fails_to_flush; }
    int collected = 0, flushed = 0;
    int fails_to_collect = -1, fails_to_flush = -1;  // at which time
  };
  for (const bool in_flush : {false, true}) {
    Rig rig;
    Member first, second;
    (in_flush ? first.fails_to_flush : first.fails_to_collect) = 3;
    rig.loop.add(first);
    rig.loop.add(second);
    EXPECT_EQ(rig.loop.run(kSecond), RealTimeLoop::End::PortGone);
    for (const Member* member : {&first, &second}) {
      EXPECT_EQ(member->collected, 3) << in_flush;
      EXPECT_EQ(member->flushed, 3) << in_flush;
    }
  }
}

}  // namespace
}  // namespace ipos::tests
