// Joins a simulated PROFIBUS line to a real serial port, frame by frame: a station on the line that passes on to the
// port what the simulated stations send, and sends on the line what comes from the port. Nothing goes back where it
// came from.
//
// A frame from outside is put on the line when its last octet has come, and takes its time there once more; so an answer
// comes later than the standard's max Tsdr by the request's length (ours). Adapters that hear themselves are not
// known here.
#pragma once

#include <deque>
#include <string>

#include "runtime/bus/profibus/line.hpp"
#include "runtime/os_port/byte_bridge.hpp"

namespace ipos::runtime {

class ProfibusBridge final : public ByteBridge, private profibus::Node, private EventTarget {
 public:
  // Attaches itself to the line, under the port's name. `source` orders its events. Line and port must outlive it.
  ProfibusBridge(EventQueue& queue, uint32_t source, profibus::Line& line, BytePort& port);
  ~ProfibusBridge() override { queue_.cancel_all(*this); }
  ProfibusBridge(const ProfibusBridge&) = delete;
  ProfibusBridge& operator=(const ProfibusBridge&) = delete;

  std::string_view goods() const override { return "octets"; }
  size_t waiting() const override { return arrivals_.size(); }

 private:
  void on_event(Time now, uint32_t kind, uint64_t argument) override;
  void on_reception(Time now, const profibus::Reception& reception) override;
  void on_sent(Time now) override;

  bool has_room() const override;
  void arrive(const ByteArrival& byte) override;
  std::string crowded() const override;
  void begin_first();

  EventQueue& queue_;
  uint32_t source_;
  profibus::Line& line_;
  NodeId node_;
  Time character_;
  profibus::FdlReceiver receiver_{profibus::kPortLimits};
  struct Arrival {
    Time at;  // of the last octet, virtual
    profibus::Octets octets;
  };
  std::deque<Arrival> arrivals_;  // the first one is on the line or waits for it
};

}  // namespace ipos::runtime
