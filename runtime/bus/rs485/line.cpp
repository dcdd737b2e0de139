// The line as a machine of two events: a character ends at a receiver, and a transmission ends at its sender.
#include "runtime/bus/rs485/line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <utility>

#include "runtime/bus/rs485/bit_fault.hpp"

namespace ipos::runtime {
namespace {

// Longest time for which a receiver may still look at an ended transmission: a character of the slow rate.
constexpr Tick kMemory = 2 * kCharacterBits * ticks_per_bit(kSerialBaudRates[0]);
// Memory of bits that is kept for the next telegrams. Who sends bits of its own, as a real port does, brings more than is used.
constexpr size_t kMostSpare = 16;

}  // namespace

bool is_serial_baud_rate(uint32_t baud) {
  return std::find(kSerialBaudRates.begin(), kSerialBaudRates.end(), baud) != kSerialBaudRates.end();
}

Rs485Line::Rs485Line(EventQueue& queue, uint32_t source, std::string name, uint32_t baud)
    : queue_(queue), source_(source), name_(std::move(name)), baud_(baud) {
  assert(is_serial_baud_rate(baud));
  observer_ear_.ear.bit_ticks = ticks_per_bit(baud);
}

NodeId Rs485Line::attach(std::string name, uint32_t baud, SerialNode& node) {
  const NodeId id = static_cast<NodeId>(nodes_.size());
  Node& added = nodes_.emplace_back();
  added.ear = {ticks_per_bit(baud), id};
  added.baud = baud;
  added.name = std::move(name);
  added.node = &node;
  report_absence(id, nullptr);
  return id;
}

void Rs485Line::add_observer(SerialObserver& observer) {
  observers_.push_back(&observer);
  for (NodeId node = 0; node < nodes_.size(); ++node) report_absence(node, &observer);
}

// --- sending

Transmission* Rs485Line::sending(NodeId node) {
  if (nodes_[node].sent == kNoEvent) return nullptr;
  const auto found = std::find_if(transmissions_.rbegin(), transmissions_.rend(),
                                  [node](const Transmission& t) { return t.sender == node; });
  assert(found != transmissions_.rend());  // one under way is not forgotten
  return &*found;
}

bool Rs485Line::send(NodeId node, std::span<const uint8_t> bytes) {
  if (!can_send(node) || bytes.empty()) return false;
  forget_old();
  std::vector<bool> memory;
  if (!spare_.empty()) {
    memory = std::move(spare_.back());
    spare_.pop_back();
  }
  return send_bits(node, wire_bits(bytes, std::move(memory)));
}

bool Rs485Line::send_bits(NodeId node, std::vector<bool> bits) {
  assert(node < nodes_.size());
  Node& n = nodes_[node];
  if (!can_send(node) || bits.empty()) return false;
  forget_old();
  Transmission transmission{node, tick_from(queue_.now()), n.ear.bit_ticks, std::move(bits)};
  if (n.ear.swapped) transmission.bits.flip();
  if (faults_ != nullptr) faults_->disturb(node, transmission.bits);
  if (const auto struck = planted_.strike(queue_.now(), node)) {
    damage(struck->kind, transmission.bits, *struck->chance);
    report({SerialEventKind::Struck, queue_.now(), node, kNoNode, struck->kind});
  }
  for (const Transmission& other : transmissions_)
    if (other.sender != node && other.end() > transmission.begin)
      report({SerialEventKind::Collision, queue_.now(), node, other.sender});
  n.sent = queue_.schedule(time_of(transmission.end()), source_, *this, kSent, node);
  transmissions_.push_back(std::move(transmission));
  look_again();
  return true;
}

void Rs485Line::break_off(NodeId node) {
  const Transmission* transmission = sending(node);
  if (transmission == nullptr) return;
  const Tick character = Tick{kCharacterBits} * transmission->bit_ticks;
  const Tick now = std::max(tick_from(queue_.now()), transmission->begin);
  shorten(node, transmission->begin + (now - transmission->begin + character - 1) / character * character);
}

// The sender falls silent at `end`, without word to its station.
void Rs485Line::shorten(NodeId node, Tick end) {
  Transmission* transmission = sending(node);
  if (transmission == nullptr) return;
  const Tick bits = (std::max(end, transmission->begin) - transmission->begin) / transmission->bit_ticks;
  transmission->bits.resize(static_cast<size_t>(std::min<Tick>(bits, transmission->bits.size())));
  queue_.cancel(std::exchange(nodes_[node].sent, kNoEvent));
  end_transmission(*transmission);
  look_again();
}

// Transmissions overlap only while stations collide; then the time counts once, up to here also that of those that go
// on.
void Rs485Line::end_transmission(Transmission& transmission) {
  Tick begin = transmission.begin;
  for (const Transmission& other : transmissions_)
    if (other.end() >= transmission.end()) begin = std::min(begin, other.begin);
  begin = std::max(begin, counted_until_);
  if (transmission.end() <= begin) return;
  meter_.add(begin, transmission.end() - begin);
  counted_until_ = transmission.end();
}

void Rs485Line::forget_old() {
  const Tick now = tick_from(queue_.now());
  std::erase_if(transmissions_, [&](Transmission& t) {
    if (t.end() + kMemory >= now) return false;
    if (spare_.size() < kMostSpare) spare_.push_back(std::move(t.bits));
    return true;
  });
}

Tick Rs485Line::last_end() const {
  Tick end = 0;
  for (const Transmission& transmission : transmissions_) end = std::max(end, transmission.end());
  return end;
}

// --- receiving

// Finds the next start bit among what is on the wire already. A start bit in the future may still be
// overtaken by an earlier one of another station: look_again().
void Rs485Line::look_for_start(size_t number, Tick until) {
  Receiver& r = receiver(number);
  queue_.cancel(std::exchange(r.event, kNoEvent));
  r.start = listens(number) ? next_start(transmissions_, r.ear, r.from, until) : std::nullopt;
  if (!r.start) return;
  r.event = queue_.schedule(time_of(*r.start + character_ticks(r.ear)), source_, *this, kCharacter, number);
}

void Rs485Line::look_again() {
  const Tick until = last_end();
  const Tick now = tick_from(queue_.now());
  const auto look = [&](size_t number) {
    Receiver& r = receiver(number);
    if (r.start && *r.start < now) return;  // in the middle of a character
    if (!r.start) r.from = std::max(r.from, now);
    look_for_start(number, until);
  };
  for (NodeId node = 0; node < nodes_.size(); ++node) look(node);
  look(kObservers);
}

void Rs485Line::end_character(size_t number) {
  Receiver& r = receiver(number);
  const Tick start = *r.start;
  const Reading reading = read_character(transmissions_, r.ear, start);
  const Tick end = start + character_ticks(r.ear);
  r.event = kNoEvent;
  r.from = reading.resume;
  look_for_start(number, last_end());
  if (!reading.character) return;
  if (number != kObservers) return nodes_[number].node->on_character(queue_.now(), *reading.character);
  ++characters_;
  NodeId sender = kNoNode;
  size_t senders = 0;
  for (const Transmission& transmission : transmissions_) {
    if (transmission.begin >= end || transmission.end() <= start) continue;
    sender = transmission.sender;
    ++senders;
  }
  if (senders != 1) sender = kNoNode;
  for (SerialObserver* observer : observers_) observer->on_character(*this, sender, *reading.character);
}

std::vector<Character> Rs485Line::upcoming(NodeId node) const {
  const Node& n = nodes_[node];
  std::vector<Character> characters;
  for (std::optional<Tick> start = n.start; start;) {
    const Reading reading = read_character(transmissions_, n.ear, *start);
    if (reading.character) characters.push_back(*reading.character);
    start = next_start(transmissions_, n.ear, reading.resume, last_end());
  }
  return characters;
}

void Rs485Line::on_event(Time now, uint32_t kind, uint64_t argument) {
  if (kind == kCharacter) return end_character(static_cast<size_t>(argument));
  if (kind != kSent) return switch_fault(now, planted_[static_cast<size_t>(argument)], kind == kFaultBegins);
  Node& node = nodes_[static_cast<size_t>(argument)];
  end_transmission(*sending(static_cast<NodeId>(argument)));
  node.sent = kNoEvent;
  node.node->on_sent(now);
}

// --- participation

// The character being received is lost. A receiver without a start bit looks for one from now on.
void Rs485Line::restart_receiver(NodeId node) {
  nodes_[node].start.reset();
  look_again();
}

void Rs485Line::set_baud(NodeId node, uint32_t baud) {
  nodes_[node].baud = baud;
  take_rate(node);
  report_absence(node, nullptr);
}

void Rs485Line::set_connected(NodeId node, bool connected) {
  nodes_[node].connected = connected;
  if (!connected) shorten(node, tick_from(queue_.now()));
  restart_receiver(node);
  report_absence(node, nullptr);
}

void Rs485Line::set_echo(NodeId node, bool echo) { nodes_[node].ear.deaf_to = echo ? kNoNode : node; }

void Rs485Line::report(const SerialEvent& event, SerialObserver* only) {
  if (only != nullptr) return only->on_serial_event(*this, event);
  for (SerialObserver* observer : observers_) observer->on_serial_event(*this, event);
}

void Rs485Line::report_absence(NodeId node, SerialObserver* only) {
  if (!nodes_[node].connected)
    report({SerialEventKind::NotConnected, queue_.now(), node}, only);
  else if (node_baud(node) != baud_)
    report({SerialEventKind::WrongBaudRate, queue_.now(), node}, only);
}

// --- load

LineLoad Rs485Line::load(Time now) const {
  LineLoad load = meter_.load(static_cast<Tick>(now / kSecond) * kTicksPerSecond +
                              static_cast<Tick>(now % kSecond * kTicksPerSecond / kSecond));
  load.frames = characters_;
  load.busy_bits /= ticks_per_bit(baud_);
  load.elapsed_bits /= ticks_per_bit(baud_);
  return load;
}

}  // namespace ipos::runtime
