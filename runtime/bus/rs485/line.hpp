// An RS-485 line, half duplex, bit by bit: characters of 9.6 and 57.6 kbaud, collisions, echo, faults and
// load (1053 1610 p. 26-27).
//
// A transmission begins at the first tick that does not lie before send(). A station hears a character at the
// end of its stop bit; the sender is told at the same moment, before the receivers. Observers hear the line
// at its own rate, after the stations.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "runtime/bus/line/line_load.hpp"
#include "runtime/bus/rs485/levels.hpp"
#include "runtime/bus/rs485/node.hpp"
#include "runtime/clock/event_queue.hpp"

namespace ipos::runtime {

bool is_serial_baud_rate(uint32_t baud);

class Rs485Line final : private EventTarget {
 public:
  // `source` orders the line's events among those of equal time. `baud` must be one of kSerialBaudRates.
  Rs485Line(EventQueue& queue, uint32_t source, std::string name, uint32_t baud);

  // All stations are attached before the first event runs. One of another rate takes part, but what it says
  // is garbage to the others and the reverse; the observers hear why.
  NodeId attach(std::string name, uint32_t baud, SerialNode& node);
  void add_observer(SerialObserver& observer);
  void set_faults(SerialFaults* faults) { faults_ = faults; }
  void add_fault(const OctetFault& fault);
  // Telegrams that begin from now on are not struck any more, and what lasts ends; false: there is no such fault.
  bool end_fault(OctetFaultKind kind, NodeId sender);

  bool send(NodeId node, std::span<const uint8_t> bytes);
  bool send_bits(NodeId node, std::vector<bool> bits);  // also characters with errors
  void break_off(NodeId node);

  void set_baud(NodeId node, uint32_t baud);        // what it sends now keeps its rate
  void set_connected(NodeId node, bool connected);  // a cut ends a transmission at once
  void set_echo(NodeId node, bool echo);            // the station hears itself

  // What the station will hear after now if nobody begins to send or falls silent meanwhile.
  std::vector<Character> upcoming(NodeId node) const;

  const std::string& name() const { return name_; }
  uint32_t baud() const { return baud_; }
  size_t node_count() const { return nodes_.size(); }
  const std::string& node_name(NodeId node) const { return nodes_[node].name; }
  uint32_t node_baud(NodeId node) const { return nodes_[node].baud; }  // as it is set, whatever fault it has
  LineLoad load(
      Time now) const;  // frames: characters an observer heard; the busy time of ended transmissions

 private:
  // A receiver looks for a start bit from tick `from` on, or has found one at `start`.
  struct Receiver {
    Ear ear;
    Tick from = 0;
    std::optional<Tick> start;
    EventId event = kNoEvent;
  };
  struct Node : Receiver {
    std::string name;
    SerialNode* node;
    uint32_t baud = 0;        // as it is set
    bool wrong_rate = false;  // by a planted fault
    bool connected = true;
    EventId sent = kNoEvent;  // of the transmission under way
  };

  enum Event : uint32_t { kSent, kCharacter, kFaultBegins, kFaultEnds };

  void on_event(Time now, uint32_t kind, uint64_t argument) override;
  Receiver& receiver(size_t number) { return number == kObservers ? observer_ear_ : nodes_[number]; }
  bool listens(size_t number) const { return number == kObservers || nodes_[number].connected; }
  void look_for_start(size_t number, Tick until);
  void look_again();
  void restart_receiver(NodeId node);
  void switch_fault(Time now, const OctetFault& fault, bool on);
  void take_rate(NodeId node);
  void end_character(size_t number);
  void end_transmission(Transmission& transmission);
  Transmission* sending(NodeId node);
  void shorten(NodeId node, Tick end);
  bool can_send(NodeId node) const { return nodes_[node].connected && nodes_[node].sent == kNoEvent; }
  void forget_old();
  Tick last_end() const;
  void report(const SerialEvent& event, SerialObserver* only = nullptr);
  void report_absence(NodeId node, SerialObserver* only);

  static constexpr size_t kObservers = ~size_t{0};  // number of the observers' receiver

  EventQueue& queue_;
  uint32_t source_;
  std::string name_;
  uint32_t baud_;
  std::vector<Node> nodes_;
  Receiver observer_ear_;
  std::vector<SerialObserver*> observers_;
  SerialFaults* faults_ = nullptr;
  OctetFaults planted_;
  std::vector<Transmission> transmissions_;  // under way, and ended but still part of a character
  std::vector<std::vector<bool>> spare_;     // the memory of bits of those that are forgotten
  uint64_t characters_ = 0;
  Tick counted_until_ = 0;
  LoadMeter meter_{kTicksPerSecond};
};

// The sending half of an attached station.
class SerialLinePort final : public SerialSender {
 public:
  SerialLinePort(Rs485Line& line, NodeId node) : line_(&line), node_(node) {}
  bool send(std::span<const uint8_t> bytes) override { return line_->send(node_, bytes); }
  void break_off() override { line_->break_off(node_); }
  NodeId node() const { return node_; }

 private:
  Rs485Line* line_;
  NodeId node_;
};

// One line of text for the user, with names and baud rates.
std::string describe(const Rs485Line& line, const SerialEvent& event);

}  // namespace ipos::runtime
