// Frames out of octets, one after the other onto the line.
#include "runtime/os_port/profibus_bridge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace ipos::runtime {
namespace {

constexpr size_t kMostDpFrames = 64;  // from the port; the rest waits in the system (ours)

}  // namespace

ProfibusBridge::ProfibusBridge(EventQueue& queue, uint32_t source, profibus::Line& line, BytePort& port)
    : ByteBridge(port),
      queue_(queue),
      source_(source),
      line_(line),
      node_(line.attach(port.name(), *this)),
      character_(static_cast<Time>(profibus::kCharacterBits) * kSecond / line.baud()) {}

std::string ProfibusBridge::crowded() const {
  return fmt::format("frames wait for the simulated line: they come faster than its {} baud", line_.baud());
}

bool ProfibusBridge::has_room() const { return arrivals_.size() < kMostDpFrames; }

void ProfibusBridge::arrive(const ByteArrival& byte) {
  Character character;
  character.start = byte.at - character_;
  character.end = byte.at;
  character.data = byte.value;
  character.parity_error = byte.bad;
  for (profibus::Reception& reception : receiver_.take(character)) {
    if (!reception.frame) {
      notes().count(fmt::format("{}: what came is no frame: {}", port().name(),
                                profibus::frame_error_text(reception.frame.error())));
      continue;
    }
    arrivals_.push_back({reception.end, std::move(reception.octets)});
    if (arrivals_.size() == 1) begin_first();
  }
}

// Not before it has come: a host that was late would put it into the past, and a slave's watchdog would count from there.
void ProfibusBridge::begin_first() {
  queue_.schedule(std::max(queue_.now(), arrivals_.front().at), source_, *this, 0);
}

// After what goes on on the line, with the idle time that a request wants; an answer to the frame before begins within
// it.
void ProfibusBridge::on_event(Time now, uint32_t, uint64_t) {
  const Time idle = line_.at(line_.quiet_since() + profibus::kSynBits);
  if (line_.is_busy() || now < idle) {
    queue_.schedule(std::max(idle, line_.at(line_.now() + profibus::kSynBits)), source_, *this, 0);
    return;
  }
  if (line_.send(node_, line_.now(), arrivals_.front().octets)) return;
  ++counts().undelivered;
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
    notes().note(fmt::format("{}: disturbed frames of the simulated line are not passed on", port().name()));
    return;
  }
  port().send(reception.octets);
}

}  // namespace ipos::runtime
