// Repetitions of a frame that nobody acknowledges, counted in one step, against the plain line that sends each of them:
// a calculation of how busy the line is, and random doings of some stations, whoever comes first in the same moment.
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "runtime/bus/can/line.hpp"
#include "tests/runtime/bus/noting_station.hpp"
#include "tests/runtime/bus/wire_model.hpp"

namespace ipos::runtime {
namespace {

constexpr uint32_t kLineSource = 9;
constexpr uint32_t kBaud = 500'000;
constexpr Time kBit = kSecond / kBaud;

struct Rig {
  Rig(bool in_turn, const std::vector<bool>& minds) {
    if (in_turn) line.repeat_in_turn();
    line.add_observer(watcher);
    for (const bool one : minds) add(one);
    for (const bool one : minds) {  // who takes the place of each
      spare.push_back(std::make_unique<NotingStation>(!one));
      spare.back()->line = &line;
      spare.back()->node = static_cast<NodeId>(spare.size() - 1);
    }
  }
  void add(bool minds) {
    stations.push_back(std::make_unique<NotingStation>(minds));
    stations.back()->line = &line;
    stations.back()->node = line.attach("unit" + std::to_string(stations.size()), kBaud, *stations.back());
  }
  std::array<uint64_t, 5> load() const { return load_of(line, queue.now()); }
  uint64_t failures() const {
    uint64_t sum = 0;
    for (const auto& station : stations) sum += station->failures;
    return sum;
  }

  EventQueue queue;
  CanLine line{queue, kLineSource, "sbus", kBaud};
  NotingObserver watcher;
  std::vector<std::unique_ptr<NotingStation>> stations, spare;
};

Frame frame_of(uint32_t id, uint8_t first = 0) { return {id, 8, {first, 2, 3, 4, 5, 6, 7, 8}, false, false}; }

// Attempts of an error-active station come one after the other; each counts 8, so 16 of them make it passive. From then
// on there are 8 bits between them, and the counter stays.
uint64_t busy_bits_of_a_lone_sender(const Frame& frame, uint64_t first_bit, uint64_t until_bit) {
  const uint64_t on_wire = tests::wire(frame).size();
  const uint64_t to_delimiter_end = on_wire - 8 + 6 + 8;  // its flag begins behind the slot, 8 bits before the end
  const uint64_t occupied = to_delimiter_end + 3;
  uint64_t busy = 0;
  uint64_t bit = first_bit;
  for (int attempt = 1; bit + to_delimiter_end <= until_bit; ++attempt) {
    busy += occupied;
    bit += occupied + (attempt >= 16 ? 8 : 0);
  }
  return busy;
}

TEST(LineRepeats, ALoneSenderKeepsTheLineAsBusyAsCalculated) {
  Rig rig(false, {false});
  const Frame frame = frame_of(1100);
  rig.line.send(0, frame, 7);
  for (const Time at : {kMillisecond, 3 * kMillisecond, 999 * kMillisecond, kSecond, kSecond + 1, 7 * kSecond,
                        7 * kSecond + 123 * kBit, 100 * kSecond}) {
    rig.queue.run_until(at);
    EXPECT_EQ(rig.line.load(at).busy_bits, busy_bits_of_a_lone_sender(frame, 1, static_cast<uint64_t>(at / kBit)))
        << at;
  }
  EXPECT_EQ(rig.line.counters(0).transmit, 128U);
  EXPECT_EQ(rig.watcher.events.size(), 2U) << "no acknowledge and error passive, each once";
  EXPECT_LT(rig.stations[0]->failures, 17U + 2 * 101U) << "a second is foreseen at a time";
}

TEST(LineRepeats, WhoJoinsTakesTheNextOne) {
  Rig plain(true, {false, false}), fast(false, {false, false});
  for (Rig* rig : {&plain, &fast}) {
    rig->line.set_connected(1, false);
    rig->line.send(0, frame_of(1100), 7);
    rig->queue.run_until(5 * kSecond + 777 * kBit + 3);
    rig->line.set_connected(1, true);
    rig->queue.run_until(6 * kSecond);
  }
  ASSERT_EQ(fast.watcher.frames.size(), 1U);
  EXPECT_EQ(plain.watcher.frames, fast.watcher.frames);
  EXPECT_EQ(plain.stations[0]->heard, fast.stations[0]->heard);
  EXPECT_EQ(plain.stations[1]->heard, fast.stations[1]->heard);
  EXPECT_EQ(plain.load(), fast.load());
  EXPECT_LT(fast.failures() * 100, plain.failures());
}

// Two stations, the second cut off; the first repeats its frame. Then something happens, and two seconds later somebody
// has a look, takes the second back and looks again.
void expect_same(const std::function<void(Rig&)>& happens) {
  Rig plain(true, {false, false}), fast(false, {false, false});
  for (Rig* rig : {&plain, &fast}) {
    rig->line.set_connected(1, false);
    rig->line.send(0, frame_of(1100), 7);
    rig->queue.run_until(500 * kMillisecond);
    happens(*rig);
    rig->queue.run_until(2 * kSecond);
  }
  ASSERT_EQ(plain.load(), fast.load());
  for (Rig* rig : {&plain, &fast}) {
    rig->line.set_connected(1, true);
    rig->queue.run_until(3 * kSecond);
  }
  EXPECT_EQ(plain.load(), fast.load());
  EXPECT_EQ(plain.watcher.frames, fast.watcher.frames);
  EXPECT_EQ(plain.watcher.events, fast.watcher.events);
  for (size_t n = 0; n < plain.stations.size(); ++n)
    EXPECT_EQ(plain.stations[n]->heard, fast.stations[n]->heard) << n;
}

TEST(LineRepeats, FaultsOfTheLineFindItAsItIs) {
  for (const FaultType& type : kFaultTypes)
    for (const Time from : {500 * kMillisecond, 700 * kMillisecond})
      for (const Time until : {701 * kMillisecond, kNever}) {
        SCOPED_TRACE(std::string(type.word) + " from " + std::to_string(from));
        LineFault fault;
        fault.kind = type.kind;
        fault.from = from;
        fault.until = until;
        fault.per_mille = 100;
        fault.lag = 700 * kMicrosecond;
        if (type.at == FaultPlace::Station || type.kind == FaultKind::Cut) fault.node = 0;
        expect_same([&](Rig& rig) { rig.line.plant(fault); });
      }
}

TEST(LineRepeats, AStationThatIsPluggedInTakesTheNextOne) {
  expect_same([](Rig& rig) { rig.add(false); });
}

// In each bit of the way round, before and after what the line does in it: a frame of higher priority, or the second
// station comes back.
class Coming final : public EventTarget {
 public:
  explicit Coming(CanLine& line) : line_(line) {}
  void on_event(Time, uint32_t kind, uint64_t) override {
    if (kind == 0)
      line_.send(0, frame_of(3), 8);
    else
      line_.set_connected(1, true);
  }

 private:
  CanLine& line_;
};

TEST(LineRepeats, WhatHappensInTheSameBitComesInItsOrder) {
  const Time way_round = static_cast<Time>(tests::wire(frame_of(1100)).size() + 20) * kBit;
  for (Time at = 600 * kMillisecond; at < 600 * kMillisecond + way_round; at += kBit / 2)
    for (const uint32_t source : {kLineSource - 1, kLineSource + 1})
      for (const uint32_t kind : {0U, 1U}) {
        SCOPED_TRACE(at);
        std::vector<std::unique_ptr<Coming>> events;
        expect_same([&](Rig& rig) {
          events.push_back(std::make_unique<Coming>(rig.line));
          rig.queue.schedule(at, source, *events.back(), kind);
          rig.queue.run_until(at);
        });
        if (::testing::Test::HasFailure()) return;
      }
}

// What happens by an event of the queue, in the same moment before or after what the line does.
class Doer final : public EventTarget {
 public:
  explicit Doer(Rig& rig) : rig_(rig) {}
  void on_event(Time, uint32_t kind, uint64_t argument) override {
    CanLine& line = rig_.line;
    const auto node = static_cast<NodeId>(argument % rig_.stations.size());
    const auto value = static_cast<uint32_t>(argument >> 8);
    switch (kind) {
      case 0: case 1: line.send(node, frame_of(value % 40, static_cast<uint8_t>(value >> 8)), value % 3, value % 2 == 0); break;
      case 2: line.withdraw(node, value % 3); break;
      case 3: line.set_connected(node, false); break;
      case 4: line.set_connected(node, true); break;
      case 5: line.set_baud(node, value % 2 == 0 ? kBaud : 125'000); break;
      case 6: line.restart(node); break;
      case 7: line.replace(node, value % 2 == 0 ? *rig_.stations[node] : *rig_.spare[node]); break;
      case 8: line.tell_error_state(node, static_cast<ErrorState>(value % 3)); break;
      case 9: line.recover(node); break;
      default: loads.push_back(rig_.load());
    }
  }
  static constexpr uint32_t kKinds = 12;
  std::vector<std::array<uint64_t, 5>> loads;

 private:
  Rig& rig_;
};

class Doings : public ::testing::TestWithParam<uint32_t> {};

TEST_P(Doings, LeaveTheLineAsThePlainOne) {
  std::mt19937 random(GetParam());
  const auto below = [&](uint32_t limit) { return static_cast<uint32_t>(random()) % limit; };
  std::vector<bool> minds;
  for (uint32_t n = 2 + below(3); n > 0; --n) minds.push_back(below(4) == 0);
  const auto nodes = static_cast<NodeId>(minds.size());
  Rig plain(true, minds), fast(false, minds);
  Doer plain_doer(plain), fast_doer(fast);
  const auto both = [&](auto act) {
    act(plain, plain_doer);
    act(fast, fast_doer);
  };
  const auto fault_of = [&](FaultKind kind, Time from, Time lasts) {
    LineFault fault;
    fault.kind = kind;
    fault.from = from;
    fault.until = lasts == 0 ? kNever : from + lasts;
    fault.per_mille = 200;
    fault.seed = below(1000);
    fault.lag = 700 * kMicrosecond;
    fault.behind = kind == FaultKind::Cut && below(2) == 0;
    if (kind != FaultKind::Short && kind != FaultKind::Stuck) fault.node = below(nodes);
    return fault;
  };
  constexpr Time kLength = 3 * kSecond;
  for (const FaultKind kind : {FaultKind::Cut, FaultKind::Swap, FaultKind::Short, FaultKind::Stuck, FaultKind::Corrupt})
    if (below(3) == 0) {
      const LineFault fault =
          fault_of(kind, below(2000) * kMillisecond, below(2) * (1 + below(200)) * kMillisecond);
      both([&](Rig& rig, Doer&) { rig.line.plant(fault); });
    }
  // Long pauses, in which somebody may repeat a frame for more than a second.
  for (Time at = 0; at < kLength;) {
    at += static_cast<Time>(below(3) == 0 ? below(1'500'000) : below(3000)) * kMicrosecond;
    if (below(2) == 0) at -= at % kBit;
    const uint32_t source = below(3) == 0 ? kLineSource - 1 : kLineSource + 1;
    const uint32_t kind = below(Doer::kKinds);
    const uint64_t argument = random();
    both([&](Rig& rig, Doer& doer) { rig.queue.schedule(at, source, doer, kind, argument); });
  }
  // And by hand, between two stretches.
  for (Time at = 0; at < kLength + kSecond; at += static_cast<Time>(1 + below(700)) * kMillisecond + below(2) * below(5000)) {
    both([&](Rig& rig, Doer&) { rig.queue.run_until(at); });
    ASSERT_EQ(plain.load(), fast.load()) << at;
    const NodeId node = below(nodes);
    ASSERT_EQ(plain.line.has_waiting(node), fast.line.has_waiting(node));
    ASSERT_EQ(plain.line.counters(node).transmit, fast.line.counters(node).transmit);
    ASSERT_EQ(plain.line.counters(node).receive, fast.line.counters(node).receive);
    ASSERT_EQ(plain.line.plain_end(), fast.line.plain_end());
    switch (below(6)) {
      case 0: {
        const LineFault fault = fault_of(below(2) == 0 ? FaultKind::Cut : FaultKind::Drop, at, 0);
        both([&](Rig& rig, Doer&) { rig.line.plant(fault); });
        break;
      }
      case 1: {
        LineFault like;
        like.kind = FaultKind::Cut;
        like.node = node;
        both([&](Rig& rig, Doer&) { rig.line.repair(like); });
        break;
      }
      case 2: both([&](Rig& rig, Doer&) { rig.line.send(node, frame_of(44), 4); }); break;
      default: break;
    }
  }
  both([&](Rig& rig, Doer&) { rig.queue.run_until(kLength + 2 * kSecond); });
  EXPECT_EQ(plain.watcher.frames, fast.watcher.frames);
  EXPECT_EQ(plain.watcher.events, fast.watcher.events);
  EXPECT_EQ(plain_doer.loads, fast_doer.loads);
  EXPECT_EQ(plain.load(), fast.load());
  for (NodeId n = 0; n < nodes; ++n) {
    EXPECT_EQ(plain.stations[n]->heard, fast.stations[n]->heard) << n;
    EXPECT_EQ(plain.spare[n]->heard, fast.spare[n]->heard) << n;
  }
  EXPECT_LE(fast.failures(), plain.failures());
}

INSTANTIATE_TEST_SUITE_P(Seeds, Doings, ::testing::Range(1U, 301U));

}  // namespace
}  // namespace ipos::runtime
