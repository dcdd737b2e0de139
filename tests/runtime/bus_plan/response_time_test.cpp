// The response time analysis: the example of the paper worked by hand, and random sets on the simulated line,
// which must never exceed the bound.
#include "runtime/bus_plan/response_time.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <map>
#include <random>

#include "runtime/bus/can/frame_bits.hpp"
#include "runtime/bus/can/line.hpp"
#include "runtime/bus_plan/telegrams.hpp"

namespace ipos::runtime {
namespace {

// Davis, Burns, Bril, Lukkien 2007, table 1: 125 kbit/s, 7 data bytes, so 125 bits = 1 ms each.
TEST(ResponseTime, ExampleOfThePaper) {
  ASSERT_EQ(worst_case_bits(7, false), 125U);
  const Time bit = 8 * kMicrosecond;
  const Time c = 125 * bit;
  ASSERT_EQ(c, kMillisecond);
  const std::vector<PeriodicFrame> set = {
      {1, c, 2500 * kMicrosecond, 0}, {2, c, 3500 * kMicrosecond, 0}, {3, c, 3500 * kMicrosecond, 0}};
  const auto results = response_times(set, bit);

  // A: blocked by one frame. Busy period: 1 + ceil(t / 2.5) * 1, t = 1 -> 2 -> 2. One instance: w = 1, R = 2
  // ms.
  EXPECT_EQ(results[0].blocking, kMillisecond);
  EXPECT_EQ(results[0].busy_period, 2 * kMillisecond);
  EXPECT_EQ(results[0].instances, 1U);
  EXPECT_EQ(results[0].worst, 2 * kMillisecond);

  // B: blocked by C. Busy period: 1 + ceil(t / 3.5) + ceil(t / 2.5), t = 1 -> 3 -> 4 -> 5 -> 5; 2 instances.
  // q = 0: w = 1 + ceil((w + bit) / 2.5) = 2, R = 3. q = 1: w = 1 + 1 + ceil((w + bit) / 2.5): 3 -> 4 -> 4,
  // since 4.008 / 2.5 gives 2. R = 4 - 3.5 + 1 = 1.5.
  EXPECT_EQ(results[1].busy_period, 5 * kMillisecond);
  EXPECT_EQ(results[1].instances, 2U);
  EXPECT_EQ(results[1].worst, 3 * kMillisecond);

  // C: not blocked. Busy period: ceil(t / 3.5) * 2 + ceil(t / 2.5): 1 -> 3 -> 4 -> 6 -> 7 -> 7; 2 instances.
  // q = 0: w = 2, R = 3 ms, which the old analysis took for the worst. q = 1: w = 1 + ceil(./2.5) +
  // ceil(./3.5): 3 -> 4 -> 5 -> 6 -> 6. R = 6 - 3.5 + 1 = 3.5 ms: beyond the deadline of 3.25 ms.
  EXPECT_EQ(results[2].blocking, 0);
  EXPECT_EQ(results[2].busy_period, 7 * kMillisecond);
  EXPECT_EQ(results[2].instances, 2U);
  EXPECT_EQ(results[2].worst, 3500 * kMicrosecond);
  for (const ResponseTime& result : results) EXPECT_TRUE(result.bounded);
}

TEST(ResponseTime, JitterAndOverload) {
  const Time bit = 2 * kMicrosecond;
  const Time c = 135 * bit;
  // Alone: its jitter and its length.
  auto results = response_times(std::vector<PeriodicFrame>{{1, c, 10 * kMillisecond, kMillisecond}}, bit);
  EXPECT_EQ(results[0].worst, kMillisecond + c);
  // A jitter above the period: several instances queue up. T = 1 ms, J = 2.5 ms: busy period t = ceil((t
  // + 2.5) / 1) C = 4 C = 1.08 ms with 4 instances (3.58 -> 4); q = 3: R = 2.5 + 3 C - 3 + C < R of q = 0
  // = 2.5 + C.
  results = response_times(std::vector<PeriodicFrame>{{1, c, kMillisecond, 2500 * kMicrosecond}}, bit);
  EXPECT_EQ(results[0].worst, 2500 * kMicrosecond + c);
  EXPECT_EQ(results[0].instances, 4U);
  // 5 x 270 us in a millisecond: no bound from the fourth on.
  std::vector<PeriodicFrame> heavy;
  for (uint32_t id = 0; id < 5; ++id) heavy.push_back({id, c, kMillisecond, 0});
  results = response_times(heavy, bit);
  EXPECT_TRUE(results[2].bounded);
  EXPECT_FALSE(results[3].bounded);
  EXPECT_FALSE(results[4].bounded);
}

// A line that is full to the last nanosecond has no bound, one with a nanosecond left in a second has.
TEST(ResponseTime, TheLastNanosecondOfTheLine) {
  const auto of_the_lower = [](Time higher, Time lower) {
    return response_times(std::vector<PeriodicFrame>{{1, higher, kSecond, 0}, {2, lower, kSecond, 0}},
                          2 * kMicrosecond)[1];
  };
  for (const Time first : std::vector<Time>{0, 400 * kMillisecond, 599'999'999, 600 * kMillisecond,
                                            kSecond - kMillisecond, kSecond}) {
    EXPECT_FALSE(of_the_lower(first, kSecond - first).bounded) << first;
    EXPECT_FALSE(of_the_lower(first, kSecond - first + 1).bounded) << first;
    if (first == kSecond) continue;
    const ResponseTime least = of_the_lower(first, kSecond - first - 1);
    EXPECT_TRUE(least.bounded) << first;
    EXPECT_EQ(least.worst, kSecond - 1) << first;
  }
  // Thirds of a second are rounded up: three of them are full.
  const Time third = kSecond / 3;
  EXPECT_FALSE(response_times(
                   std::vector<PeriodicFrame>{
                       {1, third, 3 * third, 0}, {2, third, 3 * third, 0}, {3, third, 3 * third, 0}},
                   2 * kMicrosecond)[2]
                   .bounded);
}

// A line that is busy for 1000 s without an end has no bound (ours).
TEST(ResponseTime, GivesUpAfterAThousandSeconds) {
  const auto of_the_last = [](size_t frames) {
    std::vector<PeriodicFrame> set;
    for (uint32_t id = 0; id < frames; ++id) set.push_back({id, kSecond, 2000 * kSecond, 0});
    return response_times(set, 2 * kMicrosecond).back();
  };
  EXPECT_TRUE(of_the_last(999).bounded);
  EXPECT_EQ(of_the_last(999).worst, 999 * kSecond);
  EXPECT_FALSE(of_the_last(1000).bounded);
}

// The answer to a telegram of a low priority, which never comes on a full line, has no bound either, however high its
// own priority is.
TEST(ResponseTime, NoAnswerWithoutARequest) {
  const Time bit = 2 * kMicrosecond;
  const auto planned = [&](Time of_the_object) {
    std::vector<PlannedTelegram> telegrams(3);
    telegrams[0] = {12, "unit", "PI", 6, Rhythm::Answer, 10 * kMillisecond, kMillisecond, 2000, {}};
    telegrams[1] = {1024, "other", "object", 8, Rhythm::Cyclic, of_the_object, 0, ~0U, {}};
    telegrams[2] = {2000, "plc", "sync", 0, Rhythm::Cyclic, 10 * kMillisecond, 0, ~0U, {}};
    analyse(telegrams, bit);
    return telegrams;
  };
  for (const PlannedTelegram& telegram : planned(kMillisecond))
    EXPECT_TRUE(telegram.response.bounded) << telegram.what;
  // 270 us of every 250 us.
  for (const PlannedTelegram& telegram : planned(250 * kMicrosecond))
    EXPECT_FALSE(telegram.response.bounded) << telegram.what;
}

// Sends one message periodically, each instance with a jitter of its own.
class Sender final : public CanNode, private EventTarget {
 public:
  struct Stream {
    PeriodicFrame planned;
    uint8_t bytes;
    Time offset;
    std::vector<Time> events;  // when each instance was due
    size_t done = 0;
    Time worst = 0;
  };
  Sender(EventQueue& queue, uint32_t source, std::mt19937& random)
      : queue_(queue), source_(source), random_(random) {}

  void start(FrameSender& sender, Time end) {
    sender_ = &sender;
    for (size_t s = 0; s < streams.size(); ++s)
      for (Time at = streams[s].offset; at < end; at += streams[s].planned.period) {
        const Time jitter = streams[s].planned.jitter;
        streams[s].events.push_back(at);
        queue_.schedule(at + (jitter > 0 ? static_cast<Time>(random_()) % (jitter + 1) : 0), source_, *this,
                        0, s);
      }
  }
  void on_frame(Time, const Frame&) override {}
  void on_sent(Time now, const Frame&, uint64_t tag) override {
    Stream& stream = streams[tag];
    stream.worst = std::max(stream.worst, now - stream.events[stream.done++]);
  }
  void on_not_sent(Time, const Frame&, uint64_t, NotSent) override {}
  std::vector<Stream> streams;

 private:
  void on_event(Time, uint32_t, uint64_t stream) override {
    Frame frame;
    frame.id = streams[stream].planned.id;
    frame.length = streams[stream].bytes;
    // Mostly data with many stuff bits.
    for (size_t n = 0; n < frame.length; ++n)
      frame.data[n] = static_cast<uint8_t>(random_() % 2 == 0 ? 0x3C : random_() % 2 == 0 ? 0 : random_());
    sender_->send(frame, stream);
  }
  EventQueue& queue_;
  uint32_t source_;
  std::mt19937& random_;
  FrameSender* sender_ = nullptr;
};

class Listener final : public CanNode {
 public:
  void on_frame(Time, const Frame&) override {}
  void on_sent(Time, const Frame&, uint64_t) override {}
  void on_not_sent(Time, const Frame&, uint64_t, NotSent) override {}
};

TEST(ResponseTime, SimulationNeverExceedsTheBound) {
  std::mt19937 random(12);
  size_t compared = 0;
  double closest = 0;
  for (int set = 0; set < 300; ++set) {
    const uint32_t baud = kBaudRates[random() % kBaudRates.size()];
    EventQueue queue;
    CanLine line(queue, 3, "sim", baud);
    const Time bit = line.bit_time();
    std::vector<std::unique_ptr<Sender>> senders;
    std::vector<LinePort> ports;
    std::vector<PeriodicFrame> planned;
    const size_t stations = 2 + random() % 5;
    for (size_t n = 0; n < stations; ++n)
      senders.push_back(std::make_unique<Sender>(queue, static_cast<uint32_t>(5 + n), random));
    uint32_t id = static_cast<uint32_t>(random() % 50);
    const size_t messages = 3 + random() % 12;
    for (size_t m = 0; m < messages; ++m) {
      const auto bytes = static_cast<uint8_t>(random() % 9);
      const Time period = static_cast<Time>(200 + random() % 3000) * bit * 4;
      const Time jitter = random() % 3 == 0 ? static_cast<Time>(random()) % period : 0;
      // A frame takes part from the next bit boundary on.
      planned.push_back({id, worst_case_bits(bytes, false) * bit, period, jitter + bit});
      const Time offset = random() % 3 == 0 ? 0 : static_cast<Time>(random()) % period;  // often all at once
      senders[random() % stations]->streams.push_back({{id, 0, period, jitter}, bytes, offset, {}, 0, 0});
      id += 1 + static_cast<uint32_t>(random() % 100);
    }
    Listener listener;
    line.attach("listener", baud, listener);
    ports.reserve(stations);
    const Time end = 60'000 * bit;
    for (auto& sender : senders) {
      ports.emplace_back(line, line.attach("station", baud, *sender));
      sender->start(ports.back(), end);
    }
    queue.run_until(2 * end);
    std::map<uint32_t, ResponseTime> bound;
    const std::vector<ResponseTime> results = response_times(planned, bit);
    for (size_t n = 0; n < planned.size(); ++n) bound[planned[n].id] = results[n];
    for (const auto& sender : senders)
      for (const Sender::Stream& stream : sender->streams) {
        const ResponseTime& limit = bound[stream.planned.id];
        if (!limit.bounded) continue;
        compared += stream.done;
        EXPECT_LE(stream.worst, limit.worst) << "set " << set << " identifier " << stream.planned.id;
        closest = std::max(closest, static_cast<double>(stream.worst) / static_cast<double>(limit.worst));
      }
  }
  std::cout << "response times: " << compared << " frames within their bounds, the closest at "
            << static_cast<int>(closest * 100) << " %\n";
  EXPECT_GT(compared, 30'000U);
  EXPECT_GT(closest, 0.9);  // the bound is not idle talk
}

}  // namespace
}  // namespace ipos::runtime
