// The line as a machine of two events: the start bit of the next transfer, and the end of the current one.
#include "runtime/bus/can/line.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "runtime/bus/can/line_event_kinds.hpp"

namespace ipos::runtime {
namespace {

constexpr uint32_t kSuspendBits = 8;     // pause of an error-passive sender after a transmission
constexpr uint32_t kRecessiveTail = 11;  // every transfer ends with delimiter bits and intermission
constexpr uint64_t kNoBit = ~uint64_t{0};

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
  Node added{};
  added.name = std::move(name);
  added.baud = baud;
  added.node = &node;
  wire(added);
  nodes_.push_back(std::move(added));
  nodes_.back().queue.reserve(kSendQueueLimit);
  contenders_.grow(nodes_.size());
  winners_.reserve(nodes_.size());
  filter_.grow(nodes_.size());
  erring_.grow(nodes_.size());
  report_absence(id, nullptr);
  return id;
}

bool CanLine::is_reachable(NodeId from, NodeId to) const {
  return is_active(from) && is_active(to) && nodes_[from].segment == nodes_[to].segment;
}

// --- sending

SendStatus CanLine::send(NodeId node, const Frame& frame, uint64_t tag) {
  Node& n = nodes_[node];
  if (!is_valid(frame)) return SendStatus::InvalidFrame;
  if (!is_active(n)) return SendStatus::NotActive;
  if (n.queue.size() >= kSendQueueLimit) return SendStatus::QueueFull;
  const uint64_t ready = static_cast<uint64_t>(queue_.now() / bit_time_) + 1;
  const uint32_t key = arbitration_key(frame);
  if (n.queue.empty()) {
    n.queue.emplace_back().set(frame, tag, ready, key);
    const uint64_t can_send = std::max(ready, n.suspended_until);
    contenders_.put(node, can_send, can_send, key);
  } else {
    const auto behind = std::upper_bound(n.queue.begin(), n.queue.end(), key,
                                         [](uint32_t wanted, const Pending& p) { return wanted < p.key; });
    n.queue.emplace(behind)->set(frame, tag, ready, key);
    queue_changed(node);
  }
  const Segment& segment = segments_[n.segment];
  const bool in_time = segment.start_event != kNoEvent &&
                       segment.start_bit <= std::max(contenders_[node].ready, segment.free_bit);
  if (!segment.busy && !in_time) schedule_start(n.segment);
  return SendStatus::Queued;
}

void CanLine::withdraw(NodeId node, uint64_t tag) {
  std::vector<Pending>& queue = nodes_[node].queue;
  const Segment& segment = segments_[nodes_[node].segment];
  const bool settled = segment.busy || segment.start_event != kNoEvent;
  if (queue.empty() && settled) return;
  for (Pending& pending : queue)
    if (pending.tag == tag && pending.on_wire) pending.withdrawn = true;
  const bool changed =
      std::erase_if(queue, [tag](const Pending& p) { return p.tag == tag && !p.on_wire; }) != 0;
  if (!changed && settled) return;
  queue_changed(node);
  schedule_start(nodes_[node].segment);
}

const CanLine::Pending* CanLine::first_ready(const Node& node, uint64_t bit) {
  if (node.suspended_until > bit) return nullptr;
  for (const Pending& pending : node.queue)
    if (pending.ready_bit <= bit) return &pending;
  return nullptr;
}

uint64_t CanLine::next_ready(const Node& node) const {
  uint64_t bit = kNoBit;
  for (const Pending& pending : node.queue) bit = std::min(bit, pending.ready_bit);
  return node.queue.empty() ? bit : std::max(bit, node.suspended_until);
}

// Queue or pause of the node are other ones.
void CanLine::queue_changed(NodeId id) {
  const Node& node = nodes_[id];
  if (node.queue.empty()) return contenders_.remove(id);
  const Pending& first = node.queue.front();
  contenders_.put(id, next_ready(node), std::max(first.ready_bit, node.suspended_until), first.key);
}

void CanLine::schedule_start() {
  for (uint32_t segment = 0; segment < segments_.size(); ++segment) schedule_start(segment);
}

// The first bit at which somebody can send; kNoBit: nobody.
uint64_t CanLine::next_start(uint32_t number) const {
  if (stuck_ != 0 || rewire_ || contenders_.empty()) return kNoBit;
  const uint64_t free_bit = segments_[number].free_bit;
  if (segments_.size() == 1 && contenders_.all_ready(free_bit)) return free_bit;
  uint64_t bit = kNoBit;
  contenders_.each([&](NodeId id) {
    if (nodes_[id].segment == number) bit = std::min(bit, contenders_[id].ready);
  });
  return bit == kNoBit ? bit : std::max(bit, free_bit);
}

// Keeps the start event at that bit.
void CanLine::schedule_start(uint32_t number) {
  Segment& segment = segments_[number];
  if (segment.busy) return;
  const uint64_t bit = next_start(number);
  if (segment.start_event != kNoEvent && segment.start_bit == bit) return;
  queue_.cancel(std::exchange(segment.start_event, kNoEvent));
  if (bit == kNoBit) return;
  segment.start_bit = bit;
  segment.start_event =
      queue_.schedule(static_cast<Time>(bit) * bit_time_, source_, *this, line_event::kStart, number);
}

// --- transfers

void CanLine::on_event(Time now, uint32_t kind, uint64_t argument) {
  switch (kind) {
    case line_event::kStart: return begin_and_end(static_cast<uint32_t>(argument), true);
    case line_event::kEnd: return begin_and_end(static_cast<uint32_t>(argument), false);
    case line_event::kFaultBegins: return switch_fault(now, argument, true);
    case line_event::kFaultEnds: return switch_fault(now, argument, false);
    case line_event::kLate: return deliver_late(now, argument);
    default: return finish_recovery(now, static_cast<NodeId>(argument));
  }
}

// What nearly all transfers are: one node has the lowest key, no fault is planted, and no error counter makes
// a difference. False: all that is to be looked at.
inline bool CanLine::begin_plain(uint64_t bit) {
  if (segments_.size() != 1 || !faults_.empty() || !contenders_.all_ready(bit) || contenders_.empty())
    return false;
  const NodeId id = contenders_.only_first();
  if (id == kNoNode) return false;
  Node& node = nodes_[id];
  Pending& pending = node.queue.front();
  if (!is_active(node) || !node.counters.untouched() || pending.frame.extended || !is_acknowledged(id))
    return false;
  if (recovering_) pause_recovery(0, bit);
  pending.on_wire = true;
  Segment& segment = segments_[0];
  segment.busy = true;
  Transfer& transfer = segment.transfer;
  if (transfer.senders.size() != 1) transfer.senders.resize(1);
  Transfer::Sender& sender = transfer.senders.front();
  sender.node = id;
  sender.frame = pending.frame;
  sender.tag = pending.tag;
  sender.error_active = true;
  sender.lost = false;
  transfer.outcome = Transfer::Outcome::Delivered;
  transfer.plain = true;
  transfer.start_bit = bit;
  transfer.bits = known_.bits(pending.frame);
  transfer.end = transfer.bits - kIntermissionBits;
  return true;
}

bool CanLine::is_acknowledged(NodeId sender) {
  if (acknowledges_ != sender && is_active(nodes_[acknowledges_])) return true;
  for (NodeId id = 0; id < nodes_.size(); ++id) {
    if (id == sender || !is_active(nodes_[id])) continue;
    acknowledges_ = id;
    return true;
  }
  return false;
}

inline void CanLine::release(Segment& segment) {
  const Transfer& transfer = segment.transfer;
  segment.busy = false;
  segment.free_bit = transfer.start_bit + transfer.bits;
  segment.recessive_from = segment.free_bit - kRecessiveTail;
  meter_.add(transfer.start_bit, transfer.bits);
}

inline void CanLine::report_frame(Time now, const Transfer& transfer, const Transfer::Sender& winner) {
  ++frames_;
  const FrameRecord record{winner.frame, winner.node, static_cast<Time>(transfer.start_bit) * bit_time_, now,
                           transfer.bits};
  for (CanObserver* observer : observers_) observer->on_frame(*this, record);
}

// What waited for the end of the transfer.
inline void CanLine::settle_line() {
  if (recovering_) {
    recovering_ = false;
    for (NodeId id = 0; id < nodes_.size(); ++id) {
      schedule_recovery(id);
      recovering_ |= nodes_[id].recovery_runs != 0;
    }
  }
  if (rewire_) rebuild_segments();
}

// To listeners without a receive error that do not want it, a good frame is nothing at all. Of the first word
// of them some may rest.
void CanLine::deliver_clean(Time now, const Segment& segment, uint64_t resting) {
  const Transfer& transfer = segment.transfer;
  const auto number = static_cast<uint32_t>(&segment - segments_.data());
  const Frame& frame = transfer.winner().frame;
  const std::span<const uint64_t> takers = filter_.takers(frame.id);
  const auto visit = [&](NodeId id) {
    if (!transfer.sent_by(id) && nodes_[id].segment == number && is_active(id)) deliver(now, segment, id);
    erring_.put(id, nodes_[id].counters.receive != 0);
  };
  const auto hand_over = [&](NodeId id) {  // its counter stays at 0
    const Node& node = nodes_[id];
    if (!transfer.sent_by(id) && node.segment == number && is_active(node)) node.node->on_frame(now, frame);
  };
  for (size_t n = 0; n < takers.size(); ++n) {
    const uint64_t wanted = takers[n] & ~(n == 0 ? resting : 0);
    if (erring_.words()[n] != 0)
      NodeSet::each_bit(wanted | erring_.words()[n], n, visit);
    else
      NodeSet::each_bit(wanted, n, hand_over);
  }
}

// Its sender may have been cut off meanwhile, or counts errors now.
inline void CanLine::end_plain(Time now) {
  Segment& segment = segments_[0];
  const Transfer& transfer = segment.transfer;
  release(segment);
  const Transfer::Sender& sender = transfer.senders.front();
  report_frame(now, transfer, sender);
  const std::span<const uint64_t> takers = filter_.takers(sender.frame.id);
  const uint64_t resting = known_.resting(sender.frame);
  if (takers.size() > 1 || ((takers[0] & ~resting) | erring_.words()[0]) != 0)
    deliver_clean(now, segment, resting);
  Node& node = nodes_[sender.node];
  if (node.queue.empty() || !node.queue.front().on_wire || !node.counters.untouched()) {
    settle_sender(now, segment, sender);
  } else {
    node.unacknowledged = false;
    if (node.queue.size() == 1) {
      node.queue.pop_back();
      contenders_.remove(sender.node);
    } else {
      node.queue.erase(node.queue.begin());
      queue_changed(sender.node);
    }
    node.node->on_sent(now, sender.frame, sender.tag);
  }
  settle_line();
}

// One transfer after the other without the queue, as long as nothing happens in between.
void CanLine::begin_and_end(uint32_t number, bool begins) {
  for (;; begins = !begins) {
    Segment& segment = segments_[number];
    uint64_t bit = segment.start_bit;
    if (begins) {
      segment.start_event = kNoEvent;
      if (!begin_plain(bit) && !begin_transfer(number, bit)) return schedule_start(number);
      bit += segment.transfer.end;
      if (queue_.advance(static_cast<Time>(bit) * bit_time_, source_)) continue;
      queue_.schedule(static_cast<Time>(bit) * bit_time_, source_, *this, line_event::kEnd, number);
      return;
    }
    if (segment.transfer.plain)
      end_plain(queue_.now());
    else
      end_transfer(queue_.now(), number);
    if (segments_.size() != 1 || segments_[0].start_event != kNoEvent) return schedule_start();
    bit = next_start(0);
    if (bit == kNoBit) return;
    if (!queue_.advance(static_cast<Time>(bit) * bit_time_, source_)) return schedule_start(0);
    number = 0;
    segments_[0].start_bit = bit;
  }
}

// False: nobody sends.
bool CanLine::begin_transfer(uint32_t number, uint64_t bit) {
  Segment& segment = segments_[number];
  Transfer& transfer = segment.transfer;
  transfer.plain = false;
  transfer.start_bit = bit;
  transfer.senders.clear();
  transfer.fault = {};
  const auto send = [&](NodeId id) {
    if (!is_active(id)) return;
    Node& node = nodes_[id];
    Pending& pending = node.queue[static_cast<size_t>(first_ready(node, bit) - node.queue.data())];
    pending.on_wire = true;
    transfer.senders.push_back({id, pending.frame, pending.tag, node.counters.state() == ErrorState::Active});
  };
  if (segments_.size() == 1 && contenders_.all_ready(bit) && !contenders_.empty()) {
    contenders_.each_first(send);
  } else {
    uint32_t lowest = ~0U;
    contenders_.each([&](NodeId id) {
      const Contender& contender = contenders_[id];
      if (nodes_[id].segment != number || contender.ready > bit) return;
      const uint32_t key = contender.first_ready <= bit ? contender.key : first_ready(nodes_[id], bit)->key;
      if (key > lowest) return;
      if (key < lowest) winners_.clear();
      lowest = key;
      winners_.push_back(id);
    });
    for (const NodeId id : winners_) send(id);
    winners_.clear();
  }
  if (transfer.senders.empty()) return false;
  pause_recovery(number, bit);
  if (!faults_.empty()) transfer.fault = faults_.strike(queue_.now(), transfer.senders.front().frame.id);
  Listeners listeners;
  for (NodeId id = 0; id < nodes_.size(); ++id) {
    if (listeners.error_active && !transfer.fault.kind) break;  // no other listener makes a difference
    if (transfer.sent_by(id) || nodes_[id].segment != number || !is_active(id)) continue;
    const bool error_active = nodes_[id].counters.state() == ErrorState::Active;
    listeners.any = true;
    listeners.error_active |= error_active;
    if (id == transfer.fault.node) {
      listeners.struck = true;
      listeners.struck_error_active = error_active;
    } else {
      listeners.others = true;
    }
  }
  resolve(transfer, listeners, known_, shorts_ > 0);
  segment.busy = true;
  return true;
}

void CanLine::end_transfer(Time now, uint32_t number) {
  Segment& segment = segments_[number];
  const Transfer& transfer = segment.transfer;
  release(segment);
  // Callbacks below may send and withdraw; they change the queues, never the transfer, as the next one has
  // not begun.
  if (transfer.fault.kind)
    report({LineEventKind::FaultStrikes, now, transfer.fault.node, kNoNode, transfer.winner().frame.id,
            static_cast<uint8_t>(*transfer.fault.kind)});
  if (transfer.received()) report_frame(now, transfer, transfer.winner());
  known_.stir_all(transfer.winner().frame);
  if (transfer.received() && transfer.fault.is(FaultKind::Delay)) {
    late_.push_back(LateFrame{transfer.winner().frame, transfer.winner().node, transfer.fault.node, number});
    queue_.schedule(now + transfer.fault.lag, source_, *this, line_event::kLate, late_.size() - 1);
  }
  if (transfer.outcome == Transfer::Outcome::Delivered && !transfer.fault.kind &&
      !transfer.winner().frame.extended) {
    deliver_clean(now, segment, 0);
  } else {
    for (NodeId id = 0; id < nodes_.size(); ++id) {
      if (!transfer.sent_by(id) && nodes_[id].segment == number && is_active(id)) deliver(now, segment, id);
      erring_.put(id, nodes_[id].counters.receive != 0);
    }
  }
  for (const Transfer::Sender& sender : transfer.senders) settle_sender(now, segment, sender);
  settle_line();
}

// What a transfer is to one listener.
void CanLine::deliver(Time now, const Segment& segment, NodeId listener) {
  const Transfer& transfer = segment.transfer;
  const FrameFault& fault = transfer.fault;
  Node& node = nodes_[listener];
  const bool concerned = fault.kind && (fault.node == kNoNode || fault.node == listener);
  const bool disturbed = fault.is(FaultKind::Corrupt) || fault.is(FaultKind::Terminator);
  const ErrorState before = node.counters.state();
  if (transfer.outcome == Transfer::Outcome::NoLevel) return;  // it hears nothing
  if (!transfer.received() || (disturbed && concerned)) {
    node.counters.receive_failed(fault.node == listener && before == ErrorState::Active);
    return count_error_state(now, listener, before);
  }
  node.counters.received();
  if (concerned && (fault.is(FaultKind::Drop) || fault.is(FaultKind::Delay))) return;
  node.node->on_frame(now, transfer.winner().frame);
}

void CanLine::settle_sender(Time now, const Segment& segment, const Transfer::Sender& sender) {
  using Outcome = Transfer::Outcome;
  const Transfer& transfer = segment.transfer;
  Node& node = nodes_[sender.node];
  const auto pending =
      std::find_if(node.queue.begin(), node.queue.end(), [](const Pending& p) { return p.on_wire; });
  if (pending == node.queue.end()) return;  // cut off meanwhile: dropped and told
  const bool sent = transfer.outcome == Outcome::Delivered && !sender.lost;
  if (sent || pending->withdrawn)
    node.queue.erase(pending);
  else
    pending->on_wire = false;
  NodeId partner = kNoNode;
  for (const Transfer::Sender& other : transfer.senders)
    if (other.node != sender.node) partner = other.node;
  const ErrorState before = node.counters.state();
  NotSent reason = NotSent::Collision;
  if (sent) {
    node.counters.sent();
    node.unacknowledged = false;
    if (partner != kNoNode && sender.node == transfer.winner().node)
      report({LineEventKind::SameFrame, now, sender.node, partner, sender.frame.id});
  } else if (transfer.outcome == Outcome::NoAcknowledge && !sender.lost) {
    reason = NotSent::NoAcknowledge;
    node.counters.not_acknowledged();
    if (!std::exchange(node.unacknowledged, true))
      report({LineEventKind::NoAcknowledge, now, sender.node, kNoNode, sender.frame.id});
  } else if (transfer.outcome == Outcome::Collision || sender.lost) {
    node.counters.send_failed();
    report({LineEventKind::Collision, now, sender.node, partner, sender.frame.id});
  } else {
    reason = NotSent::Corrupted;
    node.counters.send_failed();
  }
  if (node.counters.state() == ErrorState::Passive) node.suspended_until = segment.free_bit + kSuspendBits;
  queue_changed(sender.node);
  if (sent)
    node.node->on_sent(now, sender.frame, sender.tag);
  else
    node.node->on_not_sent(now, sender.frame, sender.tag, reason);
  count_error_state(now, sender.node, before);
}

void CanLine::count_error_state(Time now, NodeId node, ErrorState before) {
  const ErrorState after = nodes_[node].counters.state();
  if (after == before) return;
  if (after == ErrorState::Passive) report({LineEventKind::ErrorPassive, now, node});
  if (after != ErrorState::BusOff) return;
  report({LineEventKind::BusOff, now, node});
  drop_queue(node);
  nodes_[node].node->on_bus_off(now);
}

// A frame on the wire at this moment is still carried to its end (ours).
void CanLine::drop_queue(NodeId node) {
  const std::vector<Pending> dropped = std::exchange(nodes_[node].queue, {});
  nodes_[node].queue.reserve(kSendQueueLimit);
  queue_changed(node);
  schedule_start(nodes_[node].segment);
  for (const Pending& pending : dropped)
    nodes_[node].node->on_not_sent(queue_.now(), pending.frame, pending.tag, NotSent::Dropped);
}

}  // namespace ipos::runtime
