// A PROFIBUS line frame by frame: integer bit times of its own rate, one event at the end of each frame, idle
// times, collisions, planted faults and load. A frame is decoded once for all who hear it.
//
// A frame begins at the bit its sender chooses, at the earliest now. At its end the sender is told first, then
// the others in order of attachment hear it, then the observers. A station that listens at another rate hears
// an error.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/bus/line/line_load.hpp"
#include "runtime/bus/line/node_id.hpp"
#include "runtime/bus/profibus/fdl_receiver.hpp"
#include "runtime/bus/profibus/line_fault.hpp"
#include "runtime/bus/profibus/timing.hpp"
#include "runtime/clock/event_queue.hpp"

namespace ipos::profibus {

class Line;

// A participant. Calls come in virtual time order and may send.
class Node {
 public:
  // A frame of another station has ended, or what is left of one.
  virtual void on_reception(Time now, const Reception& reception) = 0;
  virtual void on_sent(Time now) = 0;
  // A fault that lasts begins or ends at this station.
  virtual void on_fault(Time /*now*/, OctetFaultKind /*kind*/, bool /*on*/) {}

 protected:
  ~Node() = default;
};

enum class LineEventKind : uint8_t {
#define DP_LINE_EVENT(name, text) name,
#include "runtime/bus/profibus/line_events.def"
};

struct LineEvent {
  LineEventKind kind;
  Time time;
  NodeId node;
  std::optional<OctetFaultKind> fault = std::nullopt;  // of Struck and Fault
};

class LineObserver {
 public:
  virtual void on_frame(const Line& line, NodeId sender, const Reception& reception) = 0;
  virtual void on_line_event(const Line& line, const LineEvent& event) = 0;

 protected:
  ~LineObserver() = default;
};

class Line final : private runtime::EventTarget {
 public:
  // `source` orders the line's events among those of equal time. `baud` must be one of kBaudRates.
  Line(runtime::EventQueue& queue, uint32_t source, std::string name, uint32_t baud);
  ~Line() { queue_.cancel_all(*this); }
  Line(const Line&) = delete;
  Line& operator=(const Line&) = delete;

  NodeId attach(std::string name, Node& node);
  void add_observer(LineObserver& observer) { observers_.push_back(&observer); }
  void add_fault(const OctetFault& fault);
  // Frames that begin from now on are not struck any more, and what lasts ends; false: there is no such fault.
  bool end_fault(OctetFaultKind kind, NodeId sender);

  // Sends from bit `begin` on, or from now. False: not connected, still sending, or at another rate.
  bool send(NodeId node, Bits begin, const FdlFrame& frame) { return send(node, begin, encode(frame)); }
  bool send(NodeId node, Bits begin, Octets octets);

  void listen_at(NodeId node, uint32_t baud) { nodes_[node].baud = baud; }
  void set_connected(NodeId node, bool connected);

  // The bit that begins now, or next.
  Bits now() const { return bit_from(queue_.now(), baud_); }
  Time at(Bits bit) const { return time_of(bit, baud_); }

  // Whether a station sends now, as all the others hear; and since when nobody has.
  bool is_busy() const;
  Bits quiet_since() const { return quiet_since_; }

  const std::string& name() const { return name_; }
  uint32_t baud() const { return baud_; }
  size_t node_count() const { return nodes_.size(); }
  const std::string& node_name(NodeId node) const { return nodes_[node].name; }
  runtime::LineLoad load(Time now) const;  // frames: heard without error

 private:
  struct Station {
    std::string name;
    Node* node;
    uint32_t baud;  // at which it listens
    bool connected = true;
    bool sending = false;
    bool swapped = false;     // A and B
    bool wrong_rate = false;  // by a planted fault

    bool garbles() const { return swapped || wrong_rate; }
  };
  struct Transmission {
    NodeId sender;
    Bits begin;
    Bits end;
    Bits idle;  // before it; at the first frame of all enough
    WireFrame frame;
    bool collided = false;

    bool overlaps(const Transmission& other) const { return begin < other.end && other.begin < end; }
    bool audible() const { return !frame.octets.empty(); }
  };

  void on_event(Time now, uint32_t kind, uint64_t argument) override;
  Reception reception_of(const Transmission& transmission) const;
  bool talks_over(NodeId node, const Transmission& transmission) const;
  void end_transmission(Time now, NodeId sender);
  void switch_fault(Time now, const OctetFault& fault, bool on);
  void report(const LineEvent& event);
  void count(const Transmission& transmission);

  runtime::EventQueue& queue_;
  uint32_t source_;
  std::string name_;
  uint32_t baud_;
  std::vector<Station> nodes_;
  std::vector<LineObserver*> observers_;
  OctetFaults faults_;
  std::vector<Transmission> under_way_;  // begun or to begin; seldom more than one
  Bits quiet_since_ = 0;
  bool heard_ = false;  // anything at all
  Bits counted_until_ = 0;
  uint64_t frames_ = 0;
  runtime::LoadMeter meter_;
};

// One line of text for the user.
std::string describe(const Line& line, const LineEvent& event);

}  // namespace ipos::profibus
