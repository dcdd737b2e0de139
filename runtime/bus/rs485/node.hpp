// What an RS-485 line and its participants say to each other: stations send and receive characters, observers
// only look.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "runtime/bus/line/node_id.hpp"
#include "runtime/bus/rs485/character.hpp"
#include "runtime/bus/rs485/octet_fault.hpp"

namespace ipos::runtime {

class Rs485Line;

// A participant. Calls come in virtual time order and may send.
class SerialNode {
 public:
  virtual void on_character(Time now, const Character& character) = 0;
  virtual void on_sent(Time now) = 0;  // the last stop bit has ended

 protected:
  ~SerialNode() = default;
};

// The sending half of a participant.
class SerialSender {
 public:
  // Begins at the next tick. False: not connected, still sending, or nothing to send.
  virtual bool send(std::span<const uint8_t> bytes) = 0;

  // Ends the transmission after the character that is on the wire; on_sent() does not come.
  virtual void break_off() = 0;

 protected:
  ~SerialSender() = default;
};

enum class SerialEventKind : uint8_t {
#define SERIAL_EVENT(name, text) name,
#include "runtime/bus/rs485/line_events.def"
};

struct SerialEvent {
  SerialEventKind kind;
  Time time;
  NodeId node;
  NodeId other = kNoNode;  // the partner of a collision
  std::optional<OctetFaultKind> fault = std::nullopt;  // of Struck and Fault
};

// `sender` is kNoNode when several stations sent during the character.
class SerialObserver {
 public:
  virtual void on_character(const Rs485Line& line, NodeId sender, const Character& character) = 0;
  virtual void on_serial_event(const Rs485Line& line, const SerialEvent& event) = 0;

 protected:
  ~SerialObserver() = default;
};

// Disturbs transmissions before they go on the wire: flipped, missing and added bits. Bit 11 n + k is bit k
// of character n: 0 start, 1..8 data, 9 parity, 10 stop; an added 1 is a bit of pause.
class SerialFaults {
 public:
  virtual void disturb(NodeId sender, std::vector<bool>& bits) = 0;

 protected:
  ~SerialFaults() = default;
};

}  // namespace ipos::runtime
