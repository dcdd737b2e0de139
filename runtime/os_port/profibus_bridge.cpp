// Frames out of octets, one after the other onto the line.
#include "runtime/os_port/profibus_bridge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace ipos::runtime {
namespace {

constexpr size_t kMostDpFrames = 64;  // from the port; the rest waits in the system (ours)

}  // namespace

ProfibusBridge::ProfibusBridge(EventQueue& queue, uint32_t source, profibus::Line& line, BytePort& port)
    : queue_(queue),
      source_(source),
      line_(line),
      port_(port),
      node_(line.attach(port.name(), *this)),
      character_(static_cast<Time>(profibus::kCharacterBits) * kSecond / line.baud()) {}

bool ProfibusBridge::has_room() const { return arrivals_.size() < kMostDpFrames; }

PortNeeds ProfibusBridge::needs() const {
  PortNeeds needs = port_.needs();
  if (!has_room()) needs.descriptor = -1;  // what cannot be taken must not wake the loop
  return needs;
}

bool ProfibusBridge::gone(const PortError& error) {
  notes_.note(error.text);
  return false;
}

bool ProfibusBridge::collect(Time epoch) {
  std::array<ByteArrival, 256> bytes;
  while (has_room()) {
    const auto count = port_.receive(bytes);
    if (!count) return gone(count.error());
    if (*count == 0) return true;
    for (ByteArrival& byte : std::span(bytes).first(*count)) {
      byte.at -= epoch;
      arrive(byte);
    }
  }
  notes_.note(fmt::format("{}: frames wait for the simulated line: they come faster than its {} baud",
                          port_.name(), line_.baud()));
  return true;
}

bool ProfibusBridge::flush() {
  const auto flushed = port_.flush();
  return flushed ? true : gone(flushed.error());
}

void ProfibusBridge::arrive(const ByteArrival& byte) {
  Character character;
  character.start = byte.at - character_;
  character.end = byte.at;
  character.data = byte.value;
  character.parity_error = byte.bad;
  for (profibus::Reception& reception : receiver_.take(character)) {
    if (!reception.frame) {
      notes_.count(fmt::format("{}: what came is no frame: {}", port_.name(),
                               profibus::frame_error_text(reception.frame.error())));
      continue;
    }
    arrivals_.push_back(std::move(reception.octets));
    if (arrivals_.size() == 1) begin_first();
  }
}

void ProfibusBridge::begin_first() { queue_.schedule(queue_.now(), source_, *this, 0); }

// Behind what goes on on the line, with the idle time that a request wants.
void ProfibusBridge::on_event(Time now, uint32_t, uint64_t) {
  if (line_.is_busy()) {
    queue_.schedule(line_.at(line_.now() + profibus::kSynBits), source_, *this, 0);
    return;
  }
  if (line_.send(node_, line_.quiet_since() + profibus::kSynBits, arrivals_.front())) return;
  ++counts_.undelivered;
  on_sent(now);
}

void ProfibusBridge::on_sent(Time) {
  arrivals_.pop_front();
  if (!arrivals_.empty()) begin_first();
}

// A port cannot send a character with an error: such a frame is left out, and void outside, too.
void ProfibusBridge::on_reception(Time, const profibus::Reception& reception) {
  using profibus::FrameError;
  if (!reception.frame &&
      (reception.frame.error() == FrameError::Parity || reception.frame.error() == FrameError::Framing)) {
    notes_.note(fmt::format("{}: disturbed frames of the simulated line are not passed on", port_.name()));
    return;
  }
  port_.send(reception.octets);
}

std::vector<std::string> ProfibusBridge::repeats() const {
  std::vector<std::string> all = notes_.repeats();
  for (std::string& text : port_.repeats()) all.push_back(std::move(text));
  return all;
}

std::vector<std::string> ProfibusBridge::take_notes() {
  std::vector<std::string> all = notes_.take();
  for (std::string& text : port_.take_notes()) all.push_back(fmt::format("{}: {}", port_.name(), text));
  return all;
}

}  // namespace ipos::runtime
