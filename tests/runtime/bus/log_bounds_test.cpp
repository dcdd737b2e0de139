// What logs and loads do at their edges: the order of a replay, refused frames, windows of a second, every character of a
// candump line.
#include <gtest/gtest.h>

#include <set>
#include <tuple>

#include "runtime/bus/can/frame_bits.hpp"
#include "runtime/bus/line/line_load.hpp"
#include "runtime/bus/log/bus_load.hpp"
#include "runtime/bus/log/candump.hpp"
#include "runtime/bus/log/replay.hpp"

namespace ipos::tests {
namespace {

using namespace ipos::runtime;  // NOLINT

// Says to each frame what it is told to say.
struct FullSender final : FrameSender {
  explicit FullSender(EventQueue& its_queue) : queue(its_queue) {}
  SendStatus send(const Frame& frame, uint64_t) override {
    sent.emplace_back(queue.now(), frame.id, frame.data[0]);
    return sent.size() == full_at ? SendStatus::QueueFull : SendStatus::Queued;
  }
  void withdraw(uint64_t) override {}
  void recover() override { ++recoveries; }
  EventQueue& queue;
  size_t full_at = 0;
  int recoveries = 0;
  std::vector<std::tuple<Time, uint32_t, uint8_t>> sent;
};

LogEntry entry_at(Time time, uint32_t id, uint8_t first = 0) { return {time, "x", {id, 1, {first}}}; }

// A frame is handed over so early that it can have ended at its time: it begins at the next bit boundary and ends
// without the intermission. What would lie in the past goes out at once.
TEST(Replay, OrderAndMoments) {
  EventQueue queue;
  FullSender sender(queue);
  const Time bit = 2000;
  Replay replay(queue, 7,
                {entry_at(30'000'000, 3), entry_at(10'000'000, 1, 1), entry_at(10'000'000, 2),
                 entry_at(10'000'000, 1, 2)},
                5'000'000);
  EXPECT_EQ(replay.frames(), 4U);
  EXPECT_EQ(replay.end(), 25'000'000);
  replay.start(sender, bit);
  queue.run_until(kSecond);
  const auto length = [&](uint32_t id, uint8_t first) {
    return static_cast<Time>(frame_bits({id, 1, {first}}) - 3 + 1) * bit;
  };
  using Row = std::tuple<Time, uint32_t, uint8_t>;
  ASSERT_EQ(sender.sent.size(), 4U);
  const Time begin = 5'000'000 - length(1, 1);
  EXPECT_EQ(sender.sent[0], (Row{begin, 1, 1}));
  // Equal times keep their order, though the one before may have come later.
  EXPECT_EQ(sender.sent[1], (Row{std::max(begin, 5'000'000 - length(2, 0)), 2, 0}));
  EXPECT_EQ(std::get<1>(sender.sent[2]), 1U);
  EXPECT_EQ(std::get<2>(sender.sent[2]), 2);
  EXPECT_EQ(sender.sent[3], (Row{25'000'000 - length(3, 0), 3, 0}));
}

TEST(Replay, WhatIsRefusedAndWhatIsNot) {
  EventQueue queue;
  FullSender sender(queue);
  sender.full_at = 2;
  Replay replay(queue, 7, {entry_at(0, 1), entry_at(1, 2), entry_at(2, 3)}, 0);
  replay.start(sender, 2000);
  queue.run_until(kSecond);
  EXPECT_EQ(sender.sent.size(), 3U) << "the others go on";
  EXPECT_EQ(replay.refused(), 1U);
  for (const NotSent reason : {NotSent::NoAcknowledge, NotSent::Collision, NotSent::Corrupted})
    replay.on_not_sent(0, {}, 0, reason);  // these are sent again
  EXPECT_EQ(replay.refused(), 1U);
  replay.on_not_sent(0, {}, 0, NotSent::Dropped);
  EXPECT_EQ(replay.refused(), 2U);
  replay.on_sent(0, {}, 0);
  EXPECT_EQ(replay.sent(), 1U);
  replay.on_bus_off(0);
  EXPECT_EQ(sender.recoveries, 1);
  Replay nothing(queue, 7, {}, kSecond);
  nothing.start(sender, 2000);
  queue.run_until(2 * kSecond);
  EXPECT_EQ(nothing.end(), 0);
  EXPECT_EQ(sender.sent.size(), 3U);
}

// ISO 11898-1: 47 bits and 8 a byte, and with stuff bits at worst 34 + 8 n of them in fours less one.
TEST(BusLoad, BitsOfOneFrame) {
  for (uint8_t length = 0; length <= 8; ++length)
    for (const bool remote : {false, true}) {
      LoadCount count;
      const Frame frame{0x555, length, {}, false, remote};
      count.add(frame);
      count.add(frame);
      const uint64_t bytes = remote ? 0 : length;
      EXPECT_EQ(count.frames, 2U);
      EXPECT_EQ(count.data_bits, 2 * 8 * bytes);
      EXPECT_EQ(count.exact_bits, 2U * frame_bits(frame));
      EXPECT_EQ(count.worst_bits, 2 * (47 + 8 * bytes + (34 + 8 * bytes - 1) / 4));
    }
}

TEST(BusLoad, FramesThatComeBackInTime) {
  BusLoad load;
  load.add(5 * kSecond, {1, 0});
  load.add(6 * kSecond + 1, {1, 0, {}, true, false});
  load.add(5 * kSecond, {2, 0});
  ASSERT_EQ(load.windows().size(), 2U);
  EXPECT_EQ(load.windows()[1].count.frames, 2U) << "an earlier one counts in the last window";
  EXPECT_EQ(load.span(), kSecond + 1);
  std::vector<std::pair<uint32_t, bool>> order;
  for (const auto& [id, count] : load.identifiers()) order.emplace_back(id.id, id.extended);
  EXPECT_EQ(order, (std::vector<std::pair<uint32_t, bool>>{{1, false}, {2, false}, {1, true}}));
  BusLoad late;  // a first frame before the time 0
  late.add(-kSecond, {1, 0});
  EXPECT_EQ(late.span(), 0);
}

// A thousand units a second; occupied ones by hand.
TEST(LoadMeter, SecondsAndTheBusiestOfThem) {
  LoadMeter meter(1000);
  const auto expect = [&](uint64_t elapsed, uint64_t busy, uint32_t percent, uint32_t window, uint32_t peak) {
    const LineLoad load = meter.load(elapsed);
    EXPECT_EQ(load.busy_bits, busy) << elapsed;
    EXPECT_EQ(load.elapsed_bits, elapsed);
    EXPECT_EQ(load.percent, percent) << elapsed;
    EXPECT_EQ(load.window_percent, window) << elapsed;
    EXPECT_EQ(load.peak_window_percent, peak) << elapsed;
  };
  expect(0, 0, 0, 0, 0);
  meter.add(0, 199);
  expect(999, 199, 19, 0, 0);
  expect(1000, 199, 19, 19, 19);
  meter.add(900, 250);  // 100 units of the first second, 150 of the next one
  expect(1999, 449, 22, 29, 29);
  expect(2000, 449, 22, 15, 29);
  meter.add(2000, 1000);  // one whole second and no more
  expect(2999, 1449, 48, 15, 29);
  expect(3000, 1449, 48, 100, 100);
  expect(4000, 1449, 36, 0, 100);
  meter.add(5500, 2600);  // over the ends of three seconds
  expect(8000, 4049, 50, 100, 100);
  expect(9000, 4049, 44, 10, 100);
}

// Every character that is no digit where one stands, next to the digits and letters in the code.
TEST(Candump, CharactersNextToTheDigits) {
  for (const char c : {'/', ':', '@', 'G', '`', 'g', ' '}) {
    for (const size_t at : {size_t{1}, size_t{3}, size_t{17}}) {
      std::string text = "(1.000000) a 001#1122";
      text[at] = c;
      EXPECT_FALSE(parse_candump_line(text).has_value()) << text;
    }
  }
  for (const char* text :
       {"(1.000000) a 00f#aF", "(1.000000)\ta\t00F#Af", "(1.000000) a 00F#Af T", "(1.000000) a 00f#AF\r"}) {
    const auto entry = parse_candump_line(text);
    ASSERT_TRUE(entry.has_value()) << text;
    EXPECT_EQ(entry->frame, (Frame{15, 1, {0xAF}}));
  }
  // A remote frame may tell a length from 0 to 8.
  for (int length = 0; length <= 8; ++length) {
    const auto entry = parse_candump_line("(1.000000) a 001#R" + std::to_string(length));
    ASSERT_TRUE(entry.has_value());
    EXPECT_EQ(entry->frame, (Frame{1, static_cast<uint8_t>(length), {}, false, true}));
  }
  EXPECT_EQ(parse_candump_line("(1.000000) a 001#R R")->frame, (Frame{1, 0, {}, false, true}));
  EXPECT_EQ(parse_candump_line("(1.000000) a 001#R/").error().column, 19U);
  EXPECT_EQ(parse_candump_line("(9000000000.999999) a 001#")->time,
            (9'000'000'000 - 946'684'800) * kSecond + 999'999 * kMicrosecond);
  EXPECT_EQ(parse_candump_line("(1.000000) a 1FFFFFFF#")->frame.id, 0x1FFF'FFFFU);
  EXPECT_EQ(parse_candump_line("(1.000000) a 7FF#1122334455667788")->frame.length, 8);
}

TEST(Candump, EmptyLinesCount) {
  const auto log = parse_candump("\n \t\r\n(1.000000) a 001#\n\n(1.000000) a 002#\nx");
  ASSERT_FALSE(log.has_value());
  EXPECT_EQ(log.error().line, 6U);
  const auto good = parse_candump("(1.000000) a 001#\n\n(1.000000) b 002#");
  ASSERT_TRUE(good.has_value());
  ASSERT_EQ(good->size(), 2U);
  EXPECT_EQ((*good)[1].bus, "b");
  EXPECT_TRUE(parse_candump("")->empty());
}

}  // namespace
}  // namespace ipos::tests
