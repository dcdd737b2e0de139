// The line as a machine of one event: a frame ends.
#include "runtime/bus/profibus/line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <utility>

namespace ipos::profibus {

Line::Line(runtime::EventQueue& queue, uint32_t source, std::string name, uint32_t baud)
    : queue_(queue), source_(source), name_(std::move(name)), baud_(baud), meter_(baud) {
  assert(find_baud_rate(baud) != nullptr);
}

NodeId Line::attach(std::string name, Node& node) {
  nodes_.push_back({std::move(name), &node, baud_});
  return static_cast<NodeId>(nodes_.size() - 1);
}

namespace {
enum : uint32_t { kFrameEnds, kFaultBegins, kFaultEnds };
}  // namespace

void Line::add_fault(const OctetFault& fault) {
  const size_t number = faults_.add(fault);
  if (octet_fault_type(fault.kind).scope == OctetFaultScope::Frame) return;  // strikes by itself
  queue_.schedule(std::max(fault.from, queue_.now()), source_, *this, kFaultBegins, number);
  if (fault.until != runtime::kNever) queue_.schedule(fault.until, source_, *this, kFaultEnds, number);
}

bool Line::end_fault(OctetFaultKind kind, NodeId sender) {
  const Time now = queue_.now();
  if (!faults_.end(kind, sender, now)) return false;
  if (octet_fault_type(kind).scope == OctetFaultScope::Station) switch_fault(now, {kind, 0, now, sender}, false);
  return true;
}

void Line::switch_fault(Time now, const OctetFault& fault, bool on) {
  if (!on && faults_.lasts(fault.kind, fault.sender, now)) return;  // another one goes on
  if (on) report({LineEventKind::Fault, now, fault.sender, fault.kind});
  Station& station = nodes_[fault.sender];
  if (fault.kind == OctetFaultKind::Swap) station.swapped = on;
  if (fault.kind == OctetFaultKind::Baud) station.wrong_rate = on;
  station.node->on_fault(now, fault.kind, on);
}

bool Line::send(NodeId node, Bits begin, Octets octets) {
  assert(node < nodes_.size());
  Station& station = nodes_[node];
  if (!station.connected || station.sending || station.baud != baud_ || octets.empty()) return false;
  begin = std::max(begin, now());
  const Bits end = begin + kCharacterBits * octets.size();
  Transmission transmission{node, begin, end, kSynBits, {std::move(octets), {}}};
  if (const auto struck = faults_.strike(at(begin), node)) {
    damage(struck->kind, transmission.frame, *struck->chance);
    report({LineEventKind::Struck, queue_.now(), node, struck->kind});
  }
  for (Transmission& other : under_way_) {
    if (!other.overlaps(transmission) || !other.audible() || !transmission.audible()) continue;
    other.collided = transmission.collided = true;
    report({LineEventKind::Collision, queue_.now(), node});
  }
  station.sending = true;
  queue_.schedule(at(transmission.end), source_, *this, kFrameEnds, node);
  under_way_.push_back(std::move(transmission));
  return true;
}

bool Line::is_busy() const {
  const Bits bit = now();
  return std::any_of(under_way_.begin(), under_way_.end(),
                     [bit](const Transmission& t) { return t.audible() && t.begin < bit; });
}

void Line::set_connected(NodeId node, bool connected) {
  if (nodes_[node].connected == connected) return;
  nodes_[node].connected = connected;
  if (connected) return;
  report({LineEventKind::NotConnected, queue_.now(), node});
  for (Transmission& transmission : under_way_)  // what it was saying breaks off
    if (transmission.sender == node) transmission.frame.octets.clear();
}

// Frames that collided end in garbage; before the first frame of all the line was idle for long.
Reception Line::reception_of(const Transmission& transmission) const {
  const WireFrame& frame = transmission.frame;
  Reception reception{tl::unexpected(FrameError::Parity), frame.octets, at(transmission.begin),
                      at(transmission.end)};
  if (transmission.collided) return reception;
  if (nodes_[transmission.sender].garbles()) {
    reception.frame = tl::unexpected(FrameError::Framing);
    return reception;
  }
  if (frame.damage) {
    reception.frame = tl::unexpected(*frame.damage);
    return reception;
  }
  reception.frame = decode(frame.octets);
  if (!reception.frame && reception.frame.error() == FrameError::Size)
    reception.frame = tl::unexpected(FrameError::Gap);  // cut short
  if (reception.frame && reception.frame->needs_idle() && transmission.idle < kSynBits)
    reception.frame = tl::unexpected(FrameError::Idle);
  return reception;
}

// Frames overlap only in collisions; then the time counts once, up to here also that of those that go on.
void Line::count(const Transmission& transmission) {
  Bits begin = transmission.begin;
  for (const Transmission& other : under_way_) begin = std::min(begin, other.begin);
  begin = std::max(begin, counted_until_);
  if (transmission.end <= begin) return;
  meter_.add(begin, transmission.end - begin);
  counted_until_ = transmission.end;
}

// A station does not hear what goes on while it sends itself.
bool Line::talks_over(NodeId node, const Transmission& transmission) const {
  return std::any_of(under_way_.begin(), under_way_.end(), [&](const Transmission& other) {
    return other.sender == node && other.overlaps(transmission);
  });
}

void Line::on_event(Time now, uint32_t kind, uint64_t argument) {
  if (kind == kFrameEnds) return end_transmission(now, static_cast<NodeId>(argument));
  switch_fault(now, faults_[static_cast<size_t>(argument)], kind == kFaultBegins);
}

void Line::end_transmission(Time now, NodeId who) {
  const auto ended = std::find_if(under_way_.begin(), under_way_.end(),
                                  [who](const Transmission& t) { return t.sender == who; });
  assert(ended != under_way_.end());
  Transmission transmission = std::move(*ended);
  under_way_.erase(ended);
  count(transmission);
  Station& sender = nodes_[transmission.sender];
  sender.sending = false;
  if (heard_) transmission.idle = transmission.begin - std::min(transmission.begin, quiet_since_);
  if (transmission.audible()) {
    heard_ = true;
    quiet_since_ = std::max(quiet_since_, transmission.end);
  }
  sender.node->on_sent(now);
  if (!transmission.audible()) return;
  const Reception reception = reception_of(transmission);
  frames_ += reception.frame.has_value();
  for (NodeId node = 0; node < nodes_.size(); ++node) {
    const Station& station = nodes_[node];
    if (node == transmission.sender || !station.connected || talks_over(node, transmission)) continue;
    if (station.baud == baud_ && !station.garbles()) {
      station.node->on_reception(now, reception);
    } else {
      Reception garbage = reception;
      garbage.frame = tl::unexpected(FrameError::Framing);
      station.node->on_reception(now, garbage);
    }
  }
  for (LineObserver* observer : observers_) observer->on_frame(*this, transmission.sender, reception);
}

void Line::report(const LineEvent& event) {
  for (LineObserver* observer : observers_) observer->on_line_event(*this, event);
}

runtime::LineLoad Line::load(Time now) const {
  runtime::LineLoad load = meter_.load(bit_from(now + 1, baud_) - 1);
  load.frames = frames_;
  return load;
}

std::string describe(const Line& line, const LineEvent& event) {
  static constexpr std::string_view kTexts[] = {
#define DP_LINE_EVENT(name, text) text,
#include "runtime/bus/profibus/line_events.def"
  };
  std::string text = fmt::format("{}: {} {}", line.name(), line.node_name(event.node),
                                 kTexts[static_cast<size_t>(event.kind)]);
  if (event.kind == LineEventKind::Fault)
    return fmt::format("{}: {} {}", line.name(), line.node_name(event.node), octet_fault_type(*event.fault).text);
  if (event.fault) text += fmt::format(": the line {}", octet_fault_type(*event.fault).text);
  return text;
}

}  // namespace ipos::profibus
