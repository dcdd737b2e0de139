// Planted faults of the line: what a struck frame is to its sender and to each listener, error counters,
// bus-off and the way back, cut cables; lengths against an independent bit model.
#include <gtest/gtest.h>

#include <random>

#include "runtime/bus/can/bit_error.hpp"
#include "runtime/bus/can/frame_bits.hpp"
#include "runtime/bus/can/line.hpp"
#include "tests/runtime/bus/disturbance_model.hpp"

namespace ipos::runtime {
namespace {

class Station final : public CanNode {
 public:
  void on_frame(Time now, const Frame& frame) override {
    received.push_back(frame);
    times.push_back(now);
  }
  void on_sent(Time now, const Frame&, uint64_t) override { sent.push_back(now); }
  void on_not_sent(Time, const Frame&, uint64_t, NotSent reason) override { failed.push_back(reason); }
  void on_bus_off(Time) override {
    ++bus_off;
    if (line != nullptr) line->recover(node);
  }
  std::vector<Frame> received;
  std::vector<Time> times;
  std::vector<Time> sent;
  std::vector<NotSent> failed;
  int bus_off = 0;
  CanLine* line = nullptr;  // set: asks for recovery
  NodeId node = 0;
};

class Watcher final : public CanObserver {
 public:
  void on_frame(const CanLine&, const FrameRecord& record) override { frames.push_back(record); }
  void on_line_event(const CanLine& line, const LineEvent& event) override {
    events.push_back(event);
    texts.push_back(describe(line, event));
  }
  bool says(const std::string& part) const {
    for (const std::string& text : texts)
      if (text.find(part) != std::string::npos) return true;
    return false;
  }
  std::vector<FrameRecord> frames;
  std::vector<LineEvent> events;
  std::vector<std::string> texts;
};

struct Bench {
  EventQueue queue;
  CanLine line{queue, 9, "sbus", 500'000};
  Watcher watcher;
  Station stations[4];
  Bench() {
    line.add_observer(watcher);
    for (int n = 0; n < 4; ++n)
      stations[n].node = line.attach("unit" + std::to_string(n + 1), 500'000, stations[n]);
  }
  LineFault fault(FaultKind kind, uint64_t frame = 1) {
    LineFault planted;
    planted.kind = kind;
    planted.frame = frame;
    return planted;
  }
  void send(NodeId node, uint32_t id, uint8_t first = 0) {
    line.send(node, {id, 8, {first, 2, 3, 4, 5, 6, 7, 8}, false, false}, 1);
  }
  void run(Time span) { queue.run_until(queue.now() + span); }
};

Frame random_frame(std::mt19937& random) {
  Frame frame;
  frame.extended = random() % 4 == 0;
  frame.remote = random() % 8 == 0;
  frame.id = static_cast<uint32_t>(random() % (frame.extended ? kExtendedIdLimit : kStandardIdLimit));
  frame.length = static_cast<uint8_t>(random() % 9);
  for (size_t n = 0; n < frame.length && !frame.remote; ++n)
    frame.data[n] =
        random() % 2 == 0 ? static_cast<uint8_t>(random() % 2 * 255) : static_cast<uint8_t>(random());
  return frame;
}

TEST(LineFault, DisturbedFramesLastAsLongAsInTheBitModel) {
  std::mt19937 random(8);
  size_t compared = 0;
  for (int i = 0; i < 4000; ++i) {
    const Frame frame = random_frame(random);
    const std::string wire = tests::wire(frame);
    const uint64_t chance = random();
    const uint32_t bit = disturbed_bit(wire_bits(frame), frame.extended, chance);
    ASSERT_GT(bit, frame.extended ? 32U : 13U);
    ASSERT_LT(bit, wire.size() - 10);
    const int who = static_cast<int>(random() % 3) - 1;  // all, the sender, listener 1
    const bool sender_active = who == 1 || random() % 4 != 0;
    const tests::Disturbed model = tests::disturb(wire, bit, who, {sender_active, true, true});
    if (who == 1 && model.received[0]) continue;  // a CRC that fits by chance: not modelled by the line
    KnownFrames known;
    Transfer transfer;
    transfer.senders = {{0, frame, 0, sender_active, false}};
    transfer.fault.kind = FaultKind::Corrupt;
    transfer.fault.node = who == -1 ? kNoNode : static_cast<NodeId>(who);
    transfer.fault.chance = chance;
    resolve(transfer, {true, true, who == 1, who == 1, true}, known);
    if (model.received[0]) {  // a passive sender that stops where the frame is recessive anyway
      ASSERT_EQ(transfer.outcome, Transfer::Outcome::Repeated) << wire << ' ' << bit << ' ' << who;
      continue;
    }
    ASSERT_EQ(transfer.outcome, Transfer::Outcome::Corrupted);
    ASSERT_EQ(transfer.end, model.end) << wire << ' ' << bit << ' ' << who << ' ' << sender_active;
    ASSERT_EQ(transfer.bits, transfer.end + 3);
    ASSERT_FALSE(model.received[0]);
    ASSERT_FALSE(model.received[1]);
    ASSERT_FALSE(model.sender_content);
    ++compared;
  }
  EXPECT_GT(compared, 3900U);
}

TEST(LineFault, AFrameWithADisturbedLastBitIsThereTwiceInTheModelToo) {
  std::mt19937 random(9);
  for (int i = 0; i < 200; ++i) {
    const Frame frame = random_frame(random);
    const std::string wire = tests::wire(frame);
    const tests::Disturbed model = tests::disturb(wire, wire.size() - 1, 0, {true, true});
    EXPECT_TRUE(model.received[0]);
    EXPECT_FALSE(model.sender_content);
  }
}

TEST(LineFault, CorruptedFrameIsRepeated) {
  Bench t;
  t.line.plant(t.fault(FaultKind::Corrupt, 2));
  t.send(0, 100);
  t.send(0, 101);
  t.run(2 * kMillisecond);
  EXPECT_EQ(t.stations[1].received.size(), 2U);
  EXPECT_EQ(t.stations[0].sent.size(), 2U);
  EXPECT_EQ(t.stations[0].failed, std::vector<NotSent>{NotSent::Corrupted});
  EXPECT_EQ(t.line.counters(0).transmit, 7U);  // + 8, then a success
  EXPECT_EQ(t.line.counters(1).receive, 0U);   // + 1, then a success
  EXPECT_EQ(t.watcher.frames.size(), 2U);
  EXPECT_TRUE(
      t.watcher.says("sbus: planted fault 'corrupt': the line has a disturbed bit, identifier 065h (101)"));
}

TEST(LineFault, OneListenerWithABitErrorMakesAllRepeatAndCountsForItself) {
  Bench t;
  LineFault fault = t.fault(FaultKind::Corrupt);
  fault.node = 2;
  t.line.plant(fault);
  t.send(0, 100);
  t.run(300 * kMicrosecond);
  EXPECT_TRUE(t.stations[1].received.empty());
  EXPECT_EQ(t.line.counters(2).receive, 9U);  // its flag was the first: + 1 + 8
  EXPECT_EQ(t.line.counters(1).receive, 1U);
  EXPECT_EQ(t.line.counters(0).transmit, 8U);
  t.run(kMillisecond);
  for (int n = 1; n < 4; ++n) EXPECT_EQ(t.stations[n].received.size(), 1U);
}

TEST(LineFault, AnErrorPassiveListenerLosesTheFrameAlone) {
  Bench t;
  LineFault fault = t.fault(FaultKind::Corrupt, 0);  // every frame
  fault.node = 2;
  fault.until = 10 * kMillisecond;
  t.line.plant(fault);
  for (uint32_t n = 0; n < 20; ++n) {
    t.send(0, 100);
    t.run(kMillisecond);
  }
  // 9 for each failure, all of them of the first frame, until it is passive at 135; from then on the frames
  // pass.
  EXPECT_EQ(t.stations[1].received.size(), 20U);
  EXPECT_LT(t.stations[2].received.size(), 20U);
  EXPECT_GT(t.stations[2].received.size(), 9U);
  EXPECT_EQ(t.stations[0].failed.size(), 15U);
  EXPECT_TRUE(t.watcher.says("unit3 is error passive"));
}

TEST(LineFault, DropIsAcknowledgedAndReachesNobody) {
  Bench t;
  t.line.plant(t.fault(FaultKind::Drop));
  t.send(0, 100);
  t.run(kMillisecond);
  EXPECT_EQ(t.stations[0].sent.size(), 1U);
  for (int n = 1; n < 4; ++n) EXPECT_TRUE(t.stations[n].received.empty());
  EXPECT_EQ(t.watcher.frames.size(), 1U);  // it was on the wire
  LineFault fault = t.fault(FaultKind::Drop);
  fault.node = 1;
  t.line.plant(fault);
  t.send(0, 100);
  t.run(kMillisecond);
  EXPECT_TRUE(t.stations[1].received.empty());
  EXPECT_EQ(t.stations[2].received.size(), 1U);
}

TEST(LineFault, DelayHoldsAFrameBackAndLetsOthersOvertake) {
  Bench t;
  LineFault fault = t.fault(FaultKind::Delay);
  fault.lag = 3 * kMillisecond;
  t.line.plant(fault);
  t.send(0, 100);
  t.send(0, 101);
  t.run(10 * kMillisecond);
  ASSERT_EQ(t.stations[1].received.size(), 2U);
  EXPECT_EQ(t.stations[1].received[0].id, 101U);
  EXPECT_EQ(t.stations[1].received[1].id, 100U);
  EXPECT_EQ(t.stations[1].times[1], t.watcher.frames[0].end + 3 * kMillisecond);
  EXPECT_EQ(t.stations[0].sent.size(), 2U);
}

TEST(LineFault, DuplicateComesTwiceAndCostsTheSender) {
  Bench t;
  t.line.plant(t.fault(FaultKind::Duplicate));
  t.send(0, 100);
  t.run(2 * kMillisecond);
  ASSERT_EQ(t.stations[1].received.size(), 2U);
  EXPECT_EQ(t.stations[1].received[0], t.stations[1].received[1]);
  EXPECT_EQ(t.stations[0].sent.size(), 1U);
  EXPECT_EQ(t.line.counters(0).transmit, 7U);
  // Overload flag of one bit more, delimiter, intermission.
  EXPECT_EQ(t.watcher.frames[1].start, t.watcher.frames[0].end + (1 + 6 + 8 + 3) * 2000);
}

TEST(LineFault, RateAndSeedDecideAndRepeat) {
  std::vector<size_t> counts;
  std::vector<std::vector<Time>> runs;
  for (const uint64_t seed : {1U, 1U, 2U}) {
    Bench t;
    LineFault fault = t.fault(FaultKind::Drop, 0);
    fault.per_mille = 200;
    fault.seed = seed;
    fault.id = 100;
    t.line.plant(fault);
    for (int n = 0; n < 1000; ++n) {
      t.send(0, 100);
      t.send(0, 101);
      t.run(kMillisecond);
    }
    std::vector<Time> times;
    for (size_t i = 0; i < t.stations[1].received.size(); ++i)
      if (t.stations[1].received[i].id == 100) times.push_back(t.stations[1].times[i]);
    EXPECT_EQ(t.stations[1].received.size() - times.size(), 1000U);
    counts.push_back(times.size());
    runs.push_back(times);
  }
  EXPECT_EQ(runs[0], runs[1]);
  EXPECT_NE(runs[0], runs[2]);
  for (const size_t count : counts) EXPECT_NEAR(static_cast<double>(count), 800, 60);  // 5 sigma
}

TEST(LineFault, FromAndUntilBoundTheFault) {
  Bench t;
  LineFault fault = t.fault(FaultKind::Drop, 0);
  fault.from = 3 * kMillisecond;
  fault.until = 6 * kMillisecond;
  t.line.plant(fault);
  for (int n = 0; n < 9; ++n) {
    t.send(0, 100);
    t.run(kMillisecond);
  }
  EXPECT_EQ(t.stations[1].received.size(), 6U);
}

TEST(LineFault, ACutLineIsTwoLines) {
  Bench t;
  LineFault fault = t.fault(FaultKind::Cut);
  fault.node = 1;
  fault.behind = true;
  fault.from = kMillisecond;
  fault.until = 5 * kMillisecond;
  t.line.plant(fault);
  t.run(2 * kMillisecond);
  EXPECT_TRUE(t.line.is_reachable(0, 1));
  EXPECT_FALSE(t.line.is_reachable(1, 2));
  t.send(0, 100);
  t.send(3, 200);
  t.run(kMillisecond);
  ASSERT_EQ(t.stations[1].received.size(), 1U);
  EXPECT_EQ(t.stations[1].received[0].id, 100U);
  ASSERT_EQ(t.stations[2].received.size(), 1U);
  EXPECT_EQ(t.stations[2].received[0].id, 200U);
  // Both at the same time: they do not arbitrate.
  EXPECT_EQ(t.watcher.frames[0].start, t.watcher.frames[1].start);
  EXPECT_TRUE(t.watcher.says("planted fault 'cut': the line is cut behind unit2"));
  t.run(3 * kMillisecond);
  t.send(0, 100);
  t.run(kMillisecond);
  for (int n = 1; n < 4; ++n) EXPECT_EQ(t.stations[n].received.back().id, 100U);
  EXPECT_TRUE(t.line.is_reachable(0, 3));
}

TEST(LineFault, CutAndRepairWaitForTheFramesUnderWay) {
  for (Time at = 0; at < 400 * kMicrosecond; at += 7 * kMicrosecond) {
    Bench t;
    LineFault fault = t.fault(FaultKind::Cut);
    fault.node = 1;
    fault.behind = true;
    fault.from = at;
    fault.until = at + 1100 * kMicrosecond;
    t.line.plant(fault);
    for (uint32_t n = 0; n < 12; ++n) t.send(n % 4, 100 + n);
    t.run(20 * kMillisecond);
    size_t sent = 0;
    for (const Station& station : t.stations) sent += station.sent.size();
    EXPECT_EQ(sent, 12U) << at;
    EXPECT_EQ(t.watcher.frames.size(), 12U);
  }
}

TEST(LineFault, AStationCutOffAloneGetsNoAcknowledge) {
  Bench t;
  LineFault fault = t.fault(FaultKind::Cut);
  fault.node = 3;
  fault.from = kMillisecond;
  t.line.plant(fault);
  t.run(2 * kMillisecond);
  EXPECT_EQ(t.line.send(3, {1, 0, {}, false, false}, 1), SendStatus::NotActive);
  EXPECT_TRUE(t.watcher.says("unit4 takes no part: it is not connected to the line"));
}

TEST(LineFault, SwappedWiresSilenceOneStation) {
  Bench t;
  LineFault fault = t.fault(FaultKind::Swap);
  fault.node = 2;
  t.line.plant(fault);
  t.run(kMillisecond);
  t.send(0, 100);
  t.run(kMillisecond);
  EXPECT_TRUE(t.stations[2].received.empty());
  EXPECT_EQ(t.stations[1].received.size(), 1U);
  EXPECT_TRUE(t.watcher.says("unit3 has high and low interchanged"));
}

TEST(LineFault, ShortCircuitEndsInBusOffAndTheStationComesBack) {
  Bench t;
  t.stations[0].line = &t.line;
  LineFault fault = t.fault(FaultKind::Short);
  fault.until = 3 * kMillisecond;
  t.line.plant(fault);
  t.run(kMicrosecond);
  t.send(0, 100);
  // 32 attempts: 16 of 1 + 6 + 8 + 3 bits, 16 with 8 bits of pause. Bus-off after about 1.4 ms.
  t.run(2 * kMillisecond);
  EXPECT_EQ(t.stations[0].bus_off, 1);
  EXPECT_EQ(t.stations[0].failed.size(), 33U);
  EXPECT_EQ(t.stations[0].failed.back(), NotSent::Dropped);
  EXPECT_EQ(t.line.send(0, {100, 0, {}, false, false}, 1), SendStatus::NotActive);
  EXPECT_TRUE(t.stations[1].received.empty());
  EXPECT_EQ(t.line.counters(1).receive, 0U);  // the others hear nothing
  // 128 runs of 11 bits of 2 us: 2.816 ms after bus-off it is back.
  Time bus_off = 0;
  for (const LineEvent& event : t.watcher.events)
    if (event.kind == LineEventKind::BusOff) bus_off = event.time;
  t.run(10 * kMillisecond);
  ASSERT_TRUE(t.watcher.says("unit1 is back on the line after bus-off"));
  for (const LineEvent& event : t.watcher.events)
    if (event.kind == LineEventKind::Recovered) {
      EXPECT_NEAR(static_cast<double>(event.time - bus_off), 2'816'000, 2'000);
    }
  t.send(0, 100);
  t.run(kMillisecond);
  EXPECT_EQ(t.stations[1].received.size(), 1U);
}

// Frame on frame of two others: each holds one run of 11 recessive bits, and 128 bring a station back.
void expect_return_among(Bench& t, NodeId one, NodeId other) {
  const size_t before = t.watcher.frames.size();
  for (int n = 0; n < 400 && !t.watcher.says("back on the line"); ++n) {
    t.send(one, 200);
    t.send(other, 201);
    t.run(static_cast<Time>(frame_bits({200, 8, {0, 2, 3, 4, 5, 6, 7, 8}, false, false})) * 2 * 2000);
  }
  const size_t frames = t.watcher.frames.size() - before;
  EXPECT_GT(frames, 100U);
  EXPECT_LT(frames, 135U);
}

TEST(LineFault, RecoveryOnABusyLineTakesARunAFrame) {
  Bench t;
  t.stations[0].line = &t.line;
  LineFault fault = t.fault(FaultKind::Short);
  fault.until = 1500 * kMicrosecond;
  t.line.plant(fault);
  t.run(kMicrosecond);
  t.send(0, 100);
  t.run(1500 * kMicrosecond);
  ASSERT_EQ(t.stations[0].bus_off, 1);
  expect_return_among(t, 1, 2);
}

// Frames that nothing had disturbed went before.
TEST(LineFault, AFaultPlantedLaterStrikes) {
  Bench t;
  t.send(0, 100);
  t.run(kMillisecond);
  t.line.plant(t.fault(FaultKind::Corrupt));
  t.send(0, 101);
  t.run(kMillisecond);
  EXPECT_EQ(t.stations[0].sent.size(), 2U);
  EXPECT_EQ(t.stations[0].failed, std::vector<NotSent>{NotSent::Corrupted});
}

// Nothing was planted: passive for want of an acknowledge, station 1 loses collisions against station 0 until
// it is bus-off. The others have no error counter then.
TEST(LineFault, RecoveryAmongSoundStationsTakesARunAFrame) {
  Bench t;
  for (const NodeId other : {0U, 2U, 3U}) t.line.set_connected(other, false);
  t.send(1, 1, 0x80);
  t.run(10 * kMillisecond);
  t.line.withdraw(1, 1);
  t.line.set_connected(0, true);
  for (int n = 0; n < 100 && t.stations[1].bus_off == 0; ++n) {
    t.send(0, 1, 0x00);
    t.send(1, 1, 0x80);
    t.run(5 * kMillisecond);
  }
  ASSERT_EQ(t.stations[1].bus_off, 1);
  t.line.set_connected(2, true);
  t.line.set_connected(3, true);
  t.send(2, 300);
  t.run(kMillisecond);
  t.line.recover(1);
  expect_return_among(t, 2, 3);
}

TEST(LineFault, ALineHeldDominantCarriesNothingAndRecovers) {
  Bench t;
  LineFault fault = t.fault(FaultKind::Stuck);
  fault.from = kMillisecond;
  fault.until = 5 * kMillisecond;
  t.line.plant(fault);
  t.run(2 * kMillisecond);
  t.send(0, 100);
  t.run(2 * kMillisecond);
  EXPECT_TRUE(t.watcher.frames.empty());
  EXPECT_TRUE(t.watcher.says("unit2 is error passive"));
  t.run(2 * kMillisecond);
  ASSERT_EQ(t.watcher.frames.size(), 1U);
  EXPECT_GE(t.watcher.frames[0].start, 5 * kMillisecond);
  EXPECT_EQ(t.line.counters(1).state(), ErrorState::Active);
}

// The line is held dominant while a frame is under way, which is still carried to its end (ours). Its sender is
// error-passive then, so it pauses for 8 bits behind the intermission before it sends again (ISO 11898-1, suspend
// transmission).
TEST(LineFault, ASenderThatBecomesPassiveInItsFramePausesBehindIt) {
  Bench t;
  const Time bit = t.line.bit_time();
  t.send(0, 100);
  t.send(0, 101);
  t.run(10 * bit);
  LineFault fault = t.fault(FaultKind::Stuck);
  fault.from = 20 * bit;
  fault.until = 30 * bit;
  t.line.plant(fault);
  t.run(kMillisecond);
  ASSERT_EQ(t.watcher.frames.size(), 2U);
  EXPECT_EQ(t.watcher.frames[0].start, bit);
  EXPECT_EQ(t.watcher.frames[1].start, t.watcher.frames[0].start + (t.watcher.frames[0].bits + 8) * bit);
  EXPECT_EQ(t.line.counters(0).state(), ErrorState::Passive);
}

}  // namespace
}  // namespace ipos::runtime
