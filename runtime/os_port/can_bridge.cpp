// One frame at a time is offered to the line: a node with several would send the lowest identifier first, and
// the real bus has already decided the order.
#include "runtime/os_port/can_bridge.hpp"

#include <fmt/format.h>

namespace ipos::runtime {
namespace {

enum Event : uint32_t { kArrival, kRestart };

constexpr uint64_t kTag = 1;
// From the port; the rest waits in the system, which counts losses (ours).
constexpr size_t kMostFrames = 4096;

// Recovery from bus-off: 128 times 11 recessive bits (ISO 11898-1).
constexpr Time kRecoveryBits = 128 * 11;

}  // namespace

CanBridge::CanBridge(EventQueue& queue, uint32_t source, CanLine& line, CanPort& port)
    : queue_(queue),
      source_(source),
      line_(line),
      port_(port),
      sender_(line, line.attach(port.name(), line.baud(), *this)) {}

// --- from the port

bool CanBridge::has_room() const { return arrivals_.size() < kMostFrames; }

PortNeeds CanBridge::needs() const {
  PortNeeds needs = port_.needs();
  // What we cannot take must not wake us up.
  if (!has_room()) needs.descriptor = -1;
  return needs;
}

bool CanBridge::gone(const PortError& error) {
  notes_.note(error.text);
  return false;
}

bool CanBridge::collect(Time epoch) {
  while (has_room()) {
    auto got = port_.receive();
    if (!got) return gone(got.error());
    if (!*got) return true;
    const CanArrival& arrival = **got;
    if (arrival.error)
      notes_.count(fmt::format("{}: {}", port_.name(), describe(*arrival.error)));
    else
      arrive(arrival.at - epoch, arrival.frame);
  }
  notes_.note(fmt::format("{}: {} frames wait for the simulated line: the real bus is faster than it",
                          port_.name(), kMostFrames));
  return true;
}

bool CanBridge::flush() {
  const auto flushed = port_.flush();
  return flushed ? true : gone(flushed.error());
}

void CanBridge::arrive(Time at, const Frame& frame) {
  if (at < queue_.now()) {
    ++counts_.late;
    counts_.worst_late = std::max(counts_.worst_late, queue_.now() - at);
  }
  arrivals_.push_back({at, frame});
  if (arrivals_.size() == 1) queue_.schedule(at, source_, *this, kArrival);
}

void CanBridge::on_event(Time /*now*/, uint32_t kind, uint64_t /*argument*/) {
  if (kind == kRestart) line_.restart(sender_.node());
  offer();
}

void CanBridge::offer() {
  on_line_ = sender_.send(arrivals_.front().frame, kTag) == SendStatus::Queued;
  if (on_line_) return;
  ++counts_.undelivered;
  finish_first();
}

void CanBridge::finish_first() {
  on_line_ = false;
  arrivals_.pop_front();
  if (!arrivals_.empty()) queue_.schedule(arrivals_.front().at, source_, *this, kArrival);
}

void CanBridge::on_sent(Time /*now*/, const Frame& /*frame*/, uint64_t /*tag*/) { finish_first(); }

void CanBridge::on_not_sent(Time now, const Frame& /*frame*/, uint64_t tag, NotSent reason) {
  switch (reason) {
    case NotSent::Collision:
    case NotSent::Corrupted: return;  // the line sends it again
    case NotSent::NoAcknowledge:
      // On the real bus it has been acknowledged; here is nobody to take it.
      sender_.withdraw(tag);
      ++counts_.undelivered;
      notes_.note(fmt::format("{}: frames from it reach nobody: no simulated station takes part in {}",
                              port_.name(), line_.name()));
      finish_first();
      return;
    case NotSent::Dropped:
      notes_.note(fmt::format(
          "{}: bus-off on the simulated line {}: a simulated station sends other data on the same "
          "identifier",
          port_.name(), line_.name()));
      on_line_ = false;
      queue_.schedule(now + kRecoveryBits * line_.bit_time(), source_, *this, kRestart);
      return;
  }
}

// --- to the port

void CanBridge::on_frame(Time /*now*/, const Frame& frame) { port_.send(frame); }

std::vector<std::string> CanBridge::repeats() const {
  std::vector<std::string> all = notes_.repeats();
  for (const std::string& text : port_.repeats()) all.push_back(fmt::format("{}: {}", port_.name(), text));
  return all;
}

std::vector<std::string> CanBridge::take_notes() {
  std::vector<std::string> all = notes_.take();
  for (std::string& text : port_.take_notes()) all.push_back(fmt::format("{}: {}", port_.name(), text));
  return all;
}

}  // namespace ipos::runtime
