// What the pacer asks and orders, and when: each call stands in a journal with its time in milliseconds, and the expected
// one follows from timed.hpp. Backoff and Inbox by themselves.
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <utility>

#include "runtime/pace/backoff.hpp"
#include "runtime/pace/pacer.hpp"

namespace ipos::tests {
namespace {

using runtime::EventQueue;
using runtime::kMillisecond;
using runtime::kNever;
using runtime::Pace;
using runtime::Pacer;
using runtime::Ticks;
using runtime::Time;

constexpr uint32_t kPlace = 5;  // of the pacer among the sources

// Has its answers from the test and writes down what it is asked.
struct Journal final : runtime::Timed, runtime::TelegramReader {
  explicit Journal(EventQueue& of) : queue(of) {}

  bool tick(Time now) override {
    EXPECT_EQ(queue.now(), now) << "a tick finds its own time";
    note("tick", now);
    if (on_tick) on_tick(now);
    return true;
  }
  Time send(Time now) override {
    note("send", now);
    return telegram_every == 0 ? kNever : (now / telegram_every + 1) * telegram_every;
  }
  Time send_at_rest(Time now, Time until) override {
    if (!leaves) return send(now);
    note("leave", now, " until " + std::to_string(until / kMillisecond));
    return kNever;
  }
  void rest_ends() override {
    if (leaves) text += "rest ends; ";
  }
  Ticks horizon(Time first) override {
    EXPECT_EQ(queue.now(), first);
    return ahead;
  }
  Ticks advance(Time first, Ticks most) override {
    const Ticks done = most < able ? most : able;
    note("advance", first, "+" + std::to_string(most));
    return done;
  }
  Ticks silence(Time first) override {
    note("silence", first);
    return quiet;
  }
  void settle() override { text += "settle; "; }
  void touched() override { text += "touched; "; }
  void before_telegram() override { text += "telegram; "; }
  bool lets_wait() const override { return waits; }
  bool rests() const override { return idle; }
  void read(size_t number, const runtime::TelegramData& data) override {
    text += "read " + std::to_string(number) + ":" + std::to_string(data.bytes[0]) + "; ";
    if (on_read) on_read();
  }

  void note(const char* what, Time at, const std::string& more = "") {
    text += std::string(what) + " " + std::to_string(at / kMillisecond) + more + "; ";
  }
  std::string take() { return std::exchange(text, ""); }

  EventQueue& queue;
  Ticks ahead = 0, able = runtime::kNoBound, quiet = 0;
  Time telegram_every = 0;
  bool waits = true, idle = false, leaves = false;
  std::function<void(Time)> on_tick;
  std::function<void()> on_read;
  std::string text;
};

struct Desk {
  explicit Desk(Pace pace = Pace::Lazy) : pacer(queue, kPlace, timed, pace, milliseconds) {}
  // The journal up to that millisecond, and a bit further, so that no tick is at this moment.
  std::string until(Time ms) {
    queue.run_until(ms * kMillisecond + kMillisecond / 2);
    return timed.take();
  }
  bool post(size_t number, uint8_t value) { return pacer.post(timed, number, {{value}, 1}); }
  Time next() const { return queue.next_time() / kMillisecond; }

  EventQueue queue;
  Journal timed{queue};
  runtime::OwnMilliseconds milliseconds;
  Pacer pacer;
};

TEST(PacerJournal, InTurnEachTickIsExecutedSentAndSettled) {
  Desk desk(Pace::InTurn);
  desk.timed.ahead = desk.timed.quiet = 9;
  desk.pacer.start();
  EXPECT_EQ(desk.until(2), "tick 0; send 0; settle; tick 1; send 1; settle; tick 2; send 2; settle; ")
      << "what a lazy one is asked it is not";
  EXPECT_FALSE(desk.pacer.behind());
  EXPECT_EQ(desk.queue.next_time(), 3 * kMillisecond);
  desk.pacer.catch_up();
  desk.pacer.execute_pending();
  EXPECT_EQ(desk.timed.take(), "") << "nothing to catch up with";
}

TEST(PacerJournal, TheFirstTickIsWhenItStarts) {
  for (const Time begin : {Time{0}, Time{1}, 7 * kMillisecond, 7 * kMillisecond + 123}) {
    Desk desk;
    desk.queue.run_until(begin);
    desk.pacer.start();
    desk.queue.run_until(begin + 2 * kMillisecond);
    const Time ms = begin / kMillisecond;
    std::string expected;
    for (Time n = ms; n < ms + 3; ++n)
      expected += "tick " + std::to_string(n) + "; send " + std::to_string(n) + "; silence " +
                  std::to_string(n + 1) + "; settle; ";
    EXPECT_EQ(desk.timed.take(), expected) << begin;
    EXPECT_EQ(desk.queue.next_time(), begin + 3 * kMillisecond);
  }
}

// The next event is the telegram or the end of the silence, whichever is first; all ticks in between are executed then.
TEST(PacerJournal, TheNextEventIsTheTelegramOrTheEndOfTheSilence) {
  Desk silence;
  silence.timed.quiet = 4;
  silence.pacer.start();
  EXPECT_EQ(silence.until(0), "tick 0; send 0; silence 1; ");
  EXPECT_TRUE(silence.pacer.behind());
  EXPECT_EQ(silence.next(), 5);
  EXPECT_EQ(silence.until(4), "");
  EXPECT_EQ(silence.until(5), "tick 1; tick 2; tick 3; tick 4; tick 5; send 5; silence 6; ");
  EXPECT_EQ(silence.next(), 10);

  Desk telegram;
  telegram.timed.quiet = 7;
  telegram.timed.telegram_every = 3 * kMillisecond;
  telegram.pacer.start();
  EXPECT_EQ(telegram.until(0), "tick 0; send 0; silence 1; ");
  EXPECT_EQ(telegram.next(), 3);
  EXPECT_EQ(telegram.until(3), "tick 1; tick 2; tick 3; send 3; silence 4; ");
  EXPECT_EQ(telegram.next(), 6);

  Desk both;
  both.timed.quiet = 2;
  both.timed.telegram_every = 3 * kMillisecond;
  both.pacer.start();
  both.until(0);
  EXPECT_EQ(both.next(), 3);
  EXPECT_EQ(both.until(3), "tick 1; tick 2; tick 3; send 3; silence 4; ");

  // A telegram of the very next tick: nobody asks how long it would be silent, and all is settled.
  Desk next;
  next.timed.quiet = 4;
  next.timed.telegram_every = kMillisecond;
  next.pacer.start();
  EXPECT_EQ(next.until(1), "tick 0; send 0; settle; tick 1; send 1; settle; ");
  EXPECT_FALSE(next.pacer.behind());
  // And without any silence it is not behind.
  Desk none;
  none.pacer.start();
  EXPECT_EQ(none.until(1), "tick 0; send 0; silence 1; settle; tick 1; send 1; silence 2; settle; ");
  EXPECT_FALSE(none.pacer.behind());
}

// What can be done at once: as far as the horizon, and not beyond the tick that is to be reached.
TEST(PacerJournal, ManyTicksAreDoneAtOnceAsFarAsTheyAreAskedFor) {
  Desk desk;
  desk.timed.quiet = 9;
  desk.timed.ahead = 4;
  desk.pacer.start();
  EXPECT_EQ(desk.until(0), "advance 0+1; send 0; silence 1; ");
  EXPECT_EQ(desk.until(10), "advance 1+4; advance 5+4; advance 9+2; send 10; silence 11; ");
  desk.timed.able = 3;  // less than what it said
  EXPECT_EQ(desk.until(20), "advance 11+4; advance 14+4; advance 17+4; advance 20+1; send 20; silence 21; ");
  desk.timed.able = 0;  // it cannot: each one is a tick
  desk.timed.quiet = 1;
  EXPECT_EQ(
      desk.until(30),
      "advance 21+4; tick 21; advance 22+4; tick 22; advance 23+4; tick 23; advance 24+4; tick 24; advance "
      "25+4; "
      "tick 25; advance 26+4; tick 26; advance 27+4; tick 27; advance 28+3; tick 28; advance 29+2; tick 29; "
      "advance 30+1; tick 30; send 30; silence 31; ");
}

// In a silence in which nothing changes that others see the telegrams go without the ticks.
TEST(PacerJournal, WhileItRestsTelegramsGoWithoutTicks) {
  Desk desk;
  desk.timed.quiet = 8;
  desk.timed.idle = true;
  desk.timed.telegram_every = 3 * kMillisecond;
  desk.pacer.start();
  EXPECT_EQ(desk.until(0), "tick 0; send 0; silence 1; ");
  EXPECT_TRUE(desk.pacer.rests());
  EXPECT_EQ(desk.until(3), "send 3; ");
  EXPECT_EQ(desk.until(6), "send 6; ");
  EXPECT_EQ(desk.next(), 9);
  EXPECT_EQ(desk.until(9),
            "tick 1; tick 2; tick 3; tick 4; tick 5; tick 6; tick 7; tick 8; tick 9; send 9; silence 10; ");
  // The silence ends between two telegrams.
  desk.timed.quiet = 3;
  EXPECT_EQ(desk.until(18),
            "send 12; send 15; tick 10; tick 11; tick 12; tick 13; tick 14; tick 15; tick 16; tick 17; "
            "tick 18; send 18; silence 19; ");
  EXPECT_EQ(desk.next(), 21);
  EXPECT_EQ(desk.until(21), "send 21; ");
  EXPECT_EQ(desk.next(), 22) << "the end of the silence";
  // Not behind it does not rest.
  desk.timed.quiet = 0;
  desk.timed.telegram_every = 0;
  desk.until(22);
  EXPECT_FALSE(desk.pacer.behind());
  EXPECT_FALSE(desk.pacer.rests());
}

TEST(PacerJournal, WhoReadsHasAllTicksUpToNowAndWhoWritesTheNextInItsTurn) {
  Desk desk;
  desk.timed.quiet = 20;
  desk.timed.idle = true;
  desk.pacer.start();
  desk.until(3);
  desk.timed.take();
  desk.pacer.execute_pending();
  EXPECT_EQ(desk.timed.take(), "tick 1; tick 2; tick 3; ") << "not settled";
  desk.pacer.execute_pending();
  EXPECT_EQ(desk.timed.take(), "") << "once";
  desk.pacer.catch_up();
  EXPECT_EQ(desk.timed.take(), "settle; ");
  desk.until(5);
  desk.pacer.catch_up();
  EXPECT_EQ(desk.timed.take(), "tick 4; tick 5; settle; ");
  EXPECT_TRUE(desk.pacer.behind()) << "who reads changes nothing";
  EXPECT_TRUE(desk.pacer.rests());
  EXPECT_EQ(desk.next(), 21);
  desk.until(6);
  desk.pacer.touch();
  EXPECT_EQ(desk.timed.take(), "tick 6; settle; touched; ");
  EXPECT_FALSE(desk.pacer.behind());
  EXPECT_FALSE(desk.pacer.rests());
  EXPECT_EQ(desk.next(), 7);
  EXPECT_EQ(desk.queue.pending(), 1U) << "the end of the silence does not come any more";
  desk.pacer.touch();
  EXPECT_EQ(desk.timed.take(), "touched; ") << "nothing is behind";
  EXPECT_EQ(desk.queue.pending(), 1U);
  EXPECT_EQ(desk.until(7), "tick 7; send 7; silence 8; ");
  EXPECT_EQ(desk.next(), 28);
}

TEST(PacerJournal, AnotherPaceBeginsWithTheNextTick) {
  Desk desk;
  desk.timed.quiet = 20;
  desk.pacer.start();
  desk.until(4);
  desk.pacer.use(Pace::InTurn);
  EXPECT_EQ(desk.timed.take(), "tick 1; tick 2; tick 3; tick 4; settle; touched; ");
  EXPECT_EQ(desk.until(6), "tick 5; send 5; settle; tick 6; send 6; settle; ");
  desk.pacer.use(Pace::Lazy);
  EXPECT_EQ(desk.timed.take(), "touched; ");
  EXPECT_EQ(desk.until(8), "tick 7; send 7; silence 8; ");
}

TEST(PacerJournal, StoppedItHasCaughtUpAndItMayStartAgain) {
  Desk desk;
  desk.timed.quiet = 20;
  desk.timed.idle = true;
  desk.pacer.start();
  desk.until(2);
  desk.pacer.stop();
  EXPECT_EQ(desk.timed.take(), "tick 1; tick 2; settle; ");
  EXPECT_FALSE(desk.pacer.behind());
  EXPECT_FALSE(desk.pacer.rests());
  EXPECT_EQ(desk.queue.pending(), 0U);
  EXPECT_FALSE(desk.post(1, 1));
  desk.pacer.touch();
  EXPECT_EQ(desk.queue.pending(), 0U) << "who writes does not start it";
  EXPECT_EQ(desk.until(9), "touched; ");
  desk.queue.run_until(10 * kMillisecond);
  desk.pacer.start();
  EXPECT_EQ(desk.until(10), "tick 10; send 10; silence 11; ");
  EXPECT_EQ(desk.next(), 31);
}

// At rest it may leave to others what it sends, until the silence ends: then it is told before the ticks that are pending.
TEST(PacerJournal, WhatIsSentAtRestMayBeLeftToOthers) {
  const auto begin = [](Desk& desk) {
    desk.timed.quiet = 20;
    desk.timed.idle = desk.timed.leaves = true;
    desk.timed.telegram_every = 3 * kMillisecond;
    desk.pacer.start();
    EXPECT_EQ(desk.until(3), "tick 0; send 0; silence 1; leave 3 until 21; ");
    EXPECT_EQ(desk.next(), 21);
    desk.timed.ahead = 40;
  };
  {
    Desk desk;
    begin(desk);
    desk.pacer.catch_up();
    EXPECT_EQ(desk.timed.take(), "advance 1+3; settle; ") << "who reads does not end it";
    EXPECT_EQ(desk.until(21), "rest ends; advance 4+18; send 21; silence 22; ");
    EXPECT_EQ(desk.until(24), "leave 24 until 42; ") << "and it begins anew";
  }
  {
    Desk desk;
    begin(desk);
    desk.pacer.touch();
    EXPECT_EQ(desk.timed.take(), "advance 1+3; settle; touched; rest ends; ");
    desk.pacer.touch();
    EXPECT_EQ(desk.timed.take(), "touched; ") << "once";
  }
  {
    Desk desk;
    begin(desk);
    desk.pacer.stop();
    EXPECT_EQ(desk.timed.take(), "advance 1+3; settle; rest ends; ");
  }
  {
    Desk desk;
    begin(desk);
    desk.pacer.use(Pace::InTurn);
    EXPECT_EQ(desk.timed.take(), "advance 1+3; settle; touched; rest ends; ");
    EXPECT_EQ(desk.until(4), "tick 4; send 4; settle; ");
  }
}

// A telegram is read behind the tick in front of it, before the next one.
TEST(PacerJournal, TelegramsWaitForTheTickBehindWhichTheyCame) {
  Desk desk;
  EXPECT_FALSE(desk.post(0, 0)) << "it is not running";
  desk.timed.quiet = 9;
  desk.pacer.start();
  desk.until(0);
  EXPECT_TRUE(desk.post(1, 10));
  desk.until(3);
  EXPECT_TRUE(desk.post(2, 20));
  EXPECT_TRUE(desk.post(3, 30));
  desk.until(5);
  EXPECT_TRUE(desk.post(4, 40));
  EXPECT_FALSE(desk.post(5, 50)) << "no room for more than four";
  EXPECT_EQ(desk.timed.take(), "");
  EXPECT_EQ(desk.until(10),
            "telegram; read 1:10; tick 1; tick 2; tick 3; telegram; read 2:20; telegram; read 3:30; tick 4; "
            "tick 5; telegram; read 4:40; tick 6; "
            "tick 7; tick 8; tick 9; tick 10; send 10; silence 11; ");
  // What is done at once ends at the telegram, too.
  desk.timed.ahead = 100;
  desk.until(12);
  EXPECT_TRUE(desk.post(6, 60));
  EXPECT_TRUE(desk.post(7, 70));
  desk.pacer.catch_up();
  EXPECT_EQ(desk.timed.take(), "advance 11+2; telegram; read 6:60; telegram; read 7:70; settle; ");
  desk.timed.waits = false;
  EXPECT_FALSE(desk.post(8, 80)) << "its reader cannot wait";
  desk.timed.waits = true;
  // One that comes behind ticks that have been executed is read by the next who looks.
  EXPECT_TRUE(desk.post(9, 90));
  desk.pacer.catch_up();
  EXPECT_EQ(desk.timed.take(), "telegram; read 9:90; settle; ");
}

// A telegram of this very tick: who has a lower place than the pacer comes in front of the tick, others behind it.
TEST(PacerJournal, AtTheMomentOfATickTheOrderOfPlacesCounts) {
  struct Poster final : runtime::EventTarget {
    explicit Poster(Desk& of) : desk(of) {}
    void on_event(Time /*now*/, uint32_t kind, uint64_t /*argument*/) override {
      EXPECT_TRUE(desk.post(kind, static_cast<uint8_t>(kind)));
    }
    Desk& desk;
  };
  Desk desk;
  Poster poster(desk);
  desk.timed.quiet = 9;
  desk.pacer.start();
  desk.queue.schedule(4 * kMillisecond, kPlace - 1, poster, 1);
  desk.queue.schedule(4 * kMillisecond, kPlace + 1, poster, 2);
  desk.until(6);
  desk.timed.take();
  desk.pacer.catch_up();
  EXPECT_EQ(
      desk.timed.take(),
      "tick 1; tick 2; tick 3; telegram; read 1:1; tick 4; telegram; read 2:2; tick 5; tick 6; settle; ");
}

// Who reads a telegram, or whom a tick asks, may catch up and touch: it finds what has been executed, and the run that
// is under way goes on.
TEST(PacerJournal, WhoIsAskedMayCatchUpAndTouchItself) {
  Desk desk;
  desk.timed.quiet = 9;
  desk.pacer.start();
  desk.until(2);
  ASSERT_TRUE(desk.post(1, 10));
  desk.until(4);
  desk.timed.take();
  desk.timed.on_read = [&] {
    desk.pacer.touch();
    EXPECT_TRUE(desk.pacer.behind()) << "what is under way goes on";
  };
  desk.pacer.catch_up();
  EXPECT_EQ(desk.timed.take(),
            "tick 1; tick 2; telegram; read 1:10; settle; touched; tick 3; tick 4; settle; ");
  EXPECT_EQ(desk.queue.pending(), 1U);
  EXPECT_EQ(desk.next(), 10);
  desk.pacer.touch();
  EXPECT_EQ(desk.timed.take(), "settle; touched; ");
  EXPECT_FALSE(desk.pacer.behind()) << "nothing is under way any more";
  EXPECT_EQ(desk.next(), 5);
}

TEST(Backoff, PausesAreTwiceAsLongEachTimeUpToTheLongest) {
  runtime::Backoff backoff;
  EXPECT_TRUE(backoff.due(0));
  for (const uint32_t pause : {2u, 4u, 8u, 16u, 20u, 20u}) {
    backoff.fail(100 * kMillisecond, 20);
    const Time again = (100 + pause) * kMillisecond;
    EXPECT_FALSE(backoff.due(again - 1)) << pause;
    EXPECT_TRUE(backoff.due(again)) << pause;
    EXPECT_TRUE(backoff.due(again + 1)) << pause;
  }
  backoff.try_now();
  EXPECT_TRUE(backoff.due(0));
  backoff.fail(0, 64);
  EXPECT_FALSE(backoff.due(39 * kMillisecond)) << "the pauses go on from where they are";
  EXPECT_TRUE(backoff.due(40 * kMillisecond));
  backoff.succeed();
  backoff.fail(0, 64);
  EXPECT_FALSE(backoff.due(kMillisecond));
  EXPECT_TRUE(backoff.due(2 * kMillisecond)) << "they begin anew";
}

TEST(Inbox, HoldsFourTelegramsInTheirOrder) {
  runtime::Inbox inbox;
  EventQueue queue;
  Journal reader(queue);
  for (int round = 0; round < 3; ++round) {
    EXPECT_EQ(inbox.next(), kNever);
    for (uint8_t n = 0; n < 4; ++n) {
      EXPECT_FALSE(inbox.full());
      inbox.post(100 + n, reader, n, {{static_cast<uint8_t>(10 * n)}, 1});
      EXPECT_EQ(inbox.next(), 100) << "the first";
    }
    EXPECT_TRUE(inbox.full());
    for (Time n = 0; n < 4; ++n) {
      EXPECT_EQ(inbox.next(), 100 + n);
      inbox.read_next();
    }
    EXPECT_EQ(reader.take(), "read 0:0; read 1:10; read 2:20; read 3:30; ");
  }
  EXPECT_FALSE(inbox.full());
}

}  // namespace
}  // namespace ipos::tests
