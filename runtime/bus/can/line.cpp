// The line as a machine of two events: the start bit of the next transfer, and the end of the current one.
#include "runtime/bus/can/line.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "runtime/bus/can/line_event_kinds.hpp"

namespace ipos::runtime {

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
  wake();
  const NodeId id = static_cast<NodeId>(nodes_.size());
  Node added{};
  added.name = std::move(name);
  added.baud = baud;
  added.node = &node;
  if (!nodes_.empty()) added.segment = nodes_.back().segment;
  wire(added);
  nodes_.push_back(std::move(added));
  if (is_stranger(nodes_.back())) strangers_.push_back(id);
  nodes_.back().queue.reserve(kSendQueueLimit);
  contenders_.grow(nodes_.size());
  winners_.reserve(nodes_.size());
  filter_.grow(nodes_.size());
  erring_.grow(nodes_.size());
  standing_.grow(nodes_.size());
  report_absence(id, nullptr);
  return id;
}

bool CanLine::is_reachable(NodeId from, NodeId to) const {
  return is_active(from) && is_active(to) && nodes_[from].segment == nodes_[to].segment;
}

// --- sending

// That the frame is valid and canonical is seen to where it comes in: send() makes it so, StandingFrames::add() asserts it once
// for all of its cycles.
SendStatus CanLine::send_canonical(NodeId node, const Frame& frame, uint64_t tag, bool overtakes) {
  assert(node < nodes_.size() && tag <= kTagMask);
  Node& n = nodes_[node];
  if (!takes_bus(n)) return SendStatus::NotActive;
  wake();
  const uint64_t ready = static_cast<uint64_t>(queue_.now() / bit_time_) + 1;
  const uint32_t key = arbitration_key(frame);
  const uint64_t wanted = std::max(ready, n.suspended_until);
  if (overtakes && !n.queue.empty()) withdraw(node, tag);
  if (n.queue.empty()) {
    n.queue.emplace_back(frame, tag, ready);
    if (n.wired) contenders_.join(node, wanted, key);
  } else if (n.queue.size() < kSendQueueLimit) {
    queue_behind(node, {frame, tag, ready});
  } else {
    return SendStatus::QueueFull;
  }
  const Segment& segment = segments_[n.segment];
  if (std::max(wanted, segment.free_bit) < segment.start_bit) schedule_start(n.segment);
  return SendStatus::Queued;
}

// Others of this node are waiting already.
void CanLine::queue_behind(NodeId node, const Pending& pending) {
  std::vector<Pending>& queue = nodes_[node].queue;
  const auto behind = std::upper_bound(queue.begin(), queue.end(), pending.key(),
                                       [](uint32_t wanted, const Pending& p) { return wanted < p.key(); });
  queue.insert(behind, pending);
  queue_changed(node);
}

void CanLine::withdraw(NodeId node, uint64_t tag) {
  assert(node < nodes_.size());
  std::vector<Pending>& queue = nodes_[node].queue;
  const Segment& segment = segments_[nodes_[node].segment];
  const bool settled = segment.start_bit != kNoBit;
  if (queue.empty() && settled) return;
  wake();
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
  if (node.queue.empty() || !node.wired) return contenders_.remove(id);
  const Pending& first = node.queue.front();
  contenders_.put(id, std::max(first.ready_bit, node.suspended_until), first.key());
}

void CanLine::schedule_start() {
  for (uint32_t segment = 0; segment < segments_.size(); ++segment) schedule_start(segment);
}

// The first bit at which somebody can send; kNoBit: nobody.
inline uint64_t CanLine::next_start(uint32_t number) const {
  if (stuck_ != 0 || rewire_ || (contenders_.empty() && strangers_.empty())) return kNoBit;
  const uint64_t free_bit = segments_[number].free_bit;
  if (segments_.size() == 1 && !contenders_.empty() && contenders_.all_ready(free_bit)) return free_bit;
  uint64_t bit = strangers_.empty() || shorts_ != 0 ? kNoBit : next_stranger(number);  // a short circuit is all they hear
  contenders_.each([&](NodeId id) {
    if (nodes_[id].segment == number) bit = std::min(bit, next_ready(nodes_[id]));
  });
  return bit == kNoBit ? bit : std::max(bit, free_bit);
}

// Keeps the start event at that bit.
void CanLine::schedule_start(uint32_t number) {
  Segment& segment = segments_[number];
  if (segment.busy()) return;
  const uint64_t bit = next_start(number);
  if (segment.start_bit == bit) return;
  cancel_start(segment);
  if (bit == kNoBit) return;
  segment.start_bit = bit;
  segment.start_event =
      queue_.schedule(static_cast<Time>(bit) * bit_time_, source_, *this, line_event::kStart, number);
}

// --- transfers

void CanLine::on_event(Time now, uint32_t kind, uint64_t argument) {
  switch (kind) {
    case line_event::kStart:
      if (repeats_.any()) return catch_up();  // as many as were foreseen
      return begin_and_end(static_cast<uint32_t>(argument), true);
    case line_event::kEnd: return begin_and_end(static_cast<uint32_t>(argument), false);
    case line_event::kFaultBegins: return switch_fault(now, static_cast<size_t>(argument), true);
    case line_event::kFaultEnds: return switch_fault(now, static_cast<size_t>(argument), false);
    case line_event::kLate: return deliver_late(now, static_cast<size_t>(argument));
    default: return finish_recovery(now, static_cast<NodeId>(argument));
  }
}

// What nearly all transfers are: on a sound line one node has the lowest key, and no error counter makes a
// difference. kNoNode: all that is to be looked at.
inline NodeId CanLine::plain_sender(uint64_t bit) {
  if (contenders_.empty() || !contenders_.all_ready(bit) || (!sound_ && !find_sound())) return kNoNode;
  const NodeId id = contenders_.only_first();
  if (id == kNoNode) return kNoNode;
  const Node& node = nodes_[id];
  return node.counters.untouched() && !node.queue.front().frame.extended ? id : kNoNode;
}

// Plain transfers from this bit on, each from its begin to its end, as long as nothing else happens in
// between. False: not even one.
inline bool CanLine::pass_plain(uint64_t bit) {
  const Segment& segment = segments_[0];
  for (bool any = false;; any = true) {
    const NodeId id = plain_sender(bit);
    if (id == kNoNode) return any;
    Pending& pending = nodes_[id].queue.front();
    const KnownFrames::Known& known = known_.know(pending.frame);
    const uint32_t bits = known.bits;
    const Time end = static_cast<Time>(bit + bits - kIntermissionBits) * bit_time_;
    if (!queue_.advance(end, source_)) return any;
    pending.on_wire = true;
    end_plain({pending.frame, id, static_cast<Time>(bit) * bit_time_, end, bits}, bit, pending.tag, known);
    if (segment.start_bit != kNoBit) return true;
    bit = segment.free_bit;
  }
}

std::optional<Time> CanLine::plain_end() {
  const uint64_t bit = segments_[0].start_bit;
  if (segments_.size() != 1 || segments_[0].busy() || bit == kNoBit) return std::nullopt;
  const NodeId id = plain_sender(bit);
  if (id == kNoNode) return std::nullopt;
  return static_cast<Time>(bit + known_.bits(nodes_[id].queue.front().frame) - kIntermissionBits) * bit_time_;
}

void CanLine::begin_plain(NodeId id, uint64_t bit) {
  Pending& pending = nodes_[id].queue.front();
  pending.on_wire = true;
  note_plain(id, pending.frame, pending.tag, bit, known_.bits(pending.frame));
  segments_[0].start_bit = kBusy;
}

void CanLine::note_plain(NodeId id, const Frame& frame, uint64_t tag, uint64_t bit, uint32_t bits) {
  Transfer& transfer = segments_[0].transfer;
  transfer.senders.assign(1, {id, frame, tag, true});
  transfer.outcome = Transfer::Outcome::Delivered;
  transfer.plain = true;
  transfer.start_bit = bit;
  transfer.bits = bits;
  transfer.end = bits - kIntermissionBits;
}

// A line without planted faults has one segment.
bool CanLine::find_sound() {
  const auto active = [](const Node& node) { return is_active(node); };
  sound_ = faults_.empty() && strangers_.empty() && !recovering_ && std::count_if(nodes_.begin(), nodes_.end(), active) > 1;
  return sound_;
}

inline void CanLine::release(Segment& segment, uint64_t begin, uint32_t bits) {
  segment.start_bit = kNoBit;
  segment.end_at(begin + bits);
  meter_.add(begin, bits);
}

inline void CanLine::report_frame(const FrameRecord& record) {
  ++frames_;
  for (CanObserver* observer : frame_observers_) observer->on_frame(*this, record);
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
  const auto visit = [&](NodeId id) {
    if (!transfer.sent_by(id) && nodes_[id].segment == number && is_active(id)) deliver(now, segment, id);
    erring_.put(id, nodes_[id].counters.receive != 0);
  };
  const auto hand_over = [&](NodeId id) {  // its counter stays at 0
    const Node& node = nodes_[id];
    if (!transfer.sent_by(id) && node.segment == number && is_active(node)) node.node->on_frame(now, frame);
  };
  for (size_t n = 0; n < erring_.words().size(); ++n) {
    const uint64_t takers = filter_.takers(frame.id)[n];  // looked up again: who takes a frame may open its filter
    const uint64_t wanted = takers & ~(n == 0 ? resting : 0);
    if (erring_.words()[n] != 0)
      NodeSet::each_bit(wanted | erring_.words()[n], n, visit);
    else
      NodeSet::each_bit(wanted, n, hand_over);
  }
}

// Its sender may have been cut off meanwhile, or counts errors now.
[[gnu::always_inline]] inline void CanLine::end_plain(const FrameRecord& record, uint64_t begin, uint64_t tag,
                                                      const KnownFrames::Known& known) {
  release(segments_[0], begin, record.bits);
  report_frame(record);
  const std::span<const uint64_t> takers = filter_.takers(record.frame.id);
  const uint64_t resting = known.resting;
  const uint64_t wanted = takers[0] & ~resting;
  if (takers.size() > 1 || erring_.words()[0] != 0) {
    note_plain(record.sender, record.frame, tag, begin, record.bits);
    deliver_clean(record.end, segments_[0], resting);
  } else if (wanted != 0) {
    const auto hand_over = [&](NodeId id) {
      if (id != record.sender && is_active(nodes_[id])) nodes_[id].node->on_frame(record.end, record.frame);
    };
    NodeSet::each_bit(wanted, 0, hand_over);
  }
  Node& node = nodes_[record.sender];
  if (node.queue.empty() || !node.queue.front().on_wire || !node.counters.untouched()) {
    note_plain(record.sender, record.frame, tag, begin, record.bits);
    settle_sender(record.end, segments_[0], segments_[0].transfer.senders.front());
  } else {
    node.unacknowledged = false;
    if (node.queue.size() == 1) {
      node.queue.pop_back();
      contenders_.remove(record.sender);
    } else {
      node.queue.erase(node.queue.begin());
      queue_changed(record.sender);
    }
    node.node->on_sent(record.end, record.frame, tag);
  }
  if (!sound_) settle_line();
}

// One transfer after the other without the queue, as long as nothing happens in between.
void CanLine::begin_and_end(uint32_t number, bool begins) {
  uint64_t bit = begins ? std::exchange(segments_[number].start_bit, kNoBit) : kNoBit;
  for (;; begins = true) {
    if (!begins) {
      end_transfer(queue_.now(), number);
    } else if (!pass_plain(bit)) {
      const NodeId plain = plain_sender(bit);
      const Time begin = static_cast<Time>(bit) * bit_time_;
      if (begin > queue_.now() && !queue_.advance(begin, source_)) return schedule_start(number);
      if (plain != kNoNode)
        begin_plain(plain, bit);
      else if (!begin_transfer(number, bit))
        return schedule_start(number);
      const Time end = begin + segments_[number].transfer.end * bit_time_;
      if (!queue_.advance(end, source_)) {
        queue_.schedule(end, source_, *this, line_event::kEnd, number);
        return;
      }
      end_transfer(end, number);
    }
    if (segments_.size() != 1 || segments_[0].start_bit != kNoBit) return schedule_start();
    bit = next_start(0);
    if (bit == kNoBit || begin_repeats(bit)) return;
    number = 0;
  }
}

// False: nobody sends.
bool CanLine::begin_transfer(uint32_t number, uint64_t bit) {
  Segment& segment = segments_[number];
  Transfer& transfer = segment.transfer;
  transfer.plain = false;
  transfer.flagged = transfer.mute = false;
  transfer.stranger = kNoNode;
  transfer.stranger_waits = transfer.others_wait = false;
  assert(!segment.busy());
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
      const Pending* first = nodes_[id].segment == number ? first_ready(nodes_[id], bit) : nullptr;
      if (first == nullptr || first->key() > lowest) return;
      if (first->key() < lowest) winners_.clear();
      lowest = first->key();
      winners_.push_back(id);
    });
    std::sort(winners_.begin(), winners_.end());  // in order of attachment
    for (const NodeId id : winners_) send(id);
    winners_.clear();
  }
  const bool carried = !transfer.senders.empty();
  if (!carried && (strangers_.empty() || shorts_ != 0 || !stranger_sends(number, bit))) return false;
  pause_recovery(number, bit);
  if (!faults_.empty() && carried) transfer.fault = faults_.strike(queue_.now(), transfer.senders.front().frame.id);
  const Listeners listeners = listeners_of(number);
  if (carried) resolve(transfer, listeners, known_, shorts_ > 0);
  if (!strangers_.empty() && shorts_ == 0) meet_strangers(number, bit, listeners);
  segment.start_bit = kBusy;
  return true;
}

// Who hears the frame that begins, and whose flag counts.
Listeners CanLine::listeners_of(uint32_t number) const {
  const Transfer& transfer = segments_[number].transfer;
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
  return listeners;
}

void CanLine::end_transfer(Time now, uint32_t number) {
  Segment& segment = segments_[number];
  const Transfer& transfer = segment.transfer;
  const Transfer::Sender& winner = transfer.winner();
  assert(segment.busy());
  const FrameRecord record{winner.frame, winner.node, static_cast<Time>(transfer.start_bit) * bit_time_, now,
                           transfer.bits};
  if (transfer.plain) return end_plain(record, transfer.start_bit, winner.tag, known_.last(winner.frame));
  release(segment, transfer.start_bit, transfer.bits);
  // Callbacks below may send and withdraw; they change the queues, never the transfer, as the next one has
  // not begun.
  if (transfer.fault.kind)
    report({LineEventKind::FaultStrikes, now, transfer.fault.node, kNoNode, transfer.winner().frame.id,
            static_cast<uint8_t>(*transfer.fault.kind), 1, transfer.fault.of_line});
  if (transfer.received()) report_frame(record);
  if (transfer.flagged) report_error(record, transfer.outcome == Transfer::Outcome::NoAcknowledge);
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
  if (!strangers_.empty()) settle_strangers(now, number);
  for (const Transfer::Sender& sender : transfer.senders) settle_sender(now, segment, sender);
  settle_line();
}

// What a transfer is to one listener.
void CanLine::deliver(Time now, const Segment& segment, NodeId listener) {
  const Transfer& transfer = segment.transfer;
  const FrameFault& fault = transfer.fault;
  Node& node = nodes_[listener];
  const bool concerned = fault.kind && (fault.node == kNoNode || fault.node == listener);
  const bool disturbed = fault.disturbs_a_bit();
  const ErrorState before = node.counters.state();
  if (transfer.outcome == Transfer::Outcome::NoLevel || transfer.mute) return;  // it hears nothing
  if (!transfer.received() || (disturbed && concerned)) {
    const bool first = fault.node == listener || transfer.others_wait;
    node.counters.receive_failed(first && before == ErrorState::Active);
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
  NodeId same = kNoNode;  // sent the same bits to the end
  for (const Transfer::Sender& other : transfer.senders)
    if (other.node != sender.node) (sent && !other.lost ? same : partner) = other.node;
  const ErrorState before = node.counters.state();
  NotSent reason = NotSent::Collision;
  if (sent) {
    node.counters.sent();
    node.unacknowledged = false;
    if (same != kNoNode && sender.node == transfer.winner().node)
      report({LineEventKind::SameFrame, now, sender.node, same, sender.frame.id});
  } else if (transfer.outcome == Outcome::NoAcknowledge && !sender.lost) {
    reason = NotSent::NoAcknowledge;
    node.counters.not_acknowledged();
    const bool told = std::exchange(node.unacknowledged, true) || !node.wired;
    if (!told && partner == kNoNode)
      report({LineEventKind::NoAcknowledge, now, sender.node, kNoNode, sender.frame.id});
    else if (!told && sender.node == transfer.winner().node)
      report({LineEventKind::AllSendTheSame, now, sender.node, partner, sender.frame.id, 0,
              transfer.senders.size()});
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
  sound_ = false;
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
