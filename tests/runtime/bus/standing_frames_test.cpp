// Frames that stations at rest leave to the line, against stations that send each of them by an event of their own: random
// doings of all on the line, whoever comes first in the same moment.
#include "runtime/bus/can/standing_frames.hpp"

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <random>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "runtime/bus/can/line.hpp"
#include "tests/runtime/bus/noting_station.hpp"

namespace ipos::runtime {
namespace {

constexpr uint32_t kLineSource = 9;
constexpr uint32_t kBaud = 500'000;
constexpr Time kBit = kSecond / kBaud;

// Of node n, with room for another source on either side.
uint32_t source_of(NodeId node) { return kLineSource + 2 + 2 * node; }

// The plain way: an event for each frame.
class Sender final : public EventTarget {
 public:
  Sender(EventQueue& queue, CanLine& line) : queue_(queue), line_(line) {}
  void add(const StandingFrame& frame) {
    if (frame.at >= frame.until) return;
    frames_.push_back({frame, kNoEvent});
    schedule(frames_.size() - 1);
  }
  void remove(NodeId node) {
    for (Own& own : frames_)
      if (own.frame.node == node && own.event != kNoEvent) queue_.cancel(std::exchange(own.event, kNoEvent));
  }
  void on_event(Time, uint32_t, uint64_t number) override {
    Own& own = frames_[number];
    own.event = kNoEvent;
    line_.send(own.frame.node, own.frame.frame, own.frame.tag, true);
    own.frame.at += own.frame.cycle * kMillisecond;
    if (own.frame.at < own.frame.until) schedule(number);
  }

 private:
  struct Own {
    StandingFrame frame;
    EventId event;
  };
  void schedule(size_t number) {
    Own& own = frames_[number];
    own.event = queue_.schedule(own.frame.at, own.frame.source, *this, 0, number);
  }
  EventQueue& queue_;
  CanLine& line_;
  std::vector<Own> frames_;
};

struct Rig {
  Rig(bool is_plain, size_t nodes) : plain(is_plain) {
    if (plain) line.repeat_in_turn();
    line.add_observer(watcher);
    for (size_t n = 0; n < nodes; ++n) add();
  }
  void add() {
    stations.push_back(std::make_unique<NotingStation>(true));
    stations.back()->line = &line;
    stations.back()->node = line.attach("unit" + std::to_string(stations.size()), kBaud, *stations.back());
    stands.push_back(false);
  }
  void stand(NodeId node, uint32_t frames, uint64_t value) {
    if (stands[node] || !line.standing().has_room(frames)) return;
    stands[node] = true;
    for (uint32_t n = 0; n < frames; ++n) {
      const uint32_t cycle = static_cast<uint32_t>(1 + (value >> n) % 12);
      const Time first = queue.now() + static_cast<Time>(1 + (value >> 8) % cycle) * kMillisecond;
      const Time until = value % 4 == 0 ? queue.now() + static_cast<Time>(value % 50) * kMillisecond : kNever;
      const Frame same(100 + node * 4 + n, 8, {static_cast<uint8_t>(value)});
      const StandingFrame frame{first, until, same, 16 + n, cycle, source_of(node), node};
      if (plain)
        sender.add(frame);
      else
        line.standing().add(frame);
    }
  }
  void rise(NodeId node) {
    stands[node] = false;
    if (plain)
      sender.remove(node);
    else
      line.standing().remove(node);
  }
  std::array<uint64_t, 5> load() const { return load_of(line, queue.now()); }

  bool plain;
  EventQueue queue;
  CanLine line{queue, kLineSource, "sbus", kBaud};
  Sender sender{queue, line};
  NotingObserver watcher;
  std::vector<std::unique_ptr<NotingStation>> stations;
  std::vector<bool> stands;
};

// Two stations at rest: their frames begin at the first bit after they are due, one behind the other in the order of their
// identifiers.
TEST(StandingFrames, AreSentWhenTheyAreDue) {
  Rig rig(false, 2);
  rig.line.standing().add({3 * kMillisecond, kNever, Frame(200, 2, {1, 2}), 16, 10, source_of(0), 0});
  rig.line.standing().add(
      {8 * kMillisecond, 60 * kMillisecond, Frame(100, 2, {3, 4}), 16, 5, source_of(1), 1});
  rig.queue.run_until(70 * kMillisecond + kMillisecond / 2);
  std::vector<std::pair<uint32_t, Time>> expected, seen;  // with the millisecond in which it begins
  for (Time at = 1; at <= 70; ++at) {
    if (at >= 8 && at < 60 && (at - 8) % 5 == 0) expected.emplace_back(100, at);
    if (at >= 3 && (at - 3) % 10 == 0) expected.emplace_back(200, at);
  }
  for (const auto& [start, end, bits, node, id, data] : rig.watcher.frames) {
    seen.emplace_back(id, start / kMillisecond);
    if (id == 100) {
      EXPECT_EQ(start % kMillisecond, kBit);
    }
  }
  EXPECT_EQ(seen, expected);
  EXPECT_EQ(rig.queue.pending(), 1U) << "one event is for all of them";
  rig.line.standing().remove(0);
  EXPECT_EQ(rig.queue.pending(), 0U);
}

TEST(StandingFrames, AsManyFindRoomAsTheLineHasNodesTimesTwo) {
  Rig rig(false, 3);
  StandingFrames& standing = rig.line.standing();
  size_t count = 0;
  for (; standing.has_room(1); ++count)
    standing.add({static_cast<Time>(1 + count) * kMillisecond, kNever,
                  Frame(100 + static_cast<uint32_t>(count), 0), 16, 40, source_of(0), 0});
  EXPECT_GE(count, 6U);
  EXPECT_FALSE(standing.has_room(1));
  while (rig.stations.size() < 5) rig.add();  // more nodes, more room; what stands goes on
  EXPECT_TRUE(standing.has_room(1));
  rig.queue.run_until(39 * kMillisecond);
  EXPECT_EQ(rig.watcher.frames.size(), count);
}

// What happens by an event of the queue, in the same moment before, between or after what the stations do.
class Doer final : public EventTarget {
 public:
  explicit Doer(Rig& rig) : rig_(rig) {}
  void on_event(Time, uint32_t kind, uint64_t argument) override {
    CanLine& line = rig_.line;
    const auto node = static_cast<NodeId>(argument % rig_.stations.size());
    const auto value = static_cast<uint32_t>(argument >> 8);
    switch (kind) {
      case 0:
        line.send(node, {value % 300, 8, {static_cast<uint8_t>(value >> 8)}}, value % 20, value % 2 == 0);
        break;
      case 1: line.withdraw(node, value % 20); break;
      case 2: line.set_connected(node, value % 3 != 0); break;
      case 3: line.set_baud(node, value % 4 != 0 ? kBaud : 125'000); break;
      case 4: line.restart(node); break;
      case 5: line.tell_error_state(node, static_cast<ErrorState>(value % 3)); break;
      case 6:
      case 7:
      case 8:
      case 9: rig_.stand(node, 1 + value % 2, value / 2); break;
      case 10:
      case 11: rig_.rise(node); break;
      default: loads.push_back(rig_.load());
    }
  }
  static constexpr uint32_t kKinds = 13;
  std::vector<std::array<uint64_t, 5>> loads;

 private:
  Rig& rig_;
};

class ScriptsOfStandingFrames : public ::testing::TestWithParam<uint32_t> {};

TEST_P(ScriptsOfStandingFrames, LeaveTheLineAsThePlainOne) {
  std::mt19937 random(GetParam());
  const auto below = [&](uint32_t limit) { return static_cast<uint32_t>(random()) % limit; };
  const NodeId nodes = 2 + below(5);
  Rig plain(true, nodes), fast(false, nodes);
  Doer plain_doer(plain), fast_doer(fast);
  const auto both = [&](auto act) {
    act(plain, plain_doer);
    act(fast, fast_doer);
  };
  constexpr Time kLength = kSecond;
  for (const FaultKind kind :
       {FaultKind::Cut, FaultKind::Swap, FaultKind::Short, FaultKind::Stuck, FaultKind::Corrupt})
    if (below(5) == 0) {
      LineFault fault;
      fault.kind = kind;
      fault.from = below(800) * kMillisecond;
      fault.until = below(2) == 0 ? kNever : fault.from + (1 + below(100)) * kMillisecond;
      fault.per_mille = 100;
      fault.seed = below(1000);
      if (kind != FaultKind::Short && kind != FaultKind::Stuck) fault.node = below(nodes);
      both([&](Rig& rig, Doer&) { rig.line.plant(fault); });
    }
  // Seldom anything but rest in half of the runs.
  const uint32_t pause = GetParam() % 2 == 0 ? 40'000 : 2000;
  for (Time at = 0; at < kLength;) {
    at += static_cast<Time>(below(pause)) * kMicrosecond;
    if (below(2) == 0) at -= at % kMillisecond;
    const uint32_t source = below(4) == 0 ? kLineSource - 1 : kLineSource + 1 + 2 * below(nodes + 1);
    const uint32_t kind = below(Doer::kKinds);
    const uint64_t argument = random();
    both([&](Rig& rig, Doer& doer) { rig.queue.schedule(at, source, doer, kind, argument); });
  }
  for (Time at = 0; at < kLength + kSecond / 2;
       at += static_cast<Time>(below(100)) * kMillisecond + below(2) * below(5000)) {
    both([&](Rig& rig, Doer&) { rig.queue.run_until(at); });
    ASSERT_EQ(plain.load(), fast.load()) << at;
    for (NodeId node = 0; node < nodes; ++node) {
      ASSERT_EQ(plain.line.has_waiting(node), fast.line.has_waiting(node)) << at;
      ASSERT_EQ(plain.line.counters(node).transmit, fast.line.counters(node).transmit);
      ASSERT_EQ(plain.line.counters(node).receive, fast.line.counters(node).receive);
    }
    ASSERT_EQ(plain.line.plain_end(), fast.line.plain_end());
    if (below(4) == 0) {  // by hand, between two stretches
      const uint32_t kind = 6 + below(6);
      const uint64_t argument = random();
      both([&](Rig&, Doer& doer) { doer.on_event(at, kind, argument); });
    }
  }
  both([&](Rig& rig, Doer&) { rig.queue.run_until(2 * kSecond); });
  EXPECT_EQ(plain.watcher.frames, fast.watcher.frames);
  EXPECT_EQ(plain.watcher.events, fast.watcher.events);
  EXPECT_EQ(plain_doer.loads, fast_doer.loads);
  EXPECT_EQ(plain.load(), fast.load());
  for (NodeId n = 0; n < nodes; ++n) EXPECT_EQ(plain.stations[n]->heard, fast.stations[n]->heard) << n;
}

INSTANTIATE_TEST_SUITE_P(Seeds, ScriptsOfStandingFrames, ::testing::Range(1U, 301U));

}  // namespace
}  // namespace ipos::runtime
