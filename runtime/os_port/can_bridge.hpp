// Joins a simulated CAN line to a real bus: a node on the line that sends on to the port what the simulated
// stations send, and puts on the line what comes from the port, in order and at its time. Nothing goes back
// where it came from.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "runtime/bus/can/line.hpp"
#include "runtime/os_port/bridge.hpp"
#include "runtime/os_port/can_port.hpp"

namespace ipos::runtime {

class CanBridge final : public Bridge, private CanNode, private EventTarget {
 public:
  // Attaches itself to the line, under the port's name. `source` orders its events. Line and port must
  // outlive it.
  CanBridge(EventQueue& queue, uint32_t source, CanLine& line, CanPort& port);
  CanBridge(const CanBridge&) = delete;
  CanBridge& operator=(const CanBridge&) = delete;

  PortNeeds needs() const override;
  bool collect(Time epoch) override;
  bool flush() override;

  const CanPort& port() const override { return port_; }
  std::string_view goods() const override { return "frames"; }
  const CanLine& line() const { return line_; }
  const BridgeCounts& counts() const override { return counts_; }
  size_t waiting() const override { return arrivals_.size(); }
  std::vector<std::string> take_notes() override;
  std::vector<std::string> repeats() const override;

 private:
  struct Arrival {
    Time at;  // virtual
    Frame frame;
  };

  void on_event(Time now, uint32_t kind, uint64_t argument) override;
  void on_frame(Time now, const Frame& frame) override;
  void on_sent(Time now, const Frame& frame, uint64_t tag) override;
  void on_not_sent(Time now, const Frame& frame, uint64_t tag, NotSent reason) override;

  void arrive(Time at, const Frame& frame);
  void offer();
  void finish_first();
  bool has_room() const;
  bool gone(const PortError& error);

  EventQueue& queue_;
  uint32_t source_;
  CanLine& line_;
  CanPort& port_;
  LinePort sender_;
  std::deque<Arrival> arrivals_;  // the first one is on the line or waits for its time
  bool on_line_ = false;
  BridgeCounts counts_;
  PortNotes notes_;
};

}  // namespace ipos::runtime
