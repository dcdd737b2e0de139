// Real time driven by hand: a clock that jumps to where it is waited for, and CAN ports whose frames come by
// a script.
#pragma once

#include <algorithm>
#include <deque>
#include <functional>
#include <vector>

#include "runtime/os_port/can_bridge.hpp"

namespace ipos::tests {

using namespace ipos::runtime;  // NOLINT: a test header, everything here is about the runtime

class ManualClock final : public RealClock {
 public:
  explicit ManualClock(Time start = 1'000 * kSecond) : now_(start) {}
  Time now() override { return now_; }
  Time wall() override { return now_ + 5 * kSecond; }
  void wait(Time until, std::span<const PortNeeds> ports) override {
    for (const PortNeeds& port : ports) until = std::min(until, port.wake);
    now_ = std::max(now_ + 1, until) + (oversleep ? oversleep() : 0);
    ++waits;
  }
  void advance(Time by) { now_ += by; }

  std::function<Time()> oversleep;  // how much too late a wait ends
  int waits = 0;

 private:
  Time now_;
};

inline Frame frame(uint32_t id, uint8_t value = 0) {
  Frame made;
  made.id = id;
  made.length = 1;
  made.data[0] = value;
  return made;
}

// A bus in memory: `incoming` are put in by the test, in order of time; `outgoing` is what was sent to it.
class LoopbackPort final : public CanPort {
 public:
  explicit LoopbackPort(RealClock& clock) : clock_(clock) {}

  const std::string& name() const override { return name_; }
  // A real port wakes the loop when something comes: here at the time of the next arrival.
  PortNeeds needs() const override { return {-1, false, incoming.empty() ? kNever : incoming.front().at}; }
  tl::expected<void, PortError> flush() override { return {}; }
  size_t waiting() const override { return 0; }
  const PortCounts& counts() const override { return counts_; }
  std::vector<std::string> take_notes() override { return {}; }

  void send(const Frame& sent) override {
    outgoing.push_back({clock_.now(), std::nullopt, std::nullopt, sent});
  }

  tl::expected<std::optional<CanArrival>, PortError> receive() override {
    if (clock_.now() >= gone_at) return tl::unexpected(port_error(PortFault::Gone, name_));
    if (incoming.empty() || incoming.front().at > clock_.now()) return std::nullopt;
    CanArrival arrival = incoming.front();
    incoming.pop_front();
    return arrival;
  }

  std::deque<CanArrival> incoming;
  std::vector<CanArrival> outgoing;
  Time gone_at = kNever;

 private:
  RealClock& clock_;
  std::string name_ = "loop";
  PortCounts counts_;
};

// A simulated station.
class Node final : public CanNode {
 public:
  Node(CanLine& line, std::string name) : port(line, line.attach(std::move(name), line.baud(), *this)) {}
  void on_frame(Time now, const Frame& got) override {
    frames.push_back(got);
    times.push_back(now);
  }
  void on_sent(Time, const Frame&, uint64_t) override { ++sent; }
  void on_not_sent(Time, const Frame&, uint64_t, NotSent) override { ++not_sent; }

  std::vector<Frame> frames;
  std::vector<Time> times;
  int sent = 0;
  int not_sent = 0;
  LinePort port;
};

// Something that happens every millisecond.
class Ticker final : public EventTarget {
 public:
  Ticker(EventQueue& queue, uint32_t source) : queue_(queue), source_(source) {
    queue.schedule(0, source, *this, 0);
  }
  void on_event(Time now, uint32_t, uint64_t) override {
    ++ticks;
    if (action) action(now);
    queue_.schedule(now + kMillisecond, source_, *this, 0);
  }
  int ticks = 0;
  std::function<void(Time)> action;

 private:
  EventQueue& queue_;
  uint32_t source_;
};

class QueueSimulation final : public Simulation {
 public:
  explicit QueueSimulation(EventQueue& queue) : queue_(queue) {}
  Time now() const override { return queue_.now(); }
  Time next_time() const override { return queue_.next_time(); }
  bool run_until(Time end) override {
    queue_.run_until(end);
    return queue_.now() < stop_at;
  }
  Time stop_at = kNever;

 private:
  EventQueue& queue_;
};

}  // namespace ipos::tests
