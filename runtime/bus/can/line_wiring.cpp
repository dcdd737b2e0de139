// Who takes part in the line: baud rates, connections, planted wiring faults, and the way back from bus-off.
#include <algorithm>
#include <utility>

#include "runtime/bus/can/line.hpp"
#include "runtime/bus/can/line_event_kinds.hpp"

namespace ipos::runtime {
namespace {

constexpr uint32_t kRecoveryRuns = 128;  // ISO 11898-1: of kRecoveryBits recessive bits each
constexpr uint32_t kRecoveryBits = 11;

}  // namespace

void CanLine::rewire(NodeId id) {
  Node& node = nodes_[id];
  wire(node);
  if (!is_stranger(node)) node.told_stranger = false;
  find_strangers();
  queue_changed(id);
  schedule_start(node.segment);
}

void CanLine::set_baud(NodeId node, uint32_t baud) {
  wake();
  nodes_[node].baud = baud;
  rewire(node);
  if (!is_active(node)) drop_queue(node);
  report_absence(node, nullptr);
}

void CanLine::set_connected(NodeId node, bool connected) {
  wake();
  nodes_[node].connected = connected;
  rewire(node);
  if (!connected) drop_queue(node);
  report_absence(node, nullptr);
}

bool CanLine::set_line_baud(uint32_t baud) {
  if (frames_ != 0 || !contenders_.empty() || segments_.size() != 1 || segments_[0].busy() || segments_[0].free_bit != 0)
    return false;
  for (Node& node : nodes_)
    if (node.baud == baud_) node.baud = baud;
  baud_ = baud;
  bit_time_ = (kSecond + baud / 2) / baud;
  meter_ = LoadMeter(baud);
  for (Node& node : nodes_) wire(node);
  find_strangers();
  return true;
}

// --- planted faults

void CanLine::plant(const LineFault& fault) {
  wake();
  const size_t number = faults_.add(fault);
  sound_ = false;
  if (fault_type(fault.kind).scope == FaultScope::Frame) return;  // strikes by itself
  queue_.schedule(fault.from, source_, *this, line_event::kFaultBegins, number);
  if (fault.until != kNever) queue_.schedule(fault.until, source_, *this, line_event::kFaultEnds, number);
}

bool CanLine::repair(const LineFault& like) {
  wake();
  bool found = false;
  const Time now = queue_.now();
  for (size_t n = 0; n < faults_.size(); ++n) {
    const LineFault& fault = faults_[n];
    if (fault.kind != like.kind || fault.node != like.node || fault.behind != like.behind || fault.id != like.id ||
        fault.from > now || fault.until != kNever)
      continue;
    found = true;
    faults_.end(n, now);
    if (fault_type(fault.kind).scope == FaultScope::Wiring)
      queue_.schedule(now, source_, *this, line_event::kFaultEnds, n);
  }
  return found;
}

void CanLine::switch_fault(Time now, size_t number, bool on) {
  wake();
  const LineFault fault = faults_[number];
  report({on ? LineEventKind::FaultStrikes : LineEventKind::FaultEnds, now,
          fault.behind ? kNoNode : fault.node, fault.behind ? fault.node : kNoNode, fault.kind == FaultKind::Baud ? fault.baud : 0,
          static_cast<uint8_t>(fault.kind)});
  switch (fault.kind) {
    case FaultKind::Cut:
      if (!fault.behind) return set_connected(fault.node, !on);
      if (on)
        cuts_.push_back(fault.node);
      else
        cuts_.erase(std::find(cuts_.begin(), cuts_.end(), fault.node));
      rewire_ = true;
      rebuild_segments();
      break;
    case FaultKind::Swap:
      nodes_[fault.node].swapped = on;
      rewire(fault.node);
      break;
    case FaultKind::Baud:
      nodes_[fault.node].fault_baud = on ? fault.baud : 0;
      rewire(fault.node);
      break;
    case FaultKind::Short: shorts_ += on ? 1 : ~0U; break;
    case FaultKind::Stuck:
      stuck_ += on ? 1 : ~0U;
      for (Segment& segment : segments_) {  // after it an error delimiter and the intermission
        segment.recessive_from = static_cast<uint64_t>(now / bit_time_) + 1;
        segment.free_bit = std::max(segment.free_bit, segment.recessive_from + kRecoveryBits);
      }
      for (NodeId id = 0; id < nodes_.size(); ++id) {
        queue_.cancel(std::exchange(nodes_[id].recovery, kNoEvent));
        nodes_[id].recovery_from = static_cast<uint64_t>(now / bit_time_) + 1;
        if (!on) schedule_recovery(id);
        if (!on || !is_active(id)) continue;
        // After its error flag each further 8 dominant bits count 8: passive within 150 bits.
        const ErrorState before = nodes_[id].counters.state();
        while (nodes_[id].counters.receive < 128) nodes_[id].counters.receive_failed(true);
        count_error_state(now, id, before);
        erring_.put(id, true);
      }
      break;
    default: break;
  }
  schedule_start();
}

// Once no frame is under way: each node belongs to the segment between the cuts around it.
void CanLine::rebuild_segments() {
  if (std::any_of(segments_.begin(), segments_.end(), [](const Segment& s) { return s.busy(); })) {
    for (Segment& segment : segments_)
      if (!segment.busy()) cancel_start(segment);
    return;
  }
  rewire_ = false;
  uint64_t free_bit = 0;
  uint64_t recessive_from = 0;
  for (Segment& segment : segments_) {
    cancel_start(segment);
    free_bit = std::max(free_bit, segment.free_bit);
    recessive_from = std::max(recessive_from, segment.recessive_from);
  }
  segments_.resize(cuts_.size() + 1);
  for (Segment& segment : segments_) {
    segment.free_bit = free_bit;
    segment.recessive_from = recessive_from;
  }
  for (NodeId id = 0; id < nodes_.size(); ++id)
    nodes_[id].segment = static_cast<uint32_t>(
        std::count_if(cuts_.begin(), cuts_.end(), [id](NodeId cut) { return cut < id; }));
}

void CanLine::deliver_late(Time now, size_t number) {
  const LateFrame late = *std::exchange(late_[number], std::nullopt);
  while (!late_.empty() && !late_.back()) late_.pop_back();
  known_.stir_all(late.frame);
  for (NodeId id = 0; id < nodes_.size(); ++id)
    if (id != late.sender && (late.only == kNoNode || late.only == id) &&
        nodes_[id].segment == late.segment && is_active(id))
      nodes_[id].node->on_frame(now, late.frame);
}

// --- bus-off

void CanLine::restart(NodeId node) {
  wake();
  queue_.cancel(std::exchange(nodes_[node].recovery, kNoEvent));
  nodes_[node].recovery_runs = 0;
  nodes_[node].counters = {};
}

// The counters stand in the middle of what the state allows, so that one frame does not change it.
void CanLine::tell_error_state(NodeId id, ErrorState state) {
  wake();
  constexpr uint32_t kTransmit[] = {0, 192, 256};
  Node& node = nodes_[id];
  const bool was_off = node.counters.state() == ErrorState::BusOff, is_off = state == ErrorState::BusOff;
  node.counters = {kTransmit[static_cast<size_t>(state)], 0};
  erring_.put(id, false);
  if (was_off == is_off) return;
  sound_ = false;
  if (is_off) drop_queue(id);
}

void CanLine::recover(NodeId node) {
  if (nodes_[node].counters.state() != ErrorState::BusOff) return;
  wake();
  nodes_[node].recovery_runs = kRecoveryRuns;
  recovering_ = true;
  sound_ = false;
  nodes_[node].recovery_from = static_cast<uint64_t>(queue_.now() / bit_time_) + 1;
  schedule_recovery(node);
}

// A frame begins: the recessive bits up to here are counted, those of the frame hold no run of 11.
void CanLine::pause_recovery(uint32_t segment, uint64_t bit) {
  if (!recovering_) return;
  for (Node& node : nodes_) {
    if (node.recovery_runs == 0 || node.segment != segment) continue;
    queue_.cancel(std::exchange(node.recovery, kNoEvent));
    const uint64_t from = std::max(segments_[segment].recessive_from, node.recovery_from);
    if (bit <= from) continue;
    // The last run is left to the event, which is where the node comes back.
    const uint64_t runs = std::min<uint64_t>((bit - from) / kRecoveryBits, node.recovery_runs - 1);
    node.recovery_runs -= static_cast<uint32_t>(runs);
  }
}

void CanLine::schedule_recovery(NodeId id) {
  Node& node = nodes_[id];
  const Segment& segment = segments_[node.segment];
  if (node.recovery_runs == 0 || node.recovery != kNoEvent || segment.busy() || stuck_ > 0) return;
  const uint64_t from = std::max(segment.recessive_from, node.recovery_from);
  const uint64_t done = from + uint64_t{node.recovery_runs} * kRecoveryBits;
  node.recovery =
      queue_.schedule(static_cast<Time>(done) * bit_time_, source_, *this, line_event::kRecovered, id);
}

void CanLine::finish_recovery(Time now, NodeId node) {
  nodes_[node].recovery = kNoEvent;
  nodes_[node].recovery_runs = 0;
  nodes_[node].counters = {};
  report({LineEventKind::Recovered, now, node});
}

void CanLine::replace(NodeId node, CanNode& by) {
  wake();
  nodes_[node].node = &by;
}

}  // namespace ipos::runtime
