// A CAN line in integer bit times: arbitration, acknowledge, error frames, retransmission and load (ISO
// 11898-1).
//
// Bit n begins at n times the bit time. A frame queued at time t takes part in the arbitration at the first
// bit boundary after t (ours); if the line is busy then, at the end of the intermission. A frame is
// delivered, and its sending confirmed, at the end of the last bit of its end-of-frame field: observers
// first, then the receivers in order of attachment, then the sender.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "runtime/bus/can/error_counters.hpp"
#include "runtime/bus/can/node.hpp"
#include "runtime/bus/can/transfer.hpp"
#include "runtime/bus/line_load.hpp"
#include "runtime/clock/event_queue.hpp"

namespace ipos::runtime {

// P816 (1053 1610 p. 41).
inline constexpr std::array<uint32_t, 4> kBaudRates = {125'000, 250'000, 500'000, 1'000'000};
bool is_baud_rate(uint32_t baud);

inline constexpr size_t kSendQueueLimit = 64;  // waiting frames of one node (ours)

class CanLine final : private EventTarget {
 public:
  // `source` orders the line's events among those of equal time. `baud` must be one of kBaudRates.
  CanLine(EventQueue& queue, uint32_t source, std::string name, uint32_t baud);

  // All nodes are attached before the first event runs. A node of another rate takes no part, and the
  // observers hear why.
  NodeId attach(std::string name, uint32_t baud, CanNode& node);
  void add_observer(CanObserver& observer);

  SendStatus send(NodeId node, const Frame& frame, uint64_t tag);
  void withdraw(NodeId node, uint64_t tag);

  void set_baud(NodeId node, uint32_t baud);
  void set_connected(NodeId node, bool connected);
  void restart(NodeId node);  // leaves bus-off with cleared counters

  const std::string& name() const { return name_; }
  uint32_t baud() const { return baud_; }
  Time bit_time() const { return bit_time_; }
  size_t node_count() const { return nodes_.size(); }
  const std::string& node_name(NodeId node) const { return nodes_[node].name; }
  uint32_t node_baud(NodeId node) const { return nodes_[node].baud; }
  const ErrorCounters& counters(NodeId node) const { return nodes_[node].counters; }
  bool is_active(NodeId node) const;  // right rate, connected, not bus-off
  LineLoad load(Time now) const;

 private:
  struct Pending {
    Frame frame;
    uint64_t tag;
    uint64_t ready_bit;  // takes part in arbitration from here on
    uint32_t key;
    bool on_wire = false;
    bool withdrawn = false;  // while on the wire
  };
  struct Node {
    std::string name;
    uint32_t baud;
    CanNode* node;
    bool connected = true;
    bool unacknowledged = false;  // since its last frame that got through; reported once
    ErrorCounters counters;
    uint64_t suspended_until = 0;  // an error-passive sender pauses 8 bits
    std::vector<Pending> queue;    // by key, equal keys in order of sending
  };

  void on_event(Time now, uint32_t kind, uint64_t argument) override;
  void begin_transfer(uint64_t bit);
  void end_transfer(Time now);
  void settle_sender(Time now, const Transfer::Sender& sender);
  void count_error_state(Time now, NodeId node, ErrorState before);
  void schedule_start();
  const Pending* first_ready(const Node& node, uint64_t bit) const;
  uint64_t next_ready(const Node& node) const;
  void drop_queue(NodeId node);
  void report(const LineEvent& event);
  void report_absence(NodeId node, CanObserver* only);

  EventQueue& queue_;
  uint32_t source_;
  std::string name_;
  uint32_t baud_;
  Time bit_time_;
  std::vector<Node> nodes_;
  std::vector<CanObserver*> observers_;

  bool busy_ = false;
  uint64_t free_bit_ = 0;  // first bit after the last intermission
  EventId start_event_ = kNoEvent;
  uint64_t start_bit_ = 0;  // of start_event_
  Transfer transfer_;

  uint64_t frames_ = 0;
  LoadMeter meter_;
};

// The sending half of an attached node.
class LinePort final : public FrameSender {
 public:
  LinePort(CanLine& line, NodeId node) : line_(&line), node_(node) {}
  SendStatus send(const Frame& frame, uint64_t tag) override { return line_->send(node_, frame, tag); }
  void withdraw(uint64_t tag) override { line_->withdraw(node_, tag); }
  NodeId node() const { return node_; }

 private:
  CanLine* line_;
  NodeId node_;
};

// One line of text for the user, with names, identifier and baud rates.
std::string describe(const CanLine& line, const LineEvent& event);

}  // namespace ipos::runtime
