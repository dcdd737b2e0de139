// Nodes on the line, and what the line does not tell them: who has lost an arbitration, and what others failed in.
#include "runtime/library/can_nodes.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace ipos::library {
namespace {

constexpr int64_t kSlowest = 10'000, kFastest = 1'000'000;  // bit/s that a CAN line has

}  // namespace

class CanNodes::Node final : public runtime::CanNode {
 public:
  struct Waiting {
    runtime::Frame frame;
    uint64_t tag;
    Time ready;  // takes part in arbitration from then on
  };

  Node(CanNodes& all, std::string name) : all_(all), id_(all.line_.attach(std::move(name), all.line_.baud(), *this)) {
    all.line_.stand_outside(id_);
  }

  NodeId id() const { return id_; }
  bool takes_part() const { return all_.line_.is_active(id_); }

  Refusal send(Time now, const runtime::Frame& frame) {
    switch (all_.line_.send(id_, frame, tags_)) {
      case runtime::SendStatus::Queued: break;
      case runtime::SendStatus::QueueFull: return "too many frames wait to be sent";
      case runtime::SendStatus::NotActive: return "it takes no part: it is bus-off, or has another rate than the line";
      case runtime::SendStatus::InvalidFrame: return "no frame is like that";
    }
    const Time bit = all_.line_.bit_time();
    waiting_.push_back({runtime::canonical(frame), tags_++, (now / bit + 1) * bit});
    return std::nullopt;
  }

  void set_state(runtime::ErrorState told) {
    state = told;
    all_.line_.tell_error_state(id_, told);
  }

  // Another frame has been on the line since `start`.
  void lose(Time start, const runtime::Frame& winner) {
    const auto rank = [start](const Waiting& one) {
      return one.ready <= start ? uint64_t{runtime::arbitration_key(one.frame)} : UINT64_MAX;
    };
    const auto first = std::min_element(waiting_.begin(), waiting_.end(),
                                        [&](const Waiting& one, const Waiting& other) { return rank(one) < rank(other); });
    if (first == waiting_.end() || rank(*first) == UINT64_MAX || rank(*first) == runtime::arbitration_key(winner)) return;
    news.put({NodeNews::Kind::Lost, first->frame});
    const uint64_t tag = first->tag;
    waiting_.erase(first);
    all_.line_.withdraw(id_, tag);
  }

  Kept<NodeNews> news;
  runtime::ErrorState state = runtime::ErrorState::Active;
  bool discards = false;
  uint32_t rate = 0;  // 0: not told

 private:
  void forget(uint64_t tag) {
    std::erase_if(waiting_, [tag](const Waiting& one) { return one.tag == tag; });
  }
  void on_frame(Time, const runtime::Frame& frame) override { news.put({NodeNews::Kind::Received, frame}); }
  void on_sent(Time, const runtime::Frame& frame, uint64_t tag) override {
    forget(tag);
    news.put({NodeNews::Kind::Sent, frame});
    set_state(state);
  }
  void on_not_sent(Time, const runtime::Frame& frame, uint64_t tag, runtime::NotSent why) override {
    forget(tag);
    if (why == runtime::NotSent::Dropped) return;
    all_.line_.withdraw(id_, tag);
    all_.tell_failure(*this, frame, why);
  }

  CanNodes& all_;
  NodeId id_;
  uint64_t tags_ = 0;
  std::vector<Waiting> waiting_;
};

CanNodes::CanNodes(runtime::CanLine& line, size_t count) : line_(line) {
  for (size_t n = 0; n < count; ++n) nodes_.push_back(std::make_unique<Node>(*this, fmt::format("node{}", n + 1)));
  line.add_observer(static_cast<runtime::CanObserver&>(*this));
}

CanNodes::~CanNodes() = default;

Kept<NodeNews>& CanNodes::news(size_t node) { return nodes_[node]->news; }

Refusal CanNodes::send(Time now, size_t node, const runtime::Frame& frame) { return nodes_[node]->send(now, frame); }

Refusal CanNodes::set_rate(size_t node, int64_t baud) {
  if (baud < kSlowest || baud > kFastest) return fmt::format("no CAN line has {} bit/s", baud);
  const auto rate = static_cast<uint32_t>(baud);
  nodes_[node]->rate = rate;
  const bool agree = std::all_of(nodes_.begin(), nodes_.end(), [rate](const auto& each) { return each->rate == 0 || each->rate == rate; });
  if (rate != line_.baud() && agree) line_.set_line_baud(rate);
  if (line_.node_baud(nodes_[node]->id()) != rate) line_.set_baud(nodes_[node]->id(), rate);
  return std::nullopt;
}

void CanNodes::set_state(size_t node, runtime::ErrorState state) { nodes_[node]->set_state(state); }

void CanNodes::set_discards(size_t node, bool discards) { nodes_[node]->discards = discards; }

void CanNodes::on_frame(const runtime::CanLine&, const runtime::FrameRecord& record) {
  for (const auto& node : nodes_)
    if (node->discards && node->id() != record.sender) node->lose(record.start, record.frame);
}

void CanNodes::tell_failure(const Node& sender, const runtime::Frame& frame, runtime::NotSent why) {
  for (const auto& node : nodes_) {
    if (node->takes_part()) node->news.put({NodeNews::Kind::Failed, frame, node.get() == &sender, why});
    node->set_state(node->state);
  }
}

}  // namespace ipos::library
