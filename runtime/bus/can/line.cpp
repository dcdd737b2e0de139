// The line as a machine of two events: the start bit of the next transfer, and the end of the current one.
#include "runtime/bus/can/line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <utility>

#include "runtime/bus/can/frame_bits.hpp"

namespace ipos::runtime {
namespace {

enum Event : uint32_t { kStart, kEnd };

constexpr uint32_t kSuspendBits = 8;  // pause of an error-passive sender after a transmission

}  // namespace

bool is_baud_rate(uint32_t baud) {
  return std::find(kBaudRates.begin(), kBaudRates.end(), baud) != kBaudRates.end();
}

CanLine::CanLine(EventQueue& queue, uint32_t source, std::string name, uint32_t baud)
    : queue_(queue),
      source_(source),
      name_(std::move(name)),
      baud_(baud),
      bit_time_(kSecond / baud),
      meter_(baud) {
  assert(is_baud_rate(baud));
}

NodeId CanLine::attach(std::string name, uint32_t baud, CanNode& node) {
  const NodeId id = static_cast<NodeId>(nodes_.size());
  nodes_.push_back({std::move(name), baud, &node, true, false, {}, 0, {}});
  nodes_.back().queue.reserve(kSendQueueLimit);
  transfer_.senders.reserve(nodes_.size());
  report_absence(id, nullptr);
  return id;
}

void CanLine::add_observer(CanObserver& observer) {
  observers_.push_back(&observer);
  for (NodeId node = 0; node < nodes_.size(); ++node) report_absence(node, &observer);
}

bool CanLine::is_active(NodeId node) const {
  const Node& n = nodes_[node];
  return n.connected && n.baud == baud_ && n.counters.state() != ErrorState::BusOff;
}

// --- sending

SendStatus CanLine::send(NodeId node, const Frame& frame, uint64_t tag) {
  Node& n = nodes_[node];
  if (!is_valid(frame)) return SendStatus::InvalidFrame;
  if (!is_active(node)) return SendStatus::NotActive;
  if (n.queue.size() >= kSendQueueLimit) return SendStatus::QueueFull;
  const uint64_t ready = static_cast<uint64_t>(queue_.now() / bit_time_) + 1;
  const uint32_t key = arbitration_key(frame);
  const auto place = std::upper_bound(n.queue.begin(), n.queue.end(), key,
                                      [](uint32_t wanted, const Pending& p) { return wanted < p.key; });
  n.queue.insert(place, {canonical(frame), tag, ready, key});
  schedule_start();
  return SendStatus::Queued;
}

void CanLine::withdraw(NodeId node, uint64_t tag) {
  std::vector<Pending>& queue = nodes_[node].queue;
  for (Pending& pending : queue)
    if (pending.tag == tag && pending.on_wire) pending.withdrawn = true;
  std::erase_if(queue, [tag](const Pending& p) { return p.tag == tag && !p.on_wire; });
  schedule_start();
}

const CanLine::Pending* CanLine::first_ready(const Node& node, uint64_t bit) const {
  if (node.suspended_until > bit) return nullptr;
  for (const Pending& pending : node.queue)
    if (pending.ready_bit <= bit) return &pending;
  return nullptr;
}

uint64_t CanLine::next_ready(const Node& node) const {
  uint64_t bit = ~uint64_t{0};
  for (const Pending& pending : node.queue) bit = std::min(bit, pending.ready_bit);
  return node.queue.empty() ? bit : std::max(bit, node.suspended_until);
}

// Keeps the start event at the first bit at which somebody can send.
void CanLine::schedule_start() {
  if (busy_) return;
  uint64_t bit = ~uint64_t{0};
  for (const Node& node : nodes_) bit = std::min(bit, next_ready(node));
  if (bit != ~uint64_t{0}) bit = std::max(bit, free_bit_);
  if (start_event_ != kNoEvent && start_bit_ == bit) return;
  queue_.cancel(std::exchange(start_event_, kNoEvent));
  if (bit == ~uint64_t{0}) return;
  start_bit_ = bit;
  start_event_ = queue_.schedule(static_cast<Time>(bit) * bit_time_, source_, *this, kStart);
}

// --- transfers

void CanLine::on_event(Time now, uint32_t kind, uint64_t) {
  if (kind == kEnd) return end_transfer(now);
  start_event_ = kNoEvent;
  begin_transfer(start_bit_);
}

void CanLine::begin_transfer(uint64_t bit) {
  uint32_t lowest = ~0U;
  for (const Node& node : nodes_)
    if (const Pending* pending = first_ready(node, bit)) lowest = std::min(lowest, pending->key);
  transfer_.start_bit = bit;
  transfer_.senders.clear();
  Listeners listeners;
  for (NodeId id = 0; id < nodes_.size(); ++id) {
    if (!is_active(id)) continue;
    Node& node = nodes_[id];
    const bool error_active = node.counters.state() == ErrorState::Active;
    const Pending* pending = first_ready(node, bit);
    if (pending != nullptr && pending->key == lowest) {
      node.queue[static_cast<size_t>(pending - node.queue.data())].on_wire = true;
      transfer_.senders.push_back({id, pending->frame, pending->tag, error_active});
    } else {
      listeners.any = true;
      listeners.error_active |= error_active;
    }
  }
  if (transfer_.senders.empty()) return schedule_start();
  resolve(transfer_, listeners);
  busy_ = true;
  queue_.schedule(static_cast<Time>(bit + transfer_.end) * bit_time_, source_, *this, kEnd);
}

void CanLine::end_transfer(Time now) {
  busy_ = false;
  free_bit_ = transfer_.start_bit + transfer_.bits;
  meter_.add(transfer_.start_bit, transfer_.bits);
  // Callbacks below may send and withdraw; they change the queues, never transfer_, as the next one has not
  // begun.
  const bool delivered = transfer_.outcome == Transfer::Outcome::Delivered;
  const Transfer::Sender& winner = transfer_.winner();
  if (delivered) {
    ++frames_;
    const FrameRecord record{winner.frame, winner.node, static_cast<Time>(transfer_.start_bit) * bit_time_,
                             now, transfer_.bits};
    for (CanObserver* observer : observers_) observer->on_frame(*this, record);
  }
  for (NodeId id = 0; id < nodes_.size(); ++id) {
    const bool sends = std::any_of(transfer_.senders.begin(), transfer_.senders.end(),
                                   [id](const Transfer::Sender& s) { return s.node == id; });
    if (sends || !is_active(id)) continue;
    const ErrorState before = nodes_[id].counters.state();
    if (delivered) {
      nodes_[id].counters.received();
      nodes_[id].node->on_frame(now, winner.frame);
    } else {
      nodes_[id].counters.receive_failed();
      count_error_state(now, id, before);
    }
  }
  for (const Transfer::Sender& sender : transfer_.senders) settle_sender(now, sender);
  schedule_start();
}

void CanLine::settle_sender(Time now, const Transfer::Sender& sender) {
  Node& node = nodes_[sender.node];
  const auto pending =
      std::find_if(node.queue.begin(), node.queue.end(), [](const Pending& p) { return p.on_wire; });
  if (pending == node.queue.end()) return;  // cut off meanwhile: dropped and told
  const bool sent = transfer_.outcome == Transfer::Outcome::Delivered && !sender.lost;
  if (sent || pending->withdrawn)
    node.queue.erase(pending);
  else
    pending->on_wire = false;
  NodeId partner = kNoNode;
  for (const Transfer::Sender& other : transfer_.senders)
    if (other.node != sender.node) partner = other.node;
  const ErrorState before = node.counters.state();
  if (sent) {
    node.counters.sent();
    node.unacknowledged = false;
    if (partner != kNoNode && sender.node == transfer_.winner().node)
      report({LineEventKind::SameFrame, now, sender.node, partner, sender.frame.id});
  } else if (transfer_.outcome == Transfer::Outcome::NoAcknowledge && !sender.lost) {
    node.counters.not_acknowledged();
    if (!std::exchange(node.unacknowledged, true))
      report({LineEventKind::NoAcknowledge, now, sender.node, kNoNode, sender.frame.id});
  } else {
    node.counters.send_failed();
    report({LineEventKind::Collision, now, sender.node, partner, sender.frame.id});
  }
  if (node.counters.state() == ErrorState::Passive) node.suspended_until = free_bit_ + kSuspendBits;
  if (sent)
    node.node->on_sent(now, sender.frame, sender.tag);
  else
    node.node->on_not_sent(now, sender.frame, sender.tag,
                           transfer_.outcome == Transfer::Outcome::NoAcknowledge && !sender.lost
                               ? NotSent::NoAcknowledge
                               : NotSent::Collision);
  count_error_state(now, sender.node, before);
}

void CanLine::count_error_state(Time now, NodeId node, ErrorState before) {
  const ErrorState after = nodes_[node].counters.state();
  if (after == before) return;
  if (after == ErrorState::Passive) report({LineEventKind::ErrorPassive, now, node});
  if (after != ErrorState::BusOff) return;
  report({LineEventKind::BusOff, now, node});
  drop_queue(node);
}

// --- participation

void CanLine::set_baud(NodeId node, uint32_t baud) {
  nodes_[node].baud = baud;
  if (!is_active(node)) drop_queue(node);
  report_absence(node, nullptr);
}

void CanLine::set_connected(NodeId node, bool connected) {
  nodes_[node].connected = connected;
  if (!connected) drop_queue(node);
  report_absence(node, nullptr);
}

void CanLine::restart(NodeId node) { nodes_[node].counters = {}; }

// A frame on the wire at this moment is still carried to its end (ours).
void CanLine::drop_queue(NodeId node) {
  const std::vector<Pending> dropped = std::exchange(nodes_[node].queue, {});
  nodes_[node].queue.reserve(kSendQueueLimit);
  schedule_start();
  for (const Pending& pending : dropped)
    nodes_[node].node->on_not_sent(queue_.now(), pending.frame, pending.tag, NotSent::Dropped);
}

void CanLine::report(const LineEvent& event) {
  for (CanObserver* observer : observers_) observer->on_line_event(*this, event);
}

void CanLine::report_absence(NodeId node, CanObserver* only) {
  const Node& n = nodes_[node];
  if (n.connected && n.baud == baud_) return;
  const LineEvent event{n.connected ? LineEventKind::WrongBaudRate : LineEventKind::NotConnected,
                        queue_.now(), node};
  if (only != nullptr)
    only->on_line_event(*this, event);
  else
    report(event);
}

// --- load

LineLoad CanLine::load(Time now) const {
  LineLoad load = meter_.load(static_cast<uint64_t>(now / bit_time_));
  load.frames = frames_;
  return load;
}

std::string describe(const CanLine& line, const LineEvent& event) {
  static constexpr std::string_view kTexts[] = {
#define LINE_EVENT(name, text) text,
#include "runtime/bus/can/line_events.def"
  };
  std::string text = fmt::format("{}: {} {}", line.name(), line.node_name(event.node),
                                 kTexts[static_cast<size_t>(event.kind)]);
  switch (event.kind) {
    case LineEventKind::WrongBaudRate:
      text +=
          fmt::format(" ({} kbaud, line {} kbaud)", line.node_baud(event.node) / 1000, line.baud() / 1000);
      break;
    case LineEventKind::NoAcknowledge: text += fmt::format(" (identifier {})", event.id); break;
    case LineEventKind::Collision:
    case LineEventKind::SameFrame:
      text += fmt::format(" (identifier {}, other station {})", event.id,
                          event.other == kNoNode ? "unknown" : line.node_name(event.other));
      break;
    default: break;
  }
  return text;
}

}  // namespace ipos::runtime
