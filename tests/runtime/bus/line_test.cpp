// The CAN line's behaviour by hand-computed cases: times, confirmation, missing acknowledge, collisions,
// load.
#include "runtime/bus/can/line.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <utility>
#include <vector>

#include "runtime/bus/can/frame_bits.hpp"
#include "runtime/clock/random.hpp"
#include "tests/harness/proves.hpp"

namespace ipos::runtime {
namespace {

class Station final : public CanNode {
 public:
  struct Got {
    Time time;
    Frame frame;
  };
  void on_frame(Time now, const Frame& frame) override {
    received.push_back({now, frame});
    if (reply_on && port != nullptr) {
      reply_on = false;
      port->send(reply, 77);
    }
  }
  void on_sent(Time now, const Frame& frame, uint64_t tag) override {
    sent.push_back({now, frame});
    last_tag = tag;
  }
  void on_not_sent(Time, const Frame&, uint64_t, NotSent reason) override { failed.push_back(reason); }

  std::vector<Got> received;
  std::vector<Got> sent;
  std::vector<NotSent> failed;
  uint64_t last_tag = 0;
  bool reply_on = false;
  Frame reply;
  LinePort* port = nullptr;
};

class Watcher final : public CanObserver {
 public:
  void on_frame(const CanLine&, const FrameRecord& record) override { frames.push_back(record); }
  void on_line_event(const CanLine& line, const LineEvent& event) override {
    events.push_back(event);
    texts.push_back(describe(line, event));
  }
  size_t count(LineEventKind kind) const {
    size_t n = 0;
    for (const LineEvent& event : events) n += event.kind == kind ? 1 : 0;
    return n;
  }
  std::vector<FrameRecord> frames;
  std::vector<LineEvent> events;
  std::vector<std::string> texts;
};

struct Bench {
  EventQueue queue;
  CanLine line{queue, 9, "sbus", 500'000};
  Watcher watcher;
  Station a, b, c;
  Bench() { line.add_observer(watcher); }
};

Frame data_frame(uint32_t id, uint8_t first = 0) {
  return {id, 8, {first, 2, 3, 4, 5, 6, 7, 8}, false, false};
}

TEST(CanLine, DeliversAtTheEndOfEndOfFrame) {
  Bench t;
  const NodeId a = t.line.attach("a", 500'000, t.a);
  t.line.attach("b", 500'000, t.b);
  t.queue.run_until(5001);  // within bit 2 of 2000 ns: start of frame is bit 3
  const Frame frame = data_frame(1024);
  EXPECT_EQ(t.line.send(a, frame, 42), SendStatus::Queued);
  t.queue.run_until(kMillisecond);
  ASSERT_EQ(t.b.received.size(), 1U);
  const Time end = (3 + frame_bits(frame) - 3) * 2000;
  EXPECT_EQ(t.b.received[0].time, end);
  EXPECT_EQ(t.b.received[0].frame, frame);
  ASSERT_EQ(t.a.sent.size(), 1U);
  EXPECT_EQ(t.a.sent[0].time, end);
  EXPECT_EQ(t.a.last_tag, 42U);
  EXPECT_TRUE(t.a.received.empty());  // nobody hears himself
  ASSERT_EQ(t.watcher.frames.size(), 1U);
  EXPECT_EQ(t.watcher.frames[0].start, 6000);
  EXPECT_EQ(t.watcher.frames[0].end, end);
}

TEST(CanLine, AnAnswerFromTheCallbackCompetesAfterTheIntermission) {
  Bench t;
  const NodeId a = t.line.attach("a", 500'000, t.a);
  const NodeId b = t.line.attach("b", 500'000, t.b);
  LinePort port(t.line, b);
  t.b.port = &port;
  t.b.reply_on = true;
  t.b.reply = data_frame(12);
  t.line.send(a, data_frame(11), 1);
  t.line.send(a, data_frame(600), 1);
  t.queue.run_until(kMillisecond * 2);
  ASSERT_EQ(t.watcher.frames.size(), 3U);
  EXPECT_EQ(t.watcher.frames[1].frame.id, 12U);  // beats the 600 that waited longer
  EXPECT_EQ(t.watcher.frames[1].start, t.watcher.frames[0].end + 3 * 2000);
  EXPECT_EQ(t.watcher.frames[2].frame.id, 600U);
}

TEST(CanLine, LowestIdentifierOfANodeGoesFirstAndEqualOnesInOrder) {
  Bench t;
  const NodeId a = t.line.attach("a", 500'000, t.a);
  t.line.attach("b", 500'000, t.b);
  for (const uint32_t id : {7U, 3U, 5U, 3U})
    t.line.send(a, data_frame(id, static_cast<uint8_t>(10 * id)), id);
  t.line.send(a, data_frame(3, 99), 8);
  t.queue.run_until(10 * kMillisecond);
  std::vector<uint32_t> order;
  for (const FrameRecord& record : t.watcher.frames) order.push_back(record.frame.id);
  EXPECT_EQ(order, (std::vector<uint32_t>{3, 3, 3, 5, 7}));
  EXPECT_EQ(t.watcher.frames[2].frame.data[0], 99);
}

TEST(CanLine, RefusesBadFramesAndOverfullQueues) {
  Bench t;
  const NodeId a = t.line.attach("a", 500'000, t.a);
  EXPECT_EQ(t.line.send(a, Frame{4096, 0, {}, false, false}, 0), SendStatus::InvalidFrame);
  EXPECT_EQ(t.line.send(a, Frame{1, 9, {}, false, false}, 0), SendStatus::InvalidFrame);
  for (size_t i = 0; i < kSendQueueLimit; ++i)
    EXPECT_EQ(t.line.send(a, data_frame(1), 5), SendStatus::Queued);
  EXPECT_EQ(t.line.send(a, data_frame(1), 5), SendStatus::QueueFull);
  t.line.withdraw(a, 5);
  t.queue.run_until(kMillisecond);
  EXPECT_TRUE(t.watcher.frames.empty());
  EXPECT_TRUE(t.a.failed.empty());
}

// What it destroys is in strangers_test.cpp.
TEST(CanLine, WrongBaudRateTakesNoPartAndSaysWhy) {
  PROVES("DIAG-03");
  Bench t;
  const NodeId a = t.line.attach("unit1", 500'000, t.a);
  const NodeId b = t.line.attach("unit2", 250'000, t.b);
  t.line.attach("unit3", 500'000, t.c);
  ASSERT_EQ(t.watcher.texts.size(), 1U);
  EXPECT_NE(t.watcher.texts[0].find("unit2"), std::string::npos);
  EXPECT_NE(t.watcher.texts[0].find("250 kbaud"), std::string::npos);
  EXPECT_NE(t.watcher.texts[0].find("500 kbaud"), std::string::npos);
  t.line.send(a, data_frame(2), 0);
  t.queue.run_until(kMillisecond);
  EXPECT_TRUE(t.b.received.empty());
  EXPECT_TRUE(t.c.received.empty());
  t.line.set_baud(b, 500'000);
  EXPECT_EQ(t.line.send(b, data_frame(1), 0), SendStatus::Queued);
  t.queue.run_until(20 * kMillisecond);
  EXPECT_EQ(t.c.received.size(), 2U);
}

TEST(CanLine, AnObserverThatComesLateHearsWhoIsAbsent) {
  Bench t;
  t.line.attach("unit1", 125'000, t.a);
  Watcher late;
  t.line.add_observer(late);
  EXPECT_EQ(late.count(LineEventKind::WrongBaudRate), 1U);
}

TEST(CanLine, WhoAcknowledgesMayLeaveAndComeBack) {
  Bench t;
  const NodeId a = t.line.attach("a", 500'000, t.a);
  const NodeId b = t.line.attach("b", 500'000, t.b);
  const Frame frame = data_frame(100);
  t.line.send(a, frame, 1);
  t.queue.run_until(kMillisecond);
  EXPECT_EQ(t.a.sent.size(), 1U);
  t.line.send(a, frame, 2);
  t.queue.run_until(kMillisecond + 50 * kMicrosecond);  // on the wire
  t.line.set_connected(b, false);
  t.queue.run_until(2 * kMillisecond);
  EXPECT_EQ(t.a.sent.size(), 2U);
  EXPECT_EQ(t.b.received.size(), 1U);
  t.line.send(a, frame, 3);
  t.queue.run_until(3 * kMillisecond);
  EXPECT_EQ(t.a.sent.size(), 2U);
  EXPECT_FALSE(t.a.failed.empty());
  for (const NotSent reason : t.a.failed) EXPECT_EQ(reason, NotSent::NoAcknowledge);
  t.line.set_connected(b, true);
  t.queue.run_until(4 * kMillisecond);
  EXPECT_EQ(t.a.sent.size(), 3U);
  EXPECT_EQ(t.b.received.size(), 2U);
}

TEST(CanLine, ALoneStationRepeatsBecomesPassiveAndNeverBusOff) {
  Bench t;
  const NodeId a = t.line.attach("unit1", 500'000, t.a);
  const Frame frame = data_frame(100);
  t.line.send(a, frame, 1);
  // Bits of one attempt: to the acknowledge slot, 6 of error flag, 8 of delimiter, 3 of intermission.
  const Time attempt = (frame_bits(frame) - 3 - 8 + 6 + 8 + 3) * 2000;
  t.queue.run_until(2000 + 16 * attempt - 6000);
  EXPECT_EQ(t.a.failed.size(), 16U);
  EXPECT_EQ(t.line.counters(a).transmit, 128U);
  EXPECT_EQ(t.line.counters(a).state(), ErrorState::Passive);
  t.queue.run_until(kSecond);
  EXPECT_EQ(t.line.counters(a).transmit, 128U);
  EXPECT_TRUE(t.a.sent.empty());
  for (const NotSent reason : t.a.failed) EXPECT_EQ(reason, NotSent::NoAcknowledge);
  // From then on 8 bits of pause more: 2 us + 16 attempts + the rest of the second.
  const Time slow = attempt + 8 * 2000;
  const Time rest = kSecond - 2000 - 16 * attempt;
  EXPECT_NEAR(static_cast<double>(t.a.failed.size()),
              16.0 + static_cast<double>(rest) / static_cast<double>(slow), 1.0);
  EXPECT_EQ(t.watcher.count(LineEventKind::NoAcknowledge),
            1U);  // reported once, told to the sender each time
  EXPECT_EQ(t.watcher.count(LineEventKind::ErrorPassive), 1U);
  EXPECT_EQ(t.line.load(kSecond).frames, 0U);
  EXPECT_GT(t.line.load(kSecond).percent, 90U);
  t.line.withdraw(a, 1);
  const size_t before = t.a.failed.size();
  t.queue.run_until(2 * kSecond);
  EXPECT_LE(t.a.failed.size(), before + 1);
}

// A loss of acknowledge is reported once, and again when there has been a success in between, however long the
// error counter remembers the first one and even when it has been cleared.
TEST(CanLine, EveryLossOfAcknowledgeIsReported) {
  for (const bool cleared : {false, true}) {
    Bench t;
    const NodeId a = t.line.attach("a", 500'000, t.a);
    const NodeId b = t.line.attach("b", 500'000, t.b);
    for (size_t loss = 1; loss <= 4; ++loss) {
      t.line.set_connected(b, false);
      t.line.send(a, data_frame(100), 1);
      t.queue.run_until(t.queue.now() + 5 * kMillisecond);
      EXPECT_EQ(t.watcher.count(LineEventKind::NoAcknowledge), loss) << cleared;
      t.line.withdraw(a, 1);
      t.queue.run_until(t.queue.now() + kMillisecond);
      if (cleared) t.line.restart(a);
      t.line.set_connected(b, true);
      t.line.send(a, data_frame(100), 1);
      t.queue.run_until(t.queue.now() + 5 * kMillisecond);
      EXPECT_EQ(t.a.sent.size(), loss);
    }
  }
}

// Sends at a time, in front of what the line does then.
class Sender final : public EventTarget {
 public:
  Sender(Bench& bench, Time at, NodeId node, const Frame& frame)
      : line_(bench.line), node_(node), frame_(frame) {
    bench.queue.schedule(at, 1, *this, 0);
  }
  void on_event(Time, uint32_t, uint64_t) override { line_.send(node_, frame_, 9); }

 private:
  CanLine& line_;
  NodeId node_;
  Frame frame_;
};

// What is queued within the bit in which a frame begins comes too late for it, also where its identifier is lower:
// what was ready decides. 5 waits behind 200 or 300, all sent by the first or by the last station.
TEST(CanLine, WhatComesInTheBitOfTheStartWaits) {
  for (const NodeId late : {NodeId{0}, NodeId{1}})
    for (const uint32_t ready : {100U, 200U, 300U}) {
      SCOPED_TRACE(testing::Message() << "station " << late << ", " << ready);
      Bench t;
      t.line.attach("a", 500'000, t.a);
      t.line.attach("b", 500'000, t.b);
      t.line.attach("c", 500'000, t.c);
      const NodeId other = 1 - late;
      t.line.send(late, data_frame(ready), 1);
      t.line.send(other, data_frame(200), 2);
      Sender sender(t, 2000, late, data_frame(5));  // the start bit of both
      t.queue.run_until(5 * kMillisecond);
      std::vector<uint32_t> order;
      for (const FrameRecord& record : t.watcher.frames) order.push_back(record.frame.id);
      const std::vector<uint32_t> want = ready == 100   ? std::vector<uint32_t>{100, 5, 200}
                                         : ready == 200 ? std::vector<uint32_t>{200, 5}
                                                        : std::vector<uint32_t>{200, 5, 300};
      EXPECT_EQ(order, want);
      EXPECT_EQ(t.watcher.frames[0].start, 2000);
      EXPECT_EQ(t.watcher.count(LineEventKind::Collision), 0U);
      EXPECT_EQ(t.watcher.count(LineEventKind::SameFrame), ready == 200 ? 1U : 0U);
      EXPECT_EQ(t.watcher.frames[0].sender, ready == 100   ? late
                                            : ready == 200 ? 0
                                                           : other)
          << "of equal frames that of the station attached first";
      EXPECT_EQ(t.a.failed.size() + t.b.failed.size(), 0U);
    }
}

TEST(CanLine, SameIdentifierAndOtherDataCollide) {
  PROVES("DIAG-04");
  Bench t;
  const NodeId a = t.line.attach("unit1", 500'000, t.a);
  const NodeId b = t.line.attach("unit2", 500'000, t.b);
  t.line.attach("unit3", 500'000, t.c);
  t.line.send(a, data_frame(1024, 0x11), 1);
  t.line.send(b, data_frame(1024, 0x44), 2);
  t.queue.run_until(400 * kMicrosecond);
  ASSERT_GE(t.watcher.texts.size(), 2U);
  EXPECT_EQ(t.watcher.count(LineEventKind::Collision) % 2, 0U);
  for (const char* name : {"unit1", "unit2", "1024"})
    EXPECT_NE(t.watcher.texts[0].find(name), std::string::npos);
  EXPECT_TRUE(t.watcher.frames.empty());
  EXPECT_EQ(t.line.counters(a).transmit, t.line.counters(b).transmit);
  EXPECT_EQ(t.line.counters(a).transmit, 8 * t.a.failed.size());
  // 16 times: both error passive. Then the recessive one (0x44 against 0x11) can disturb no more and loses.
  t.queue.run_until(10 * kMillisecond);
  ASSERT_EQ(t.watcher.frames.size(), 2U);
  EXPECT_EQ(t.watcher.frames[0].frame.data[0], 0x11);
  EXPECT_EQ(t.watcher.frames[1].frame.data[0], 0x44);
  EXPECT_EQ(t.a.failed.size(), 16U);
  EXPECT_EQ(t.b.failed.size(), 17U);
  EXPECT_EQ(t.line.counters(a).transmit, 127U);
  EXPECT_EQ(t.c.received.size(), 2U);
  EXPECT_EQ(t.watcher.count(LineEventKind::SameFrame), 0U) << "the frames differ to the end";
}

TEST(CanLine, EqualFramesAtOneTimeGoThroughAndAreReported) {
  Bench t;
  const NodeId a = t.line.attach("unit1", 500'000, t.a);
  const NodeId b = t.line.attach("unit2", 500'000, t.b);
  t.line.attach("unit3", 500'000, t.c);
  t.line.send(a, data_frame(5), 1);
  t.line.send(b, data_frame(5), 2);
  t.queue.run_until(kMillisecond);
  EXPECT_EQ(t.watcher.frames.size(), 1U);
  EXPECT_EQ(t.a.sent.size(), 1U);
  EXPECT_EQ(t.b.sent.size(), 1U);
  EXPECT_EQ(t.c.received.size(), 1U);
  EXPECT_EQ(t.watcher.count(LineEventKind::SameFrame), 1U);
}

// Where everybody sends, nobody listens: that is told, and not that the line were empty.
TEST(CanLine, EqualFramesOfAllStationsGetNoAcknowledge) {
  Bench t;
  t.line.attach("axis1", 500'000, t.a);
  t.line.attach("axis2", 500'000, t.b);
  t.line.attach("axis3", 500'000, t.c);
  for (NodeId node = 0; node < 3; ++node) t.line.send(node, data_frame(1024), 1);
  t.queue.run_until(100 * kMillisecond);
  EXPECT_TRUE(t.watcher.frames.empty());
  EXPECT_EQ(t.watcher.count(LineEventKind::NoAcknowledge), 0U);
  ASSERT_EQ(t.watcher.count(LineEventKind::AllSendTheSame), 1U);
  EXPECT_EQ(
      t.watcher.texts[0],
      "sbus: axis1 gets no acknowledge: all stations that could give it send the same frame at the same "
      "time, identifier 400h (1024), 3 stations from axis1 to axis3");
  // A fourth one acknowledges what they send.
  Station d;
  t.line.attach("unit4", 500'000, d);
  t.queue.run_until(200 * kMillisecond);
  EXPECT_EQ(t.watcher.frames.size(), 1U);
  EXPECT_EQ(t.watcher.count(LineEventKind::SameFrame), 1U);
}

TEST(CanLine, BusOffAfterManyErrorsAndBackByRestart) {
  Bench t;
  const NodeId a = t.line.attach("unit1", 500'000, t.a);
  const NodeId b = t.line.attach("unit2", 500'000, t.b);
  t.line.attach("unit3", 500'000, t.c);
  t.line.set_connected(b, false);
  t.line.set_connected(2, false);
  t.line.send(a, data_frame(1, 0x00), 1);  // alone: error passive, 128
  t.queue.run_until(10 * kMillisecond);
  t.line.withdraw(a, 1);
  t.queue.run_until(20 * kMillisecond);
  t.line.set_connected(b, true);
  t.line.set_connected(2, true);
  // Each round: one collision (+ 8 for both, as unit2 is error active and has the recessive bit), then unit2
  // sends while unit1 pauses, then unit1 (- 1 each). 128 + 7 k + 8 passes 255 in round 19; unit2 stands at
  // 126 before it.
  int rounds = 0;
  while (t.line.counters(a).state() != ErrorState::BusOff && rounds < 100) {
    EXPECT_EQ(t.line.counters(a).transmit, 128U + 7U * static_cast<uint32_t>(rounds));
    EXPECT_EQ(t.line.counters(b).transmit, 7U * static_cast<uint32_t>(rounds));
    t.line.send(a, data_frame(1, 0x00), 1);
    t.line.send(b, data_frame(1, 0x80), 2);
    t.queue.run_until(t.queue.now() + 5 * kMillisecond);
    ++rounds;
  }
  EXPECT_EQ(rounds, 19);
  EXPECT_EQ(t.watcher.count(LineEventKind::BusOff), 1U);
  EXPECT_EQ(t.a.failed.back(), NotSent::Dropped);
  EXPECT_EQ(t.a.sent.size(), 18U);
  EXPECT_EQ(t.b.sent.size(), 19U);
  EXPECT_EQ(t.line.send(a, data_frame(1), 1), SendStatus::NotActive);
  t.line.restart(a);
  EXPECT_EQ(t.line.send(a, data_frame(1), 1), SendStatus::Queued);
  t.queue.run_until(t.queue.now() + 5 * kMillisecond);
  EXPECT_EQ(t.a.sent.size(), 19U);
}

TEST(CanLine, ACutOffStationHearsAndSaysNothing) {
  Bench t;
  const NodeId a = t.line.attach("unit1", 500'000, t.a);
  const NodeId b = t.line.attach("unit2", 500'000, t.b);
  t.line.attach("unit3", 500'000, t.c);
  t.line.send(b, data_frame(9), 4);
  t.line.set_connected(b, false);
  EXPECT_EQ(t.b.failed, std::vector<NotSent>{NotSent::Dropped});
  EXPECT_EQ(t.watcher.count(LineEventKind::NotConnected), 1U);
  t.line.send(a, data_frame(2), 0);
  t.queue.run_until(kMillisecond);
  EXPECT_TRUE(t.b.received.empty());
  EXPECT_EQ(t.c.received.size(), 1U);
}

TEST(CanLine, LoadCountsStuffedBitsPerSecond) {
  Bench t;
  const NodeId a = t.line.attach("a", 500'000, t.a);
  t.line.attach("b", 500'000, t.b);
  const Frame frame = data_frame(0x555, 0x55);
  const uint32_t bits = frame_bits(frame);
  // Second 0: idle. Second 1: 1000 frames. Second 2: 10 frames.
  for (int i = 0; i < 1000; ++i) {
    t.queue.run_until(kSecond + i * kMillisecond);
    t.line.send(a, frame, 0);
  }
  for (int i = 0; i < 10; ++i) {
    t.queue.run_until(2 * kSecond + i * kMillisecond);
    t.line.send(a, frame, 0);
  }
  t.queue.run_until(2 * kSecond + 500 * kMillisecond);
  LineLoad load = t.line.load(t.queue.now());
  EXPECT_EQ(load.frames, 1010U);
  EXPECT_EQ(load.busy_bits, 1010U * bits);
  EXPECT_EQ(load.elapsed_bits, 1'250'000U);
  EXPECT_EQ(load.percent, 1010U * bits * 100 / 1'250'000);
  EXPECT_EQ(load.window_percent, 1000U * bits * 100 / 500'000);
  EXPECT_EQ(load.peak_window_percent, load.window_percent);
  t.queue.run_until(3 * kSecond + 1);
  load = t.line.load(t.queue.now());
  EXPECT_EQ(load.window_percent, 10U * bits * 100 / 500'000);
  EXPECT_EQ(load.peak_window_percent, 1000U * bits * 100 / 500'000);
  t.queue.run_until(9 * kSecond);
  EXPECT_EQ(t.line.load(t.queue.now()).window_percent, 0U);
}

// Comes again and again and does nothing but keep transfers from ending in the step in which they begin.
struct Interruption final : EventTarget {
  EventQueue& queue;
  Time every;
  Interruption(EventQueue& of, Time time) : queue(of), every(time) { queue.schedule(0, 99, *this, 0); }
  void on_event(Time now, uint32_t, uint64_t) override { queue.schedule(now + every, 99, *this, 0); }
};

// All that nodes and observers hear of 2000 frames of five nodes, with answers and frames that come again.
std::vector<std::pair<Time, Frame>> story(Time interrupted_every) {
  Bench t;
  Station d, e;
  std::vector<NodeId> nodes;
  for (Station* station : {&t.a, &t.b, &t.c, &d, &e}) nodes.push_back(t.line.attach("n", 500'000, *station));
  LinePort port(t.line, nodes[1]);
  t.b.port = &port;
  t.b.reply = data_frame(12);
  std::optional<Interruption> interruption;
  if (interrupted_every != 0) interruption.emplace(t.queue, interrupted_every);
  Random random(1);
  for (Time at = 0; at < kSecond;) {
    at += random.below(800 * kMicrosecond);
    t.queue.run_until(at);
    t.b.reply_on = random.below(4) == 0;
    for (uint32_t n = random.below(4); n-- > 0;) {
      const uint32_t sender = random.below(5);
      t.line.send(nodes[sender], data_frame(100 * sender + random.below(3), random.below(2) != 0), n);
      if (random.below(8) == 0) t.line.withdraw(nodes[sender], n);
    }
  }
  t.queue.run_until(2 * kSecond);
  std::vector<std::pair<Time, Frame>> told;
  for (const FrameRecord& record : t.watcher.frames) {
    told.emplace_back(record.start, record.frame);
    told.emplace_back(record.end, Frame{record.bits, 0});
  }
  for (const Station* station : {&t.a, &t.b, &t.c, &d, &e}) {
    for (const Station::Got& got : station->received) told.emplace_back(got.time, got.frame);
    for (const Station::Got& got : station->sent) told.emplace_back(got.time, got.frame);
  }
  const LineLoad load = t.line.load(t.queue.now());
  told.emplace_back(static_cast<Time>(load.busy_bits), Frame{static_cast<uint32_t>(load.frames), 0});
  return told;
}

TEST(CanLine, EventsWithinTransfersChangeNothing) {
  const auto alone = story(0);
  EXPECT_GT(alone.size(), 2000U);
  for (const Time every : {kMicrosecond, 37 * kMicrosecond, 200 * kMicrosecond})
    EXPECT_EQ(story(every), alone);
}

TEST(CanLine, WhoWatchesTheLineAloneHearsItsEvents) {
  struct : LineObserver {
    void on_line_event(const CanLine&, const LineEvent& event) override { kinds.push_back(event.kind); }
    std::vector<LineEventKind> kinds;
  } observer;
  Bench t;
  t.line.add_observer(observer);
  const NodeId a = t.line.attach("a", 500'000, t.a);
  t.line.attach("b", 125'000, t.b);
  t.line.send(a, data_frame(1024), 0);
  t.queue.run_until(kMillisecond);
  EXPECT_EQ(observer.kinds, (std::vector{LineEventKind::WrongBaudRate, LineEventKind::Disturbs}));
}

}  // namespace
}  // namespace ipos::runtime
