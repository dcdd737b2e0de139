// The event queue against a sorted list, and its promises: total order, cancelling, nothing lost.
#include "runtime/clock/event_queue.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <tuple>

namespace ipos::runtime {
namespace {

class Recorder final : public EventTarget {
 public:
  struct Call {
    Time now;
    uint32_t kind;
    uint64_t argument;
    friend bool operator==(const Call&, const Call&) = default;
  };
  void on_event(Time now, uint32_t kind, uint64_t argument) override {
    calls.push_back({now, kind, argument});
  }
  std::vector<Call> calls;
};

TEST(EventQueue, OrderIsTimeThenSourceThenSchedulingOrder) {
  EventQueue queue;
  Recorder recorder;
  queue.schedule(20, 1, recorder, 0, 1);
  queue.schedule(10, 9, recorder, 0, 2);
  queue.schedule(10, 3, recorder, 0, 3);
  queue.schedule(10, 9, recorder, 0, 4);
  queue.schedule(10, 3, recorder, 7, 5);
  queue.run_until(20);
  const std::vector<Recorder::Call> expected = {{10, 0, 3}, {10, 7, 5}, {10, 0, 2}, {10, 0, 4}, {20, 0, 1}};
  EXPECT_EQ(recorder.calls, expected);
}

TEST(EventQueue, RunUntilTakesTheEndAndMovesTime) {
  EventQueue queue;
  Recorder recorder;
  EXPECT_EQ(queue.next_time(), kNever);
  queue.schedule(100, 0, recorder, 0);
  queue.schedule(101, 0, recorder, 0);
  queue.run_until(100);
  EXPECT_EQ(recorder.calls.size(), 1U);
  EXPECT_EQ(queue.now(), 100);
  EXPECT_EQ(queue.next_time(), 101);
  queue.schedule(5, 0, recorder, 1);  // in the past: now
  EXPECT_EQ(queue.next_time(), 100);
  EXPECT_TRUE(queue.step());
  EXPECT_TRUE(queue.step());
  EXPECT_FALSE(queue.step());
  EXPECT_EQ(queue.now(), 101);
}

TEST(EventQueue, CancelledIdsStayDead) {
  EventQueue queue;
  Recorder recorder;
  const EventId first = queue.schedule(1, 0, recorder, 0);
  EXPECT_NE(first, kNoEvent);
  EXPECT_TRUE(queue.cancel(first));
  EXPECT_FALSE(queue.cancel(first));
  const EventId second = queue.schedule(1, 0, recorder, 1);  // uses the same slot
  EXPECT_FALSE(queue.cancel(first));
  EXPECT_FALSE(queue.cancel(kNoEvent));
  queue.run_until(1);
  EXPECT_EQ(recorder.calls.size(), 1U);
  EXPECT_FALSE(queue.cancel(second));
}

TEST(EventQueue, SchedulesFromWithinAnEvent) {
  class Ticker final : public EventTarget {
   public:
    explicit Ticker(EventQueue& q) : queue(q) {}
    void on_event(Time now, uint32_t, uint64_t) override {
      ++ticks;
      queue.schedule(now + kMillisecond, 0, *this, 0);
    }
    EventQueue& queue;
    int ticks = 0;
  };
  EventQueue queue;
  Ticker ticker(queue);
  queue.schedule(0, 0, ticker, 0);
  queue.run_until(kSecond);
  EXPECT_EQ(ticker.ticks, 1001);
  EXPECT_EQ(queue.pending(), 1U);
}

class EventQueueDistances : public testing::TestWithParam<std::array<Time, 3>> {};

TEST_P(EventQueueDistances, AgreesWithASortedListUnderRandomUse) {
  const auto [unit, far, tick] = GetParam();
  std::mt19937 random(1);
  EventQueue queue(4);
  Recorder recorder;
  std::vector<std::tuple<Time, uint32_t, uint64_t>> model;  // time, source, number
  std::vector<std::pair<EventId, uint64_t>> ids;
  uint64_t number = 0;
  Time now = 0;
  for (int round = 0; round < 2000; ++round) {
    for (int i = 0; i < 10; ++i) {
      const bool regular = random() % 2 == 0;  // in the order of their sources, as ticks are
      const Time at =
          now + (regular ? tick : static_cast<Time>(random() % static_cast<uint64_t>(far)) * unit);
      const uint32_t source = regular ? static_cast<uint32_t>(i) : static_cast<uint32_t>(random() % 4);
      ids.emplace_back(queue.schedule(at, source, recorder, 0, number), number);
      model.emplace_back(at, source, number++);
    }
    for (int i = 0; i < 4; ++i) {
      const auto& [id, which] = ids[random() % ids.size()];
      const auto found = std::find_if(model.begin(), model.end(),
                                      [n = which](const auto& row) { return std::get<2>(row) == n; });
      EXPECT_EQ(queue.cancel(id), found != model.end());
      if (found != model.end()) model.erase(found);
    }
    now += static_cast<Time>(random() % 40) * unit;
    std::sort(model.begin(), model.end());
    const auto end =
        std::find_if(model.begin(), model.end(), [now](const auto& row) { return std::get<0>(row) > now; });
    recorder.calls.clear();
    queue.run_until(now);
    ASSERT_EQ(recorder.calls.size(), static_cast<size_t>(end - model.begin()));
    for (size_t i = 0; i < recorder.calls.size(); ++i) {
      ASSERT_EQ(recorder.calls[i].now, std::get<0>(model[i]));
      ASSERT_EQ(recorder.calls[i].argument, std::get<2>(model[i]));
    }
    model.erase(model.begin(), end);
    ASSERT_EQ(queue.pending(), model.size());
  }
}

INSTANTIATE_TEST_SUITE_P(All, EventQueueDistances,
                         testing::Values(std::array<Time, 3>{1, 50, 40},
                                         std::array<Time, 3>{kMillisecond / 4, 40, kMillisecond},
                                         std::array<Time, 3>{kMillisecond, 5, 10 * kMillisecond},
                                         std::array<Time, 3>{kMillisecond, 100, 2 * kMillisecond}));

TEST(EventQueue, CancelledTargetsAreGoneEverywhere) {
  EventQueue queue;
  Recorder recorder;
  Recorder other;
  for (const Time at : {Time{1}, Time{2}, kMillisecond, 10 * kMillisecond, kSecond, Time{3}}) {
    queue.schedule(at, 0, other, 0);
    queue.schedule(at, 0, recorder, 0);
    queue.schedule(at, 1, other, 0);
  }
  queue.cancel_all(other);
  EXPECT_EQ(queue.pending(), 6U);
  EXPECT_EQ(queue.next_time(), 1);
  queue.run_until(2 * kSecond);
  EXPECT_EQ(recorder.calls.size(), 6U);
  EXPECT_TRUE(other.calls.empty());
}

// One that goes on without the queue while it may.
class Runner final : public EventTarget {
 public:
  explicit Runner(EventQueue& q) : queue(q) {}
  void on_event(Time now, uint32_t, uint64_t) override {
    do times.push_back(now);
    while (queue.advance(now += 10, 5));
    if (times.size() < 20) queue.schedule(now, 5, *this, 0);
  }
  EventQueue& queue;
  std::vector<Time> times;
};

TEST(EventQueue, AdvancesToWhatIsNextAnyway) {
  EventQueue queue;
  Runner runner(queue);
  Recorder recorder;
  queue.schedule(0, 5, runner, 0);
  for (const uint32_t source : {4U, 6U}) queue.schedule(30, source, recorder, source);
  queue.run_until(25);  // no run goes farther than it was asked to
  EXPECT_EQ(runner.times, (std::vector<Time>{0, 10, 20}));
  EXPECT_EQ(queue.now(), 25);
  EXPECT_EQ(queue.next_time(), 30);
  EXPECT_TRUE(queue.step());
  EXPECT_EQ(recorder.calls.size(), 1U);
  EXPECT_TRUE(queue.step());  // a single step is no more than that
  EXPECT_EQ(runner.times, (std::vector<Time>{0, 10, 20, 30}));
  EXPECT_EQ(queue.now(), 30);
  EXPECT_EQ(recorder.calls.size(), 1U);
  EXPECT_TRUE(queue.has_passed(4));
  EXPECT_FALSE(queue.has_passed(5));
  queue.run_until(55);
  EXPECT_EQ(recorder.calls.size(), 2U);
  EXPECT_EQ(runner.times, (std::vector<Time>{0, 10, 20, 30, 40, 50}));
  EXPECT_EQ(queue.now(), 55);
}

TEST(EventQueue, WhatIsToComeAtNeverDoesNot) {
  for (const Time now : {Time{0}, kNever - 1, kNever - kMillisecond, kNever - 11 * kMillisecond}) {
    EventQueue queue;
    Recorder recorder;
    queue.run_until(now);
    const EventId never = queue.schedule(kNever, 0, recorder, 1);
    queue.schedule(kNever - 1, 0, recorder, 2);
    queue.run_until(kNever);
    EXPECT_EQ(recorder.calls, (std::vector<Recorder::Call>{{kNever - 1, 2, 0}})) << now;
    EXPECT_FALSE(queue.step());
    EXPECT_EQ(queue.pending(), 1U);
    EXPECT_TRUE(queue.cancel(never));
    EXPECT_EQ(queue.pending(), 0U);
  }
}

// Kind and argument come back from the rows and from the heap, and from a slot that was used before.
TEST(EventQueue, BringsBackWhatWasScheduled) {
  for (const size_t capacity : {0U, 1U, 256U}) {
    EventQueue queue(capacity);
    Recorder recorder;
    std::vector<Recorder::Call> expected;
    for (int round = 0; round < 3; ++round) {
      const Time now = queue.now();
      uint32_t kind = 0;
      // From the last to the first, so that neither row takes them all.
      for (Time ahead = 20; ahead >= 0; --ahead)
        for (const Time unit : {Time{1}, kMillisecond, kSecond}) {
          ++kind;
          queue.schedule(now + ahead * unit, 3, recorder, kind, uint64_t{kind} << 33 | 5);
          expected.push_back({now + ahead * unit, kind, uint64_t{kind} << 33 | 5});
        }
      queue.run_until(now + 30 * kSecond);
    }
    std::stable_sort(expected.begin(), expected.end(),
                     [](const auto& a, const auto& b) { return a.now < b.now; });
    EXPECT_EQ(recorder.calls, expected) << capacity;
  }
}

TEST(EventQueue, KnowsNoIdsOfOthers) {
  EventQueue queue;
  Recorder recorder;
  for (const EventId id : {kNoEvent, EventId{1}, EventId{1} << 32, EventId{1} << 32 | 7, EventId{1} << 63,
                           EventId{3} << 62, ~EventId{0}})
    EXPECT_FALSE(queue.cancel(id)) << id;
  const EventId near = queue.schedule(1, 0, recorder, 0);
  const EventId far = queue.schedule(kSecond, 0, recorder, 0);
  queue.schedule(2, 0, recorder, 0);
  for (const EventId id :
       {kNoEvent, near + 2, near + 100, far + 1, far + (EventId{1} << 32), EventId{3} << 62})
    EXPECT_FALSE(queue.cancel(id)) << id;
  EXPECT_EQ(queue.pending(), 3U);
  queue.run_until(1);
  EXPECT_FALSE(queue.cancel(near));
  EXPECT_EQ(queue.pending(), 2U);
  EXPECT_TRUE(queue.cancel(far));
  EXPECT_FALSE(queue.cancel(far));
}

// Behind the last event of a run its source counts as passed, however many others came first.
TEST(EventQueue, KnowsWhoHasHadItsTurn) {
  class Asker final : public EventTarget {
   public:
    explicit Asker(EventQueue& q) : queue(q) {}
    void on_event(Time, uint32_t, uint64_t) override {
      uint32_t passed = 0;
      while (queue.has_passed(passed)) ++passed;
      seen.push_back(passed);
    }
    EventQueue& queue;
    std::vector<uint32_t> seen;
  };
  EventQueue queue;
  Asker asker(queue);
  for (const uint32_t source : {2U, 5U, 9U}) queue.schedule(10, source, asker, 0);
  queue.schedule(20, 1, asker, 0);
  queue.schedule(20, 1, asker, 0);
  queue.run_until(30);
  EXPECT_EQ(asker.seen, (std::vector<uint32_t>{2, 5, 9, 1, 1}));
}

TEST(EventQueue, ThePastIsAsItWas) {
  EventQueue queue;
  queue.run_until(50);
  {
    const EventQueue::Past late(queue, 20, 5);
    EXPECT_EQ(queue.now(), 20);
    EXPECT_TRUE(queue.has_passed(4));
    EXPECT_FALSE(queue.has_passed(5)) << "its turn is now";
    {
      const EventQueue::Past later_still(queue, 10, 7);
      EXPECT_EQ(queue.now(), 10);
      EXPECT_TRUE(queue.has_passed(5));
    }
    EXPECT_EQ(queue.now(), 20);
    EXPECT_FALSE(queue.has_passed(5));
  }
  EXPECT_EQ(queue.now(), 50);
  EXPECT_TRUE(queue.has_passed(1000));
}

TEST(EventQueue, AnEventOfTheSameSourceComesFirst) {
  EventQueue queue;
  Runner runner(queue);
  Recorder recorder;
  queue.schedule(0, 5, runner, 0);
  queue.schedule(10, 5, recorder, 0);
  queue.run_until(0);
  EXPECT_TRUE(queue.step());
  EXPECT_EQ(recorder.calls.size(), 1U);
  EXPECT_EQ(runner.times, std::vector<Time>{0});
}

}  // namespace
}  // namespace ipos::runtime
