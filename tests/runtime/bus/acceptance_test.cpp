// Acceptance filters: a line whose nodes are told only of the identifiers they listen to, against the same
// line whose nodes hear everything. Random frames from more nodes than a word has bits, with faults of the
// line.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <tuple>
#include <vector>

#include "runtime/bus/can/line.hpp"

namespace ipos::runtime {
namespace {

constexpr uint32_t kNodes = 70;
constexpr uint32_t kIdentifiers = 100;

using Heard = std::tuple<Time, uint32_t, std::array<uint8_t, 8>>;

class Station final : public CanNode {
 public:
  void on_frame(Time now, const Frame& frame) override {
    if (frame.extended || takes[frame.id]) heard.emplace_back(now, frame.id, frame.data);
    ++told;
  }
  void on_sent(Time now, const Frame& frame, uint64_t) override {
    sent.emplace_back(now, frame.id, frame.data);
  }
  void on_not_sent(Time now, const Frame& frame, uint64_t, NotSent) override {
    lost.emplace_back(now, frame.id, frame.data);
  }
  void on_bus_off(Time) override { line->recover(node); }

  CanLine* line = nullptr;
  NodeId node = 0;
  std::vector<bool> takes = std::vector<bool>(kIdentifiers);
  std::vector<Heard> heard, sent, lost;
  uint64_t told = 0;
};

class Watcher final : public CanObserver {
 public:
  void on_frame(const CanLine&, const FrameRecord& record) override {
    frames.emplace_back(record.end, record.bits, record.frame.data);
  }
  void on_line_event(const CanLine& line, const LineEvent& event) override {
    events.push_back(describe(line, event));
  }
  std::vector<Heard> frames;
  std::vector<std::string> events;
};

struct Wired {
  explicit Wired(bool filter) {
    line.add_observer(watcher);
    for (uint32_t n = 0; n < kNodes; ++n) {
      stations.push_back(std::make_unique<Station>());
      Station& station = *stations.back();
      station.line = &line;
      station.node = line.attach("unit", 1'000'000, station);
      if (filter) line.close_filter(station.node);
    }
  }
  void listen(uint32_t node, uint32_t id) {
    stations[node]->takes[id] = true;
    line.listen(node, id);
  }

  EventQueue queue;
  CanLine line{queue, 1, "sbus", 1'000'000};
  Watcher watcher;
  std::vector<std::unique_ptr<Station>> stations;
};

void compare(const Wired& all, const Wired& filtered) {
  EXPECT_EQ(all.watcher.frames, filtered.watcher.frames);
  EXPECT_EQ(all.watcher.events, filtered.watcher.events);
  for (uint32_t n = 0; n < kNodes; ++n) {
    EXPECT_EQ(all.stations[n]->heard, filtered.stations[n]->heard) << "node " << n;
    EXPECT_EQ(all.stations[n]->sent, filtered.stations[n]->sent) << "node " << n;
    EXPECT_EQ(all.stations[n]->lost, filtered.stations[n]->lost) << "node " << n;
    EXPECT_EQ(all.line.counters(n).receive, filtered.line.counters(n).receive) << "node " << n;
    EXPECT_EQ(all.line.counters(n).transmit, filtered.line.counters(n).transmit) << "node " << n;
  }
}

class AcceptanceFilters : public ::testing::TestWithParam<uint32_t> {};

TEST_P(AcceptanceFilters, NobodyMissesAFrameAndNothingElseChanges) {
  std::mt19937 random(GetParam());
  const auto below = [&](uint32_t limit) { return static_cast<uint32_t>(random()) % limit; };
  Wired all(false), filtered(true);
  const auto both = [&](auto act) {
    act(all);
    act(filtered);
  };
  for (const FaultKind kind : {FaultKind::Corrupt, FaultKind::Duplicate, FaultKind::Drop, FaultKind::Delay,
                               FaultKind::Cut, FaultKind::Swap, FaultKind::Short, FaultKind::Stuck}) {
    LineFault fault;
    fault.kind = kind;
    fault.from = below(200) * kMillisecond;
    fault.until = fault.from + (1 + below(20)) * kMillisecond;
    fault.per_mille = 100;
    fault.seed = below(1000);
    fault.lag = 700 * kMicrosecond;
    fault.behind = kind == FaultKind::Cut && below(2) == 0;
    const bool of_line = kind == FaultKind::Short || kind == FaultKind::Stuck;
    if (!of_line && (kind == FaultKind::Cut || kind == FaultKind::Swap || below(2) == 0))
      fault.node = below(kNodes);
    both([&](Wired& w) { w.line.plant(fault); });
  }
  for (Time now = 0; now < 250 * kMillisecond; now += kMillisecond) {
    for (uint32_t n = below(12); n > 0; --n) {
      const uint32_t node = below(kNodes);
      if (below(4) == 0) {
        const uint32_t id = below(kIdentifiers);
        both([&](Wired& w) { w.listen(node, id); });
        continue;
      }
      if (below(10) == 0) {
        const uint64_t tag = below(5);
        both([&](Wired& w) { w.line.withdraw(node, tag); });
        continue;
      }
      Frame frame;
      frame.extended = below(20) == 0;
      frame.remote = below(20) == 0;
      frame.id = below(kIdentifiers);
      frame.length = static_cast<uint8_t>(below(9));
      for (uint8_t& byte : frame.data) byte = static_cast<uint8_t>(below(256));
      const uint64_t tag = below(5);
      both([&](Wired& w) { w.line.send(node, frame, tag); });
    }
    both([&](Wired& w) { w.queue.run_until(now + kMillisecond); });
  }
  compare(all, filtered);
  uint64_t told = 0, told_filtered = 0, heard = 0;
  for (uint32_t n = 0; n < kNodes; ++n) {
    told += all.stations[n]->told;
    told_filtered += filtered.stations[n]->told;
    heard += filtered.stations[n]->heard.size();
  }
  EXPECT_GT(all.watcher.frames.size(), 500U);
  EXPECT_GT(heard, 1000U);
  EXPECT_LT(told_filtered, told);
}

INSTANTIATE_TEST_SUITE_P(Seeds, AcceptanceFilters, ::testing::Range(1U, 21U));

// A node that keeps the last frame of each identifier, and may say that it need not hear it again.
class Keeper final : public CanNode {
 public:
  explicit Keeper(bool rests) : rests_(rests) {}
  void on_frame(Time, const Frame& frame) override {
    ++told;
    auto& known = last[frame.id];
    if (known == frame) {
      if (rests_) line->rest(node, frame);
      return;
    }
    known = frame;
    news.push_back(frame);
  }
  void on_sent(Time, const Frame&, uint64_t) override {}
  void on_not_sent(Time, const Frame&, uint64_t, NotSent) override {}
  void forget(uint32_t id) {
    last.erase(id);
    line->want_again(node, id);
  }

  CanLine* line = nullptr;
  NodeId node = 0;
  uint64_t told = 0;
  std::map<uint32_t, std::optional<Frame>> last;
  std::vector<Frame> news;

 private:
  bool rests_;
};

struct Keepers {
  explicit Keepers(bool rest) {
    for (uint32_t n = 0; n < kNodes; ++n) {
      nodes.push_back(std::make_unique<Keeper>(rest));
      nodes.back()->line = &line;
      nodes.back()->node = line.attach("unit", 1'000'000, *nodes.back());
    }
  }
  EventQueue queue;
  CanLine line{queue, 1, "sbus", 1'000'000};
  std::vector<std::unique_ptr<Keeper>> nodes;
};

TEST(RestingNodes, MissNothingThatIsNew) {
  uint64_t told = 0, told_some = 0;
  for (uint32_t seed = 1; seed <= 20; ++seed) {
    std::mt19937 random(seed);
    const auto below = [&](uint32_t limit) { return static_cast<uint32_t>(random()) % limit; };
    Keepers all(false), some(true);
    for (Time now = 0; now < 200 * kMillisecond; now += kMillisecond) {
      if (seed % 4 == 0 && now == 100 * kMillisecond) {
        LineFault fault;
        fault.kind = FaultKind::Corrupt;
        fault.per_mille = 200;
        fault.from = now;
        all.line.plant(fault);
        some.line.plant(fault);
      }
      for (uint32_t n = below(9); n > 0; --n) {
        Frame frame;
        frame.id = 500 + 64 * below(8);  // some share their place
        frame.remote = below(20) == 0;
        frame.length = static_cast<uint8_t>(below(10) == 0 ? 2 : 1);
        frame.data[0] = static_cast<uint8_t>(below(12) / 10);
        const uint32_t node = below(kNodes);
        const bool forgets = below(4) == 0;
        for (Keepers* line : {&all, &some}) {
          line->line.send(node, frame, 0);
          if (forgets) line->nodes[(node + 1) % kNodes]->forget(frame.id);
        }
      }
      all.queue.run_until(now + kMillisecond);
      some.queue.run_until(now + kMillisecond);
    }
    for (uint32_t n = 0; n < kNodes; ++n) {
      EXPECT_EQ(all.nodes[n]->news, some.nodes[n]->news) << "seed " << seed << " node " << n;
      told += all.nodes[n]->told;
      told_some += some.nodes[n]->told;
    }
  }
  EXPECT_LT(told_some, told);
}

TEST(Contending, TheFirstIsTheLowestKey) {
  std::mt19937 random(1);
  Contenders contenders;
  contenders.grow(kNodes);
  struct Contender {
    uint64_t ready;
    uint32_t key;
  };
  std::map<NodeId, Contender> model;
  for (int n = 0; n < 20'000; ++n) {
    const NodeId node = static_cast<NodeId>(random() % kNodes);
    if (random() % 3 == 0) {
      contenders.remove(node);
      model.erase(node);
    } else {
      const Contender& put = model[node] = {random() % 1000, static_cast<uint32_t>(random() % 60)};
      contenders.put(node, put.ready, put.key);
    }
    ASSERT_EQ(contenders.empty(), model.empty());
    if (model.empty()) continue;
    uint32_t lowest = ~0U;
    for (const auto& [id, contender] : model) lowest = std::min(lowest, contender.key);
    std::vector<NodeId> expected, first, everybody;
    for (const auto& [id, contender] : model)
      if (contender.key == lowest) expected.push_back(id);
    contenders.each_first([&](NodeId id) { first.push_back(id); });
    ASSERT_EQ(first, expected);
    ASSERT_EQ(contenders.only_first(), expected.size() == 1 ? expected[0] : kNoNode);
    contenders.each([&](NodeId id) {
      everybody.push_back(id);
      EXPECT_TRUE(model.contains(id));
      EXPECT_TRUE(!contenders.all_ready(500) || model[id].ready <= 500);
    });
    ASSERT_EQ(everybody.size(), model.size());
  }
  EXPECT_TRUE(contenders.all_ready(1000));
}

}  // namespace
}  // namespace ipos::runtime
