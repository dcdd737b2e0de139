// The campaign: traffic at an average load of some 70 %, with bursts at one instant.
#include "tests/runtime/bus/campaign/arbitration_campaign.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <random>
#include <vector>

#include "runtime/bus/can/line.hpp"
#include "tests/runtime/bus/wire_model.hpp"

namespace ipos::tests {
namespace {

using namespace ipos::runtime;  // NOLINT

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
        if (arbitration_field(waiting[n][i].frame) < arbitration_field(waiting[n][best].frame)) best = i;
      contenders.push_back({n, best, wire(waiting[n][best].frame)});
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
    good &= r.end == r.start + (r.bits - 3) * line.bit_time();
    sent.push_back({start, r.bits, r.sender, r.frame});
  }
  void on_line_event(const CanLine&, const LineEvent&) override { ++events; }
  std::vector<Sent> sent;
  size_t events = 0;
  bool good = true;
};

// Hands the listed frames to the line when their event comes, and notes for the model when that was.
class Feeder final : public EventTarget {
 public:
  using List = std::vector<std::pair<size_t, Frame>>;  // node, frame
  Feeder(CanLine& line, const List& list, size_t nodes) : orders(nodes), line_(line), list_(list) {}
  void on_event(Time now, uint32_t, uint64_t i) override {
    const auto& [node, frame] = list_[i];
    good &= line_.send(static_cast<NodeId>(node), frame, i) == SendStatus::Queued;
    orders[node].push_back({static_cast<uint64_t>(now / line_.bit_time()) + 1, frame});
  }
  std::vector<std::vector<Order>> orders;
  bool good = true;

 private:
  CanLine& line_;
  const List& list_;
};

constexpr size_t kNodes = 6;

// Mostly single frames, now and then a burst at one instant or within a frame.
Feeder::List schedule_traffic(std::mt19937& random, Time bit_time, uint64_t frames,
                              std::vector<Time>& times) {
  Feeder::List list;
  Time at = 0;
  while (list.size() < frames) {
    const size_t burst = random() % 16 == 0 ? 2 + random() % 20 : 1;
    at += static_cast<Time>(random() % static_cast<uint32_t>(360 * bit_time));
    if (random() % 4 == 0) at -= at % bit_time;  // exactly on a bit boundary
    for (size_t i = 0; i < burst && list.size() < frames; ++i) {
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
      times.push_back(at);
      list.emplace_back(node, frame);
    }
    at += static_cast<Time>(burst > 1 ? burst * 100 : 0) * bit_time;
  }
  return list;
}

// One stretch at one rate; the first difference, or empty.
std::string compare(std::mt19937& random, uint32_t baud, uint64_t frames, ArbitrationTotals& totals) {
  EventQueue queue;
  CanLine line(queue, 3, "sim", baud);
  std::vector<Quiet> nodes(kNodes);
  Sheet sheet;
  line.add_observer(sheet);
  for (size_t n = 0; n < kNodes; ++n) line.attach("node" + std::to_string(n), baud, nodes[n]);
  Quiet listener;
  line.attach("listener", baud, listener);
  std::vector<Time> times;
  const Feeder::List list = schedule_traffic(random, line.bit_time(), frames, times);
  Feeder feeder(line, list, kNodes);
  for (size_t i = 0; i < list.size(); ++i)
    queue.schedule(times[i], random() % 2 == 0 ? 1U : 5U, feeder, 0,
                   i);  // before and after the line's own events
  queue.run_until(times.back() + 10 * kSecond);

  const std::vector<Sent> expected = bit_model(feeder.orders);
  if (!sheet.good || !feeder.good || sheet.events != 0)
    return fmt::format("{} baud: unexpected events", baud);
  if (sheet.sent.size() != list.size() || expected.size() != list.size())
    return fmt::format("{} baud: {} frames of the line, {} of the model, {} sent", baud, sheet.sent.size(),
                       expected.size(), list.size());
  uint64_t busy = 0;
  for (size_t i = 0; i < expected.size(); ++i) {
    if (!(sheet.sent[i] == expected[i]))
      return fmt::format("{} baud: frame {} at bit {} differs", baud, i, expected[i].start_bit);
    busy += expected[i].bits;
    totals.contested += i > 0 && expected[i].start_bit == expected[i - 1].start_bit + expected[i - 1].bits;
  }
  if (line.load(queue.now()).busy_bits != busy) return fmt::format("{} baud: another load", baud);
  totals.frames += expected.size();
  totals.bits += busy;
  return {};
}

}  // namespace

ArbitrationTotals run_arbitration(uint64_t frames, uint32_t seed) {
  constexpr uint64_t kStretch = 25'000;
  std::mt19937 random(seed);
  ArbitrationTotals totals;
  for (size_t n = 0; totals.frames < frames && totals.trouble.empty(); ++n)
    totals.trouble = compare(random, kBaudRates[n % kBaudRates.size()],
                             std::min(kStretch, frames - totals.frames), totals);
  return totals;
}

std::string summary(const ArbitrationTotals& totals) {
  return fmt::format(
      "arbitration: {} frames, {} bits: winners and lengths equal to the bit model; {} frames straight "
      "after another",
      totals.frames, totals.bits, totals.contested);
}

}  // namespace ipos::tests
