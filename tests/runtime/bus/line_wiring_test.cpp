// Who takes part in a CAN line, and when to the bit: stations plugged in later, cut lines, a line held dominant, the way
// back from bus-off, pauses of error-passive senders, and the order in which all are told.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "runtime/bus/can/frame_bits.hpp"
#include "runtime/bus/can/line.hpp"

namespace ipos::tests {
namespace {

using namespace ipos::runtime;  // NOLINT

using Told = std::vector<std::string>;

// A station that writes what it is told behind the others.
class Teller final : public CanNode {
 public:
  Teller(std::string name, Told& told) : name_(std::move(name)), told_(told) {}
  void on_frame(Time now, const Frame& frame) override {
    tell("hears", frame);
    heard.emplace_back(now, frame.id);
  }
  void on_sent(Time, const Frame& frame, uint64_t) override { tell("has sent", frame); }
  void on_not_sent(Time, const Frame& frame, uint64_t, NotSent reason) override {
    tell(reason == NotSent::Dropped ? "drops" : "fails", frame);
  }
  void on_bus_off(Time) override { told_.push_back(name_ + " is bus-off"); }
  std::vector<uint32_t> ids() const {
    std::vector<uint32_t> all;
    for (const auto& [time, id] : heard) all.push_back(id);
    return all;
  }
  std::vector<std::pair<Time, uint32_t>> heard;

 private:
  void tell(const char* what, const Frame& frame) {
    told_.push_back(name_ + " " + what + " " + std::to_string(frame.id));
  }
  std::string name_;
  Told& told_;
};

struct WiringBench final : CanObserver {
  EventQueue queue;
  CanLine line{queue, 9, "sbus", 500'000};
  Told told;
  std::vector<FrameRecord> frames;
  std::vector<LineEvent> events;
  std::vector<std::unique_ptr<Teller>> stations;
  const Time bit = 2 * kMicrosecond;

  WiringBench() {
    line.add_observer(*this);
    for (int n = 0; n < 4; ++n) plug();
  }
  NodeId plug() {
    const std::string name = "unit" + std::to_string(stations.size() + 1);
    stations.push_back(std::make_unique<Teller>(name, told));
    return line.attach(name, 500'000, *stations.back());
  }
  void on_frame(const CanLine&, const FrameRecord& record) override {
    told.push_back("the line carries " + std::to_string(record.frame.id));
    frames.push_back(record);
  }
  void on_line_event(const CanLine& of, const LineEvent& event) override {
    told.push_back(describe(of, event));
    events.push_back(event);
  }
  void send(NodeId node, uint32_t id, uint64_t tag = 1) {
    EXPECT_EQ(line.send(node, {id, 2, {1, 2}}, tag), SendStatus::Queued);
  }
  void plant(FaultKind kind, Time from, Time until, NodeId node = kNoNode, bool behind = false) {
    LineFault fault;
    fault.kind = kind;
    fault.from = from;
    fault.until = until;
    fault.node = node;
    fault.behind = behind;
    line.plant(fault);
  }
  void run(Time span) { queue.run_until(queue.now() + span); }
  Told take() { return std::exchange(told, {}); }
  std::vector<uint32_t> carried() const {
    std::vector<uint32_t> all;
    for (const FrameRecord& record : frames) all.push_back(record.frame.id);
    return all;
  }
  // Of this kind: when.
  std::vector<Time> times(LineEventKind kind) const {
    std::vector<Time> all;
    for (const LineEvent& event : events)
      if (event.kind == kind) all.push_back(event.time);
    return all;
  }
  // Without any level the station is bus-off after 32 attempts.
  void drive_bus_off(NodeId node) {
    plant(FaultKind::Short, queue.now(), queue.now() + 2 * kMillisecond);
    run(kMicrosecond);
    send(node, 100);
    run(5 * kMillisecond);
    ASSERT_FALSE(line.is_active(node));
  }
};
using WiringIds = std::vector<uint32_t>;

TEST(LineWiring, ObserversFirstThenReceiversInOrderThenTheSender) {
  for (const bool extended : {false, true}) {
    WiringBench t;
    Frame frame{5, 1, {9}, extended};
    t.line.send(1, frame, 1);
    t.run(kMillisecond);
    EXPECT_EQ(t.take(), (Told{"the line carries 5", "unit1 hears 5", "unit3 hears 5", "unit4 hears 5",
                              "unit2 has sent 5"}));
    ASSERT_EQ(t.frames.size(), 1U);
    const FrameRecord& record = t.frames[0];
    EXPECT_EQ(record.sender, 1U);
    EXPECT_EQ(record.frame, frame);
    EXPECT_EQ(record.bits, frame_bits(frame));
    EXPECT_EQ(record.start, t.bit);
    EXPECT_EQ(record.end, record.start + static_cast<Time>(frame_bits(frame) - 3) * t.bit);
    EXPECT_EQ(t.stations[0]->heard[0].first, record.end);
  }
}

TEST(LineWiring, OneThatComesLaterSitsAtTheEnd) {
  WiringBench t;
  t.plant(FaultKind::Cut, kMillisecond, 5 * kMillisecond, 1, true);
  t.run(2 * kMillisecond);
  const NodeId later = t.plug();
  EXPECT_EQ(later, 4U);
  EXPECT_EQ(t.line.node_count(), 5U);
  EXPECT_EQ(t.line.node_name(later), "unit5");
  for (const NodeId other : {0U, 1U, 2U, 3U}) {
    EXPECT_EQ(t.line.is_reachable(later, other), other > 1) << other;
    EXPECT_EQ(t.line.is_reachable(other, later), other > 1) << other;
  }
  t.send(0, 100);
  t.send(3, 200);
  t.run(kMillisecond);
  EXPECT_EQ(t.stations[later]->ids(), WiringIds{200});
  t.run(3 * kMillisecond);
  t.send(later, 300);
  t.run(kMillisecond);
  EXPECT_EQ(t.stations[0]->ids(), WiringIds{300}) << "the cut is mended";
}

// A cut behind the first and one behind the third: three lines, each of which goes on by itself.
void expect_three_lines(bool passive) {
  WiringBench t;
  t.plug();
  if (passive)
    t.plant(FaultKind::Stuck, 0, 20 * t.bit);  // then each frame counts down the errors of who hears it
  t.plant(FaultKind::Cut, 0, 10 * kMillisecond, 2, true);
  t.plant(FaultKind::Cut, 0, 20 * kMillisecond, 0, true);
  t.run(kMillisecond);
  const int segment[] = {0, 1, 1, 2, 2};
  for (NodeId a = 0; a < 5; ++a)
    for (NodeId b = 0; b < 5; ++b) EXPECT_EQ(t.line.is_reachable(a, b), segment[a] == segment[b]) << a << b;
  t.take();
  t.send(1, 100);
  t.send(4, 100);
  t.run(kMillisecond);
  EXPECT_EQ(t.take(), (Told{"the line carries 100", "unit3 hears 100", "unit2 has sent 100",
                            "the line carries 100", "unit4 hears 100", "unit5 has sent 100"}));
  t.run(9 * kMillisecond);
  for (NodeId a = 0; a < 5; ++a)
    for (NodeId b = 0; b < 5; ++b) EXPECT_EQ(t.line.is_reachable(a, b), (a == 0) == (b == 0)) << a << b;
  t.run(10 * kMillisecond);
  EXPECT_TRUE(t.line.is_reachable(0, 4));
}

TEST(LineWiring, TwoCutsMakeThreeLines) {
  for (const bool passive : {false, true}) expect_three_lines(passive);
}

TEST(LineWiring, WhoLeavesDropsWhatWaits) {
  for (const bool by_rate : {false, true}) {
    WiringBench t;
    t.send(1, 300);
    t.send(1, 200);
    t.send(2, 250);
    by_rate ? t.line.set_baud(1, 125'000) : t.line.set_connected(1, false);
    EXPECT_FALSE(t.line.has_waiting(1));
    EXPECT_TRUE(t.line.has_waiting(2));
    const std::string why = by_rate ? "its baud rate is not that of the line (125 kbaud, line 500 kbaud)"
                                    : "it is not connected to the line";
    EXPECT_EQ(t.take(), (Told{"unit2 drops 200", "unit2 drops 300", "sbus: unit2 takes no part: " + why}));
    EXPECT_EQ(t.line.node_baud(1), by_rate ? 125'000U : 500'000U);
    t.run(kMillisecond);
    EXPECT_EQ(t.carried(), by_rate ? WiringIds{} : WiringIds{250}) << "at another rate it destroys what the others send";
    EXPECT_TRUE(t.stations[1]->heard.empty());
    EXPECT_FALSE(t.line.is_active(1));
    t.take();
    by_rate ? t.line.set_baud(1, 500'000) : t.line.set_connected(1, true);
    EXPECT_EQ(t.take(), Told{}) << "nothing is wrong with it";
    t.send(0, 7);
    t.run(kMillisecond);
    EXPECT_EQ(t.stations[1]->ids(), by_rate ? (WiringIds{7, 250}) : WiringIds{7});
  }
}

// Late frames go where the frame went, to who is there when they come.
TEST(LineWiring, LateFramesGoToTheirPartOfTheLine) {
  WiringBench t;
  LineFault delay;
  delay.kind = FaultKind::Delay;
  delay.lag = 3 * kMillisecond;
  delay.frame = 1;
  t.line.plant(delay);
  t.plant(FaultKind::Cut, 2 * kMillisecond, 4 * kMillisecond, 1, true);
  t.send(0, 100);
  t.run(10 * kMillisecond);
  EXPECT_EQ(t.stations[1]->ids(), WiringIds{100});
  for (const size_t n : {0U, 2U, 3U}) EXPECT_TRUE(t.stations[n]->heard.empty()) << n;
  delay.from = 10 * kMillisecond;
  t.line.plant(delay);
  t.send(3, 101);
  t.run(kMillisecond);
  t.line.set_connected(1, false);
  t.run(5 * kMillisecond);
  EXPECT_EQ(t.stations[0]->ids(), WiringIds{101});
  EXPECT_EQ(t.stations[1]->ids(), WiringIds{100}) << "it has left";
  EXPECT_EQ(t.stations[2]->ids(), WiringIds{101});
}

// Several frames late at once, each with its own time.
TEST(LineWiring, ManyLateFramesEachComeOnce) {
  WiringBench t;
  LineFault delay;
  delay.kind = FaultKind::Delay;
  delay.lag = 5 * kMillisecond;
  t.line.plant(delay);
  for (uint32_t n = 0; n < 12; ++n) {
    t.send(n % 2, 100 + n);
    t.run(kMillisecond);
  }
  t.run(10 * kMillisecond);
  ASSERT_EQ(t.frames.size(), 12U);
  ASSERT_EQ(t.stations[2]->heard.size(), 12U);
  for (uint32_t n = 0; n < 12; ++n) {
    EXPECT_EQ(t.stations[2]->heard[n].second, 100 + n);
    EXPECT_EQ(t.stations[2]->heard[n].first, t.frames[n].end + delay.lag);
  }
}

// --- a line held dominant

// Behind it an error delimiter of 8 bits and the intermission of 3; every station has made 15 steps of 9 (1 for its
// error, 8 for each 8 bits more), which is above 127 (ISO 11898-1).
TEST(LineWiring, HeldDominantEveryStationIsPassiveAndWaitsElevenBits) {
  for (const Time off : {Time{0}, Time{1'999}}) {
    WiringBench t;
    t.plant(FaultKind::Stuck, kMillisecond, 5 * kMillisecond + off);
    t.run(2 * kMillisecond);
    EXPECT_EQ(t.times(LineEventKind::ErrorPassive), std::vector<Time>(4, kMillisecond));
    for (NodeId n = 0; n < 4; ++n) {
      EXPECT_EQ(t.line.counters(n).receive, 135U);
      EXPECT_EQ(t.line.counters(n).transmit, 0U);
    }
    t.send(0, 100);
    t.run(4 * kMillisecond);
    ASSERT_EQ(t.frames.size(), 1U);
    EXPECT_EQ(t.frames[0].start, (2'500 + 1 + 11) * t.bit);
    for (NodeId n = 1; n < 4; ++n) EXPECT_EQ(t.line.counters(n).receive, 127U) << "one good frame";
    EXPECT_EQ(t.line.counters(0).receive, 135U) << "its own does not count";
  }
}

TEST(LineWiring, WhoIsNotThereIsNotHurt) {
  WiringBench t;
  t.line.set_connected(2, false);
  t.plant(FaultKind::Stuck, kMillisecond, 2 * kMillisecond);
  t.run(3 * kMillisecond);
  EXPECT_EQ(t.line.counters(2).receive, 0U);
  EXPECT_EQ(t.times(LineEventKind::ErrorPassive).size(), 3U);
  t.send(0, 100);
  t.run(kMillisecond);
  EXPECT_EQ(t.stations[1]->ids(), WiringIds{100});
  EXPECT_TRUE(t.stations[2]->heard.empty()) << "though others count errors";
}

// --- bus-off and back

TEST(LineWiring, RecoveryIsForWhoIsBusOff) {
  WiringBench t;
  t.line.recover(0);
  t.run(10 * kMillisecond);
  EXPECT_EQ(t.times(LineEventKind::Recovered).size(), 0U);
  t.drive_bus_off(0);
  EXPECT_EQ(std::count(t.told.begin(), t.told.end(), "unit1 is bus-off"), 1);
  t.run(20 * kMillisecond);
  EXPECT_FALSE(t.line.is_active(0)) << "it has not asked";
  const Time asked = t.queue.now();
  t.line.recover(0);
  t.run(10 * kMillisecond);
  // 128 runs of 11 bits from the next bit on.
  EXPECT_EQ(t.times(LineEventKind::Recovered), std::vector<Time>{(asked / t.bit + 1 + 128 * 11) * t.bit});
  EXPECT_TRUE(t.line.is_active(0));
  EXPECT_TRUE(t.line.counters(0).untouched());
}

TEST(LineWiring, ARestartEndsTheWayBack) {
  WiringBench t;
  t.drive_bus_off(0);
  t.line.recover(0);
  t.run(kMillisecond);
  t.line.restart(0);
  EXPECT_TRUE(t.line.is_active(0));
  EXPECT_TRUE(t.line.counters(0).untouched());
  t.run(10 * kMillisecond);
  EXPECT_EQ(t.times(LineEventKind::Recovered).size(), 0U) << "it is back already";
  t.send(0, 100);
  t.run(kMillisecond);
  EXPECT_EQ(t.stations[1]->ids(), WiringIds{100});
  // Nor does it come back behind a frame, where a way back goes on.
  t.send(1, 101);
  t.run(10 * kMillisecond);
  EXPECT_EQ(t.times(LineEventKind::Recovered).size(), 0U);
}

// Nothing counts while the line is held dominant, nor what was counted before.
TEST(LineWiring, HeldDominantTheWayBackBeginsAnew) {
  WiringBench t;
  t.drive_bus_off(0);
  t.line.recover(0);
  const Time begin = t.queue.now() + kMillisecond, end = begin + kMillisecond;
  t.plant(FaultKind::Stuck, begin, end);
  t.run(20 * kMillisecond);
  EXPECT_EQ(t.times(LineEventKind::Recovered), std::vector<Time>{(end / t.bit + 1 + 128 * 11) * t.bit});
}

// --- pauses of passive senders

// Behind its own frame who is error-passive waits 8 bits more than the others, so each of these is before it.
TEST(LineWiring, APassiveSenderLetsOthersGoFirst) {
  for (const bool other : {false, true}) {
    WiringBench t;
    t.plant(FaultKind::Stuck, 0, 20 * t.bit);
    t.run(kMillisecond);
    t.send(0, 100);
    t.send(0, 101);
    if (other) t.send(1, 200);
    t.run(kMillisecond);
    EXPECT_EQ(t.carried(), other ? (WiringIds{100, 200, 101}) : (WiringIds{100, 101}));
    const Time behind = t.frames[0].start + static_cast<Time>(t.frames[0].bits) * t.bit;
    EXPECT_EQ(t.frames[1].start, other ? behind : behind + 8 * t.bit);
    if (other) {
      EXPECT_EQ(t.frames[2].start, t.frames[1].start + static_cast<Time>(t.frames[1].bits) * t.bit);
    }
  }
}

// --- load

// A lone station: each attempt goes to the acknowledge slot, with an error flag of 6 bits, a delimiter of 8 and the
// intermission of 3. They are load, but no frames.
TEST(LineWiring, AttemptsAreLoad) {
  WiringBench t;
  for (NodeId n = 1; n < 4; ++n) t.line.set_connected(n, false);
  const uint32_t attempt = frame_bits({100, 2, {1, 2}}) - 3 - 8 + 6 + 8 + 3;
  t.send(0, 100);
  t.queue.run_until((1 + 5 * static_cast<Time>(attempt)) * t.bit);
  t.line.withdraw(0, 1);
  t.run(10 * kMillisecond);
  const LineLoad load = t.line.load(t.queue.now());
  EXPECT_EQ(load.frames, 0U);
  EXPECT_EQ(load.busy_bits % attempt, 0U);
  EXPECT_GE(load.busy_bits / attempt, 5U);
  EXPECT_LE(load.busy_bits / attempt, 6U);
}

}  // namespace
}  // namespace ipos::tests
