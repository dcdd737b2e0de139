// Stations that are on the wires and not of the line: at another rate, or with high and low interchanged. They destroy what
// the others send, and the counters of all tell when that ends (ISO 11898-1).
//
// One at another rate hears frames as errors, and its active error flag destroys them, until it is error passive. What it
// sends is noise. One with interchanged wires hears nothing; its levels reach the others as recessive, and extinguish
// dominant bits that are sent at the same time; it begins to send within a frame, too.
#include <algorithm>
#include <utility>

#include "runtime/bus/can/bit_error.hpp"
#include "runtime/bus/can/clash.hpp"
#include "runtime/bus/can/frame_bits.hpp"
#include "runtime/bus/can/line.hpp"

namespace ipos::runtime {
namespace {

constexpr uint32_t kShortestFrame = unstuffed_bits(0, false);

}  // namespace

void CanLine::find_strangers() {
  strangers_.clear();
  for (NodeId id = 0; id < nodes_.size(); ++id)
    if (is_stranger(nodes_[id])) strangers_.push_back(id);
}

// The first bit at which one of them sends; kNoBit: none does.
uint64_t CanLine::next_stranger(uint32_t number) const {
  uint64_t bit = kNoBit;
  for (const NodeId id : strangers_)
    if (nodes_[id].segment == number && takes_bus(nodes_[id])) bit = std::min(bit, next_ready(nodes_[id]));
  return bit;
}

bool CanLine::stranger_sends(uint32_t number, uint64_t bit) const {
  return std::any_of(strangers_.begin(), strangers_.end(), [&](NodeId id) {
    const Node& node = nodes_[id];
    return node.segment == number && takes_bus(node) && first_ready(node, bit) != nullptr;
  });
}

// A frame begins, of the stations of the line, of strangers or of both: who of them destroys it.
void CanLine::meet_strangers(uint32_t number, uint64_t bit, const Listeners& listeners) {
  using Outcome = Transfer::Outcome;
  Transfer& transfer = segments_[number].transfer;
  const bool carried = !transfer.senders.empty();
  // What is destroyed already needs no second flag.
  const bool whole = !carried || transfer.outcome == Outcome::Delivered || transfer.outcome == Outcome::NoAcknowledge ||
                     transfer.outcome == Outcome::Repeated;
  NodeId sends = kNoNode, hears = kNoNode;
  for (const NodeId id : strangers_) {
    Node& node = nodes_[id];
    if (node.segment != number || !takes_bus(node)) continue;
    const bool active = node.counters.state() == ErrorState::Active;
    if (const Pending* first = first_ready(node, node.swapped && carried ? bit + kShortestFrame : bit)) {
      Pending& pending = node.queue[static_cast<size_t>(first - node.queue.data())];
      pending.on_wire = true;
      transfer.senders.push_back({id, pending.frame, pending.tag, active});
      if (sends == kNoNode) sends = id;
    } else if (hears == kNoNode && active && !node.swapped) {
      hears = id;
    }
  }
  if (!whole || (sends == kNoNode && (hears == kNoNode || !carried))) return;
  const Node& stranger = nodes_[sends != kNoNode ? sends : hears];
  const Transfer::Sender& first = transfer.senders.front();
  const WireBits bits = wire_bits(first.frame);
  const TwoRates rates{baud_, stranger.swapped ? baud_ : stranger.rate()};
  Clash clash;
  if (sends == kNoNode) {
    clash = clash_of_listener(bits, first.frame.extended, first.error_active, rates);
  } else {
    const auto own = std::find_if(transfer.senders.begin(), transfer.senders.end(),
                                  [sends](const Transfer::Sender& sender) { return sender.node == sends; });
    const bool heard = carried || (listeners.error_active && !stranger.swapped);
    clash = clash_of_sender(wire_bits(own->frame), own->error_active, carried ? &bits : nullptr, heard, rates);
  }
  transfer.stranger = sends != kNoNode ? sends : hears;
  transfer.stranger_waits = clash.station_waits;
  transfer.others_wait = clash.others_wait;
  transfer.outcome = clash.unheard ? Outcome::NoAcknowledge : Outcome::Corrupted;
  transfer.mute = !carried && stranger.swapped;
  transfer.flagged = !transfer.mute;
  transfer.end = clash.end + kErrorDelimiterBits;
  transfer.bits = transfer.end + kIntermissionBits;
}

// The frame was destroyed: each stranger that did not send it counts, and the first one is told.
void CanLine::settle_strangers(Time now, uint32_t number) {
  const Transfer& transfer = segments_[number].transfer;
  if (transfer.mute || transfer.received()) return;
  for (const NodeId id : strangers_) {
    Node& node = nodes_[id];
    if (node.segment != number || !takes_bus(node) || node.swapped || transfer.sent_by(id)) continue;
    const ErrorState before = node.counters.state();
    node.counters.receive_failed(transfer.stranger_waits && before == ErrorState::Active);
    count_error_state(now, id, before);
  }
  if (transfer.stranger == kNoNode || std::exchange(nodes_[transfer.stranger].told_stranger, true)) return;
  report({transfer.sent_by(transfer.stranger) ? LineEventKind::TalksOver : LineEventKind::Disturbs, now,
          transfer.stranger});
}

}  // namespace ipos::runtime
