// The pacer with a toy that knows the right answer by itself: whoever looks, writes or posts at any time finds
// and leaves what a run in turn finds and leaves.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <utility>
#include <vector>

#include "runtime/pace/pacer.hpp"

namespace ipos::tests {
namespace {

using runtime::kMillisecond;
using runtime::Pace;
using runtime::Ticks;
using runtime::Time;

constexpr uint32_t kSource = 5;

// Adds its step to a sum once a millisecond; in every tenth it decides on another step. It sends the sum every
// seventh.
struct Toy final : runtime::Timed, runtime::TelegramReader {
  bool tick(Time now) override {
    settle();
    const int64_t n = now / kMillisecond;
    if (n % 10 == 0) step = sum % 13 + 1;
    sum += step;
    ++in_full;
    return true;
  }
  Time send(Time now) override {
    const int64_t n = now / kMillisecond;
    settle();
    if (n % 7 == 0) sent.push_back(sum);
    return now + ((n / 7 + 1) * 7 - n) * kMillisecond;
  }
  Ticks horizon(Time first) override { return static_cast<Ticks>((10 - first / kMillisecond % 10) % 10); }
  Ticks advance(Time first, Ticks most) override {
    EXPECT_GT(most, 0U) << "where nothing can be done at once it is not asked";
    EXPECT_LE(most, horizon(first));
    ++advances;
    if (advances % 5 == 0) return 0;  // it cannot, now and then
    const Ticks some = advances % 3 == 0 ? (most + 1) / 2 : most;
    unsettled += some;
    return some;
  }
  Ticks silence(Time /*first*/) override { return quiet; }
  void settle() override { sum += step * static_cast<int64_t>(std::exchange(unsettled, 0)); }
  void touched() override { EXPECT_EQ(unsettled, 0U) << "who writes finds everything settled"; }
  void before_telegram() override { settle(); }
  bool lets_wait() const override { return true; }
  bool rests() const override { return false; }
  void read(size_t number, const runtime::TelegramData& data) override {
    EXPECT_EQ(unsettled, 0U) << "it was told in front of the telegram";
    sum += static_cast<int64_t>(number) * data.bytes[0];
  }

  int64_t step = 1, sum = 0;
  Ticks unsettled = 0, quiet = 20;
  uint32_t advances = 0, in_full = 0;
  std::vector<int64_t> sent;
};

struct Rig {
  explicit Rig(Pace pace, Time start = 0) : pacer(queue, kSource, toy, pace, milliseconds) {
    queue.run_until(start);
    pacer.start();
  }
  int64_t look() {
    pacer.catch_up();
    return toy.sum;
  }
  void write(int64_t value) {
    pacer.touch();
    toy.sum += value;
  }
  void post(uint8_t value) {
    const runtime::TelegramData data{{value}, 1};
    if (pacer.post(toy, 3, data)) return;
    pacer.touch();
    toy.read(3, data);
  }

  runtime::EventQueue queue;
  Toy toy;
  runtime::OwnMilliseconds milliseconds;
  runtime::Pacer pacer;
};

TEST(Pacer, WhoeverComesFindsWhatARunInTurnHas) {
  uint64_t behind = 0;
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    std::mt19937_64 random(seed);
    // Every other one begins between two whole milliseconds.
    const Time start = seed % 2 == 0 ? static_cast<Time>(random() % kMillisecond) : 0;
    Rig expected(Pace::InTurn, start), lazy(Pace::Lazy, start);
    lazy.toy.quiet = static_cast<Ticks>(random() % 40);
    Time now = start;
    for (int n = 0; n < 500; ++n) {
      now += static_cast<Time>(random() % (12 * kMillisecond));
      if (random() % 4 == 0) now = std::max(start, now / kMillisecond * kMillisecond);
      expected.queue.run_until(now);
      lazy.queue.run_until(now);
      behind += lazy.pacer.behind() ? 1 : 0;
      switch (random() % 4) {
        case 0: ASSERT_EQ(lazy.look(), expected.look()) << "seed " << seed << " at " << now; break;
        case 1:
          expected.write(n);
          lazy.write(n);
          break;
        case 2:
          expected.post(static_cast<uint8_t>(n));
          lazy.post(static_cast<uint8_t>(n));
          break;
        default: break;  // nobody comes
      }
    }
    ASSERT_EQ(lazy.look(), expected.look()) << "seed " << seed;
    ASSERT_EQ(lazy.toy.sent, expected.toy.sent) << "seed " << seed;
    EXPECT_EQ(expected.toy.advances, 0U) << "in turn it is never asked for more than one tick";
    EXPECT_LT(lazy.toy.in_full, expected.toy.in_full);
  }
  EXPECT_GT(behind, 20'000U);
}

TEST(Pacer, AReaderOfALowerSourceDoesNotSeeTheTickOfThisMoment) {
  Rig rig(Pace::Lazy);
  std::vector<int64_t> seen;
  struct Reader final : runtime::EventTarget {
    Reader(Rig& of, std::vector<int64_t>& to) : rig(of), seen(to) {}
    void on_event(Time /*now*/, uint32_t /*kind*/, uint64_t /*argument*/) override {
      seen.push_back(rig.look());
    }
    Rig& rig;
    std::vector<int64_t>& seen;
  } reader(rig, seen);
  Rig expected(Pace::InTurn);
  expected.queue.run_until(3 * kMillisecond);
  const int64_t three = expected.look();
  expected.queue.run_until(4 * kMillisecond);
  const int64_t four = expected.look();
  rig.queue.schedule(4 * kMillisecond, kSource - 1, reader, 0);
  rig.queue.schedule(4 * kMillisecond, kSource + 1, reader, 0);
  rig.queue.run_until(4 * kMillisecond);
  EXPECT_EQ(seen, (std::vector<int64_t>{three, four}));
}

// An event of the own source that is scheduled in the middle of a millisecond, for its end: the tick of that moment was to come
// before it, and so it is seen, whether it was executed by then or not.
TEST(Pacer, AnAnswerComesAfterTheTickOfItsMoment) {
  struct Answer final : runtime::EventTarget {
    explicit Answer(Rig& of) : rig(of) {}
    void on_event(Time /*now*/, uint32_t /*kind*/, uint64_t /*argument*/) override {
      rig.pacer.catch_up_after_tick();
      sums.push_back(rig.toy.sum);
    }
    Rig& rig;
    std::vector<int64_t> sums;
  };
  int behind = 0;
  for (const Time start : {Time{0}, kMillisecond / 3}) {
    Rig expected(Pace::InTurn, start), lazy(Pace::Lazy, start);
    Answer in_turn(expected), late(lazy);
    for (int n = 1; n < 400; ++n) {
      const Time tick = start + n * kMillisecond;
      for (Rig* rig : {&expected, &lazy}) rig->queue.run_until(tick - kMillisecond / 5);
      behind += lazy.pacer.behind() ? 1 : 0;
      expected.queue.schedule(tick, kSource, in_turn, 0);
      lazy.queue.schedule(tick, kSource, late, 0);
      if (n % 3 == 0) lazy.look();
    }
    for (Rig* rig : {&expected, &lazy}) rig->queue.run_until(start + 500 * kMillisecond);
    EXPECT_EQ(in_turn.sums.size(), 399U);
    EXPECT_EQ(late.sums, in_turn.sums);
    EXPECT_EQ(late.rig.toy.sent, in_turn.rig.toy.sent);
  }
  EXPECT_GT(behind, 400);
}

TEST(Pacer, StoppedItExecutesNothing) {
  Rig rig(Pace::Lazy);
  rig.queue.run_until(5 * kMillisecond);
  rig.pacer.stop();
  const int64_t sum = rig.look();
  rig.queue.run_until(50 * kMillisecond);
  EXPECT_EQ(rig.look(), sum);
  EXPECT_EQ(rig.queue.pending(), 0U);
}

// A tick that stops in the middle: the next one comes a millisecond behind it, whenever it is resumed.
TEST(Pacer, ATickThatStopsIsResumed) {
  struct Stopping final : runtime::Timed {
    bool tick(Time /*now*/) override { return ++ticks % 3 != 0; }
    Time send(Time /*now*/) override {
      ++sends;
      return runtime::kNever;
    }
    Ticks horizon(Time) override { return 0; }
    Ticks advance(Time, Ticks) override { return 0; }
    Ticks silence(Time) override { return 0; }
    void settle() override {}
    void touched() override {}
    void before_telegram() override {}
    bool lets_wait() const override { return false; }
    bool rests() const override { return false; }
    int ticks = 0, sends = 0;
  } stopping;
  runtime::EventQueue queue;
  runtime::OwnMilliseconds milliseconds;
  runtime::Pacer pacer(queue, kSource, stopping, Pace::InTurn, milliseconds);
  pacer.start();
  queue.run_until(10 * kMillisecond);
  EXPECT_EQ(stopping.ticks, 3);
  EXPECT_EQ(stopping.sends, 2);
  pacer.resume();
  EXPECT_EQ(stopping.sends, 3);
  EXPECT_EQ(queue.next_time(), 10 * kMillisecond) << "a time that has passed counts as now";
  // And so on, whenever one stops; the ticks that are made up for send nothing.
  for (int stops = 2; stops <= 4; ++stops) {
    queue.run_until(stops * 10 * kMillisecond);
    EXPECT_EQ(stopping.ticks, 3 * stops);
    EXPECT_EQ(stopping.sends, stops + 1);
    EXPECT_EQ(queue.pending(), 0U) << "nothing comes before it is resumed";
    pacer.resume();
  }
}

// A run that had stopped is as any other when it becomes lazy: who writes has the next tick in its turn.
TEST(Pacer, WhoHasStoppedMayBecomeLazy) {
  struct Once final : runtime::Timed {
    bool tick(Time /*now*/) override { return ++ticks != 3; }
    Time send(Time /*now*/) override { return runtime::kNever; }
    Ticks horizon(Time) override { return 5; }
    Ticks advance(Time, Ticks most) override {
      ticks += static_cast<int>(most);
      return most;
    }
    Ticks silence(Time) override { return 20; }
    void settle() override {}
    void touched() override {}
    void before_telegram() override {}
    bool lets_wait() const override { return false; }
    bool rests() const override { return true; }
    int ticks = 0;
  } once;
  runtime::EventQueue queue;
  runtime::OwnMilliseconds milliseconds;
  runtime::Pacer pacer(queue, kSource, once, Pace::InTurn, milliseconds);
  pacer.start();
  queue.run_until(2 * kMillisecond);
  EXPECT_EQ(once.ticks, 3);
  pacer.resume();
  pacer.use(Pace::Lazy);
  EXPECT_EQ(pacer.pace(), Pace::Lazy);
  queue.run_until(5 * kMillisecond);
  EXPECT_TRUE(pacer.behind());
  EXPECT_TRUE(pacer.rests());
  pacer.touch();
  EXPECT_EQ(once.ticks, 6);
  EXPECT_FALSE(pacer.behind());
  EXPECT_FALSE(pacer.rests());
  EXPECT_EQ(queue.next_time(), 6 * kMillisecond);
}

}  // namespace
}  // namespace ipos::tests
