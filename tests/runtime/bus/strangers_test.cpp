// Stations at another rate and with interchanged wires: what they destroy, for how long, and what the counters of all say
// (ISO 11898-1, error signalling and fault confinement). The expected bits are counted by hand on one frame:
//
//   bit   0  1..11        12 13 14  15..18  19..82
//         0  10101010101  0  0  0   1000    01 01 01 ..
//
// identifier 555h, eight bytes 55h: no stuff bit before bit 83.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "runtime/bus/can/clash.hpp"
#include "runtime/bus/can/line.hpp"
#include "runtime/bus/log/candump.hpp"

namespace ipos::runtime {
namespace {

constexpr Frame kFrame{0x555, 8, {0x55, 0x55, 0x55, 0x55, 0x55, 0x55, 0x55, 0x55}, false, false};

class Station final : public CanNode {
 public:
  void on_frame(Time, const Frame& frame) override { received.push_back(frame.id); }
  void on_sent(Time, const Frame&, uint64_t) override { ++sent; }
  void on_not_sent(Time, const Frame&, uint64_t, NotSent) override { ++failed; }
  void on_bus_off(Time) override { ++bus_off; }
  std::vector<uint32_t> received;
  int sent = 0, failed = 0, bus_off = 0;
};

class Watcher final : public CanObserver {
 public:
  void on_frame(const CanLine&, const FrameRecord&) override { ++frames; }
  void on_error_frame(const CanLine& line, const ErrorRecord& record) override {
    errors.push_back(record);
    last = candump_line(line, record);
  }
  void on_line_event(const CanLine& line, const LineEvent& event) override { texts.push_back(describe(line, event)); }
  size_t count(const std::string& part) const {
    size_t n = 0;
    for (const std::string& text : texts) n += text.find(part) != std::string::npos;
    return n;
  }
  size_t frames = 0;
  std::vector<ErrorRecord> errors;
  std::vector<std::string> texts;
  std::string last;
};

// a and c at the rate of the line, b at another one.
struct Bench {
  EventQueue queue;
  CanLine line{queue, 9, "sbus", 500'000};
  Watcher watcher;
  Station a, b, c;
  static constexpr NodeId kA = 0, kB = 1, kC = 2;
  explicit Bench(uint32_t baud) {
    line.add_observer(watcher);
    line.attach("a", 500'000, a);
    line.attach("b", baud, b);
    line.attach("c", 500'000, c);
  }
  void run(Time span) { queue.run_until(queue.now() + span); }
  uint32_t tec(NodeId node) const { return line.counters(node).transmit; }
  uint32_t rec(NodeId node) const { return line.counters(node).receive; }
};

// Half the rate: b sees the odd bits, 13 as its start of frame, then 1 and six times 0 up to bit 27. Its flag is 28..39. The
// sender has a 1 in bit 28, its flag is 29..34; the listeners see the sixth 0 in bit 32, their flag is 33..38.
TEST(Strangers, SlowListenerByHand) {
  const WireBits bits = wire_bits(kFrame);
  for (const bool sender_active : {true, false}) {
    const Clash clash = clash_of_listener(bits, false, sender_active, {500'000, 250'000});
    EXPECT_EQ(clash.end, 40U);
    EXPECT_FALSE(clash.station_waits) << "its flag is the last";
    EXPECT_TRUE(clash.others_wait);
  }
}

// Twice the rate: b sees each bit twice, and 12 to 14 are six times 0; bit 17 is the first behind the arbitration field (ours).
// Its flag is 17..19; the sender's first 1 is bit 20, its flag 21..26; the listeners have 0 in 16..21, their flag is 22..27.
TEST(Strangers, FastListenerByHand) {
  const Clash clash = clash_of_listener(wire_bits(kFrame), false, true, {500'000, 1'000'000});
  EXPECT_EQ(clash.end, 28U);
  EXPECT_TRUE(clash.station_waits);
  EXPECT_FALSE(clash.others_wait) << "theirs is the last";
}

// Half the rate, sending: its bits 12 to 14 are 24..29 of the line. Flag of the listeners 30..35; its bit 15 is a 1 that it
// sees as 0, so its flag begins with its bit 16, and is 32..43.
TEST(Strangers, SlowSenderByHand) {
  const WireBits bits = wire_bits(kFrame);
  const Clash clash = clash_of_sender(bits, true, nullptr, true, {500'000, 250'000});
  EXPECT_EQ(clash.end, 44U);
  EXPECT_TRUE(clash.others_wait);
  EXPECT_FALSE(clash.unheard);
  // Error passive, its flag is not seen.
  EXPECT_EQ(clash_of_sender(bits, false, nullptr, true, {500'000, 250'000}).end, 36U);
  // Nobody can send a flag: it misses the acknowledge.
  EXPECT_TRUE(clash_of_sender(bits, true, nullptr, false, {500'000, 250'000}).unheard);
}

// A slow listener counts 1 a frame, so it destroys frames until their sender is bus-off: 32 times 8. The listener of the line
// counts 9 while it is error active, and 1 after: 15 times 9 are 135.
TEST(Strangers, SlowListenerBringsTheSenderToBusOff) {
  Bench t(250'000);
  EXPECT_EQ(t.watcher.count("b takes no part: its baud rate is not that of the line (250 kbaud, line 500 kbaud)"), 1U);
  t.line.send(Bench::kA, kFrame, 1);
  t.run(20 * kMillisecond);
  EXPECT_EQ(t.a.bus_off, 1);
  EXPECT_EQ(t.watcher.frames, 0U);
  ASSERT_EQ(t.watcher.errors.size(), 32U);
  for (const ErrorRecord& error : t.watcher.errors) {
    EXPECT_EQ(error.end - error.start, (40 + 8) * t.line.bit_time());
    EXPECT_EQ(error.bits, 40U + 8 + 3);
  }
  EXPECT_EQ(t.line.load(t.queue.now()).busy_bits, 32U * 51);
  EXPECT_EQ(t.rec(Bench::kB), 32U);
  EXPECT_EQ(t.rec(Bench::kC), 15U * 9 + 17);
  EXPECT_EQ(t.watcher.count("b destroys the frames of all"), 1U);
  EXPECT_EQ(t.watcher.count("a is error passive"), 1U);
  EXPECT_EQ(t.watcher.count("c is error passive"), 1U);
  EXPECT_EQ(t.watcher.count("a is bus-off"), 1U);
  EXPECT_TRUE(t.b.received.empty() && t.c.received.empty());
}

// A fast one counts 9 a frame, and is error passive after 15; the sender has 120 by then, and gets through.
TEST(Strangers, FastListenerIsSoonPassive) {
  Bench t(1'000'000);
  t.line.send(Bench::kA, kFrame, 1);
  t.run(20 * kMillisecond);
  EXPECT_EQ(t.watcher.errors.size(), 15U);
  EXPECT_EQ(t.watcher.last.substr(t.watcher.last.find(' ')), " sbus 20000088#0000000000000000");
  EXPECT_EQ(t.watcher.frames, 1U);
  EXPECT_EQ(t.a.sent, 1);
  EXPECT_EQ(t.a.failed, 15);
  EXPECT_EQ(t.tec(Bench::kA), 15U * 8 - 1);
  EXPECT_EQ(t.rec(Bench::kB), 15U * 9);
  EXPECT_EQ(t.rec(Bench::kC), 15U - 1);
  EXPECT_EQ(t.watcher.count("b is error passive"), 1U);
  EXPECT_EQ(t.c.received, std::vector<uint32_t>{0x555});
}

// What b sends is noise. The listeners are passive after 15 of its frames, and b misses an acknowledge with 120: 128 for
// ever. It then pauses 8 bits more than the others, so that a frame of theirs goes before it.
TEST(Strangers, SenderAtAnotherRateFillsTheLine) {
  Bench t(250'000);
  EXPECT_EQ(t.line.send(Bench::kB, kFrame, 1), SendStatus::Queued);
  t.run(50 * kMillisecond);
  EXPECT_EQ(t.tec(Bench::kB), 128U);
  EXPECT_EQ(t.watcher.count("a is error passive") + t.watcher.count("c is error passive"), 2U);
  EXPECT_TRUE(t.a.received.empty() && t.c.received.empty());
  EXPECT_GE(t.line.load(t.queue.now()).percent, 95U);
  EXPECT_EQ(t.watcher.count("b destroys the frames of all: it sends, and is not understood"), 1U);
  t.line.send(Bench::kA, kFrame, 1);
  t.run(5 * kMillisecond);
  EXPECT_EQ(t.watcher.frames, 1U);
  EXPECT_EQ(t.a.bus_off + t.b.bus_off, 0);
}

// Interchanged wires: b hears nothing and disturbs nobody until it sends. Its frame reaches nobody, and is repeated for
// ever; what the others send at the same time is extinguished.
TEST(Strangers, InterchangedWires) {
  Bench t(500'000);
  LineFault swap;
  swap.kind = FaultKind::Swap;
  swap.node = Bench::kB;
  swap.until = 40 * kMillisecond;
  t.line.plant(swap);
  t.run(kMillisecond);
  t.line.send(Bench::kA, kFrame, 1);
  t.run(kMillisecond);
  EXPECT_EQ(t.watcher.frames, 1U);
  EXPECT_TRUE(t.watcher.errors.empty());
  t.line.send(Bench::kB, kFrame, 1);
  t.run(8 * kMillisecond);
  EXPECT_EQ(t.tec(Bench::kB), 128U);
  EXPECT_EQ(t.rec(Bench::kA), 0U);
  EXPECT_EQ(t.rec(Bench::kC), 0U);
  EXPECT_TRUE(t.watcher.errors.empty()) << "nobody sees its flag";
  t.line.send(Bench::kC, kFrame, 1);
  t.run(10 * kMillisecond);
  // 16 times 8 more, and b is bus-off with 256; c has 128 by then, and goes on.
  EXPECT_EQ(t.watcher.errors.size(), 16U);
  EXPECT_EQ(t.b.bus_off, 1);
  EXPECT_EQ(t.c.failed, 16);
  EXPECT_EQ(t.tec(Bench::kC), 16U * 8 - 1);
  EXPECT_EQ(t.watcher.frames, 2U);
}

// A planted rate lasts as long as the fault.
TEST(Strangers, PlantedRate) {
  Bench t(500'000);
  LineFault baud;
  baud.kind = FaultKind::Baud;
  baud.node = Bench::kB;
  baud.baud = 1'000'000;
  baud.from = 2 * kMillisecond;
  baud.until = 10 * kMillisecond;
  t.line.plant(baud);
  for (int n = 0; n < 3; ++n) {
    t.line.send(Bench::kA, kFrame, 1);
    t.run(6 * kMillisecond);
  }
  EXPECT_EQ(t.watcher.frames, 3U);
  EXPECT_EQ(t.watcher.errors.size(), 15U);
  EXPECT_EQ(t.b.received.size(), 2U);
  EXPECT_EQ(t.watcher.count("planted fault 'baud': b has another baud rate (1000 kbaud, line 500 kbaud)"), 1U);
}

// Power off ends it, and the right rate, too.
TEST(Strangers, WhoLeavesDisturbsNoMore) {
  Bench t(250'000);
  t.line.set_connected(Bench::kB, false);
  t.line.send(Bench::kA, kFrame, 1);
  t.run(kMillisecond);
  EXPECT_EQ(t.watcher.frames, 1U);
  EXPECT_TRUE(t.watcher.errors.empty());
  t.line.set_baud(Bench::kB, 500'000);
  t.line.set_connected(Bench::kB, true);
  t.line.send(Bench::kA, kFrame, 1);
  t.run(kMillisecond);
  EXPECT_EQ(t.b.received.size(), 1U);
}

}  // namespace
}  // namespace ipos::runtime
