// The event queue against a sorted list, and its promises: total order, cancelling, nothing lost.
#include "runtime/clock/event_queue.hpp"

#include <gtest/gtest.h>

#include <algorithm>
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

TEST(EventQueue, AgreesWithASortedListUnderRandomUse) {
  std::mt19937 random(1);
  EventQueue queue(4);
  Recorder recorder;
  std::vector<std::tuple<Time, uint32_t, uint64_t>> model;  // time, source, number
  std::vector<std::pair<EventId, uint64_t>> ids;
  uint64_t number = 0;
  Time now = 0;
  for (int round = 0; round < 2000; ++round) {
    for (int i = 0; i < 10; ++i) {
      const Time at = now + static_cast<Time>(random() % 50);
      const uint32_t source = static_cast<uint32_t>(random() % 4);
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
    now += static_cast<Time>(random() % 40);
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

}  // namespace
}  // namespace ipos::runtime
