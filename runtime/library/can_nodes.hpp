// Participants of a CAN line whose controllers are elsewhere: what each of them sends, and what it hears of it. The line tries a
// frame once; who sent it decides whether it comes again. Their error states are those that they tell, not what the line counts.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "runtime/library/bus_tap.hpp"

namespace ipos::library {

struct NodeNews {
  enum class Kind : uint8_t {
    Received,
    Sent,    // the node's own frame, and somebody has it
    Lost,    // the node's own frame: another one was more urgent, and it is given up
    Failed,  // a frame of the line
  };
  Kind kind = Kind::Received;
  runtime::Frame frame{};
  bool own = false;  // of Failed
  runtime::NotSent why = runtime::NotSent::Dropped;
};

class CanNodes final : private runtime::CanObserver {
 public:
  static constexpr size_t kMost = 64;  // ours

  CanNodes(runtime::CanLine& line, size_t count);
  CanNodes(const CanNodes&) = delete;
  CanNodes& operator=(const CanNodes&) = delete;
  ~CanNodes();

  size_t count() const { return nodes_.size(); }
  Refusal send(Time now, size_t node, const runtime::Frame& frame);
  // The line takes the rate that all who have told one agree on, as long as nobody has sent. Who then has another takes no part.
  Refusal set_rate(size_t node, int64_t baud);
  void set_state(size_t node, runtime::ErrorState state);
  void set_discards(size_t node, bool discards);
  Kept<NodeNews>& news(size_t node);
  runtime::CanLine& line() { return line_; }

 private:
  class Node;

  void on_frame(const runtime::CanLine&, const runtime::FrameRecord& record) override;
  void on_line_event(const runtime::CanLine&, const runtime::LineEvent&) override {}
  void tell_failure(const Node& sender, const runtime::Frame& frame, runtime::NotSent why);

  runtime::CanLine& line_;
  std::vector<std::unique_ptr<Node>> nodes_;
};

}  // namespace ipos::library
