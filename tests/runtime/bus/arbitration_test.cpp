// The line's arbitration and error frames against models that know only single bits: what each node sends,
// the wired AND of all, and what each node then sees.
#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <random>

#include "runtime/bus/can/line.hpp"
#include "tests/runtime/bus/wire_model.hpp"

namespace ipos::runtime {
namespace {

struct Order {  // a frame to be sent
  uint64_t ready_bit;
  Frame frame;
};

struct Sent {
  uint64_t start_bit;
  size_t bits;  // with intermission
  size_t node;
  Frame frame;
  friend bool operator==(const Sent&, const Sent&) = default;
};

// Goes through time bit by bit. orders[n]: of node n, by ready_bit.
std::vector<Sent> bit_model(std::vector<std::vector<Order>> orders) {
  struct Contender {
    size_t node;
    size_t order;
    std::string bits;
    bool sending = true;
  };
  std::vector<Sent> sent;
  std::vector<std::vector<Order>> waiting(orders.size());
  std::vector<size_t> next(orders.size(), 0);
  uint64_t bit = 0;
  for (;;) {
    std::vector<Contender> contenders;
    bool more = false;
    uint64_t wake = ~uint64_t{0};
    for (size_t n = 0; n < orders.size(); ++n) {
      while (next[n] < orders[n].size() && orders[n][next[n]].ready_bit <= bit)
        waiting[n].push_back(orders[n][next[n]++]);
      if (next[n] < orders[n].size()) {
        more = true;
        wake = std::min(wake, orders[n][next[n]].ready_bit);
      }
      if (waiting[n].empty()) continue;
      size_t best = 0;
      for (size_t i = 1; i < waiting[n].size(); ++i)
        if (tests::arbitration_field(waiting[n][i].frame) < tests::arbitration_field(waiting[n][best].frame))
          best = i;
      contenders.push_back({n, best, tests::wire(waiting[n][best].frame)});
    }
    if (contenders.empty()) {
      if (!more) return sent;
      bit = wake;  // nothing but recessive bits until then
      continue;
    }
    size_t last = 0;  // bits on the wire
    for (size_t i = 0;; ++i) {
      char bus = '1';
      bool anyone = false;
      for (const Contender& c : contenders)
        if (c.sending && i < c.bits.size()) {
          anyone = true;
          if (c.bits[i] == '0') bus = '0';
        }
      if (!anyone) break;
      for (Contender& c : contenders)
        if (c.sending && i < c.bits.size() && c.bits[i] != bus)
          c.sending = false;  // lost: recessive overwritten
      last = i + 1;
    }
    for (const Contender& c : contenders)
      if (c.sending) {
        sent.push_back({bit, last + 3, c.node, waiting[c.node][c.order].frame});
        waiting[c.node].erase(waiting[c.node].begin() + static_cast<std::ptrdiff_t>(c.order));
      }
    bit += last + 3;
  }
}

class Quiet final : public CanNode {
 public:
  void on_frame(Time, const Frame&) override {}
  void on_sent(Time, const Frame&, uint64_t) override { ++sent; }
  void on_not_sent(Time, const Frame&, uint64_t, NotSent) override { ++failed; }
  size_t sent = 0;
  size_t failed = 0;
};

class Sheet final : public CanObserver {
 public:
  void on_frame(const CanLine& line, const FrameRecord& r) override {
    const uint64_t start = static_cast<uint64_t>(r.start / line.bit_time());
    EXPECT_EQ(r.end, r.start + (r.bits - 3) * line.bit_time());
    sent.push_back({start, r.bits, r.sender, r.frame});
  }
  void on_line_event(const CanLine&, const LineEvent&) override { ++events; }
  std::vector<Sent> sent;
  size_t events = 0;
};

// Hands the listed frames to the line when their event comes, and notes for the model when that was.
class Feeder final : public EventTarget {
 public:
  using List = std::vector<std::pair<size_t, Frame>>;  // node, frame
  Feeder(CanLine& line, const List& list, size_t nodes) : orders(nodes), line_(line), list_(list) {}
  void on_event(Time now, uint32_t, uint64_t i) override {
    const auto& [node, frame] = list_[i];
    EXPECT_EQ(line_.send(static_cast<NodeId>(node), frame, i), SendStatus::Queued);
    orders[node].push_back({static_cast<uint64_t>(now / line_.bit_time()) + 1, frame});
  }
  std::vector<std::vector<Order>> orders;

 private:
  CanLine& line_;
  const List& list_;
};

TEST(Arbitration, AgreesWithTheBitModel) {
  constexpr size_t kNodes = 6;
  constexpr size_t kFrames = 100'000;
  std::mt19937 random(4);
  size_t compared = 0;
  size_t contested = 0;
  for (const uint32_t baud : kBaudRates) {
    EventQueue queue;
    CanLine line(queue, 3, "sim", baud);
    std::vector<Quiet> nodes(kNodes);
    Sheet sheet;
    line.add_observer(sheet);
    for (size_t n = 0; n < kNodes; ++n) line.attach("node" + std::to_string(n), baud, nodes[n]);
    Quiet listener;
    line.attach("listener", baud, listener);

    const Time bit_time = 1'000'000'000 / static_cast<Time>(baud);
    Feeder::List list;
    Feeder feeder(line, list, kNodes);
    Time at = 0;
    while (list.size() < kFrames / kBaudRates.size()) {
      // Mostly single frames at an average load of some 70 %, now and then a burst at one instant or within a
      // frame.
      const size_t burst = random() % 16 == 0 ? 2 + random() % 20 : 1;
      at += static_cast<Time>(random() % static_cast<uint32_t>(360 * bit_time));
      if (random() % 4 == 0) at -= at % bit_time;  // exactly on a bit boundary
      for (size_t i = 0; i < burst && list.size() < kFrames / kBaudRates.size(); ++i) {
        if (random() % 3 == 0) at += static_cast<Time>(random() % static_cast<uint32_t>(40 * bit_time));
        const size_t node = random() % kNodes;
        Frame frame;
        frame.extended = random() % 8 == 0;
        frame.remote = random() % 16 == 0;
        frame.length = static_cast<uint8_t>(random() % 9);
        const uint32_t low = static_cast<uint32_t>(random() % 8 * kNodes + node);  // one sender an identifier
        frame.id = frame.extended ? static_cast<uint32_t>(random() % 48) << 18 | low : low;
        for (size_t b = 0; b < frame.length && !frame.remote; ++b)
          frame.data[b] = static_cast<uint8_t>(random());
        const uint32_t source = random() % 2 == 0 ? 1U : 5U;  // before and after the line's own events
        queue.schedule(at, source, feeder, 0, list.size());
        list.emplace_back(node, frame);
      }
      at += static_cast<Time>(burst > 1 ? burst * 100 : 0) * bit_time;
    }
    queue.run_until(at + 10 * kSecond);
    const std::vector<Sent> expected = bit_model(feeder.orders);
    ASSERT_EQ(sheet.sent.size(), list.size());
    ASSERT_EQ(expected.size(), list.size());
    uint64_t busy = 0;
    for (size_t i = 0; i < expected.size(); ++i) {
      ASSERT_EQ(sheet.sent[i], expected[i]) << "frame " << i << " at bit " << expected[i].start_bit;
      busy += expected[i].bits;
      contested += i > 0 && expected[i].start_bit == expected[i - 1].start_bit + expected[i - 1].bits;
    }
    EXPECT_EQ(line.load(queue.now()).busy_bits, busy);
    EXPECT_EQ(line.load(queue.now()).frames, list.size());
    EXPECT_EQ(sheet.events, 0U);
    compared += expected.size();
  }
  std::cout << "arbitration: " << compared << " frames equal to the bit model, " << contested
            << " of them straight after another\n";
  EXPECT_EQ(compared, kFrames);
  EXPECT_GT(contested, kFrames / 10);
}

// Two error-active senders with one identifier and different content, and one listener, bit by bit. Returns
// the bit behind the error delimiter.
size_t collision_model(const std::string& a, const std::string& b, bool listener) {
  struct Station {
    std::string bits;  // what it sends by itself
    bool sender;
    size_t flag_from = ~size_t{0};
  };
  std::vector<Station> stations = {{a, true}, {b, true}};
  if (listener) stations.push_back({"", false});
  std::string bus;
  for (size_t i = 0; i < 400; ++i) {
    char level = '1';
    for (const Station& s : stations) {
      const bool flag = i >= s.flag_from && i < s.flag_from + 6;
      const bool frame = s.flag_from == ~size_t{0} && i < s.bits.size();
      if (flag || (frame && s.bits[i] == '0')) level = '0';
    }
    bus += level;
    for (Station& s : stations) {
      if (s.flag_from != ~size_t{0}) continue;
      if (s.sender) {
        if (i < s.bits.size() && s.bits[i] != level) s.flag_from = i + 1;
        continue;
      }
      // The listener follows the bus: six equal bits are a stuff error, a dominant bit where the frame it
      // decodes has its CRC delimiter is a form error.
      if (bus.size() >= 6 && bus.substr(bus.size() - 6) == std::string(6, level)) {
        s.flag_from = i + 1;
        continue;
      }
      const std::string& winner = a.substr(0, bus.size() - 1) == bus.substr(0, bus.size() - 1) ? a : b;
      if (i == winner.size() - 10 && level == '0') s.flag_from = i + 1;
    }
  }
  return bus.find_last_of('0') + 1 + 8;
}

TEST(Arbitration, CollisionLastsAsLongAsInTheBitModel) {
  std::mt19937 random(5);
  for (int i = 0; i < 3000; ++i) {
    Frame a;
    a.id = static_cast<uint32_t>(random() % kStandardIdLimit);
    a.length = static_cast<uint8_t>(random() % 9);
    for (size_t n = 0; n < a.length; ++n) a.data[n] = random() % 2 == 0 ? 0 : static_cast<uint8_t>(random());
    Frame b = a;
    if (a.length == 0 || random() % 4 == 0) {
      b.length = static_cast<uint8_t>((a.length + 1 + random() % 8) % 9);
      b = canonical(b);
    } else {
      b.data[random() % a.length] ^= static_cast<uint8_t>(1U << random() % 8);
    }
    const bool listener = i % 2 == 0;
    Transfer transfer;
    transfer.senders = {{0, a, 0, true, false}, {1, b, 0, true, false}};
    resolve(transfer, {listener, listener});
    ASSERT_EQ(transfer.outcome, Transfer::Outcome::Collision);
    ASSERT_EQ(transfer.end, collision_model(tests::wire(a), tests::wire(b), listener))
        << tests::wire(a) << '\n'
        << tests::wire(b);
    ASSERT_EQ(transfer.bits, transfer.end + 3);
  }
}

}  // namespace
}  // namespace ipos::runtime
