// One occupation of a CAN line, from start of frame to the end of intermission, and how it ends. resolve() is
// the one place where that is decided, faults of the line included.
#pragma once

#include <cstdint>
#include <vector>

#include "runtime/bus/can/frame.hpp"
#include "runtime/bus/can/known_frames.hpp"
#include "runtime/bus/can/line_fault.hpp"
#include "runtime/bus/can/node.hpp"

namespace ipos::runtime {

struct Transfer {
  enum class Outcome : uint8_t {
    Delivered,
    NoAcknowledge,
    Collision,
    Corrupted,  // a disturbed bit, an error frame: nobody has it, the sender repeats it
    Repeated,   // all have it, but the sender takes it for disturbed and repeats it
    NoLevel,    // the sender sees no dominant bit: the line is short-circuited
  };
  struct Sender {
    NodeId node;
    Frame frame;  // canonical
    uint64_t tag;
    bool error_active;
    bool lost = false;  // error passive, overruled by a dominant bit: the others went on undisturbed
  };

  Outcome outcome = Outcome::Delivered;
  uint64_t start_bit = 0;
  uint32_t end = 0;             // bits from start_bit to delivery, or to the end of the error delimiter
  uint32_t bits = 0;            // bits from start_bit to the end of intermission
  std::vector<Sender> senders;  // all with the winning arbitration field
  FrameFault fault;
  bool flagged = false;       // an error-active station sends its flag: all who listen see an error frame
  // A station at another rate, or one with interchanged wires that sends, has destroyed it (clash.hpp).
  NodeId stranger = kNoNode;
  bool stranger_waits = false, others_wait = false;
  bool mute = false;  // nobody but its sender hears anything
  bool plain = false;  // one sender, somebody acknowledges, nothing is disturbed: delivered

  bool sent_by(NodeId node) const {
    for (const Sender& sender : senders)
      if (sender.node == node) return true;
    return false;
  }
  const Sender& winner() const {  // the first sender whose frame the line carries
    for (const Sender& sender : senders)
      if (!sender.lost) return sender;
    return senders.front();
  }
  bool received() const { return outcome == Outcome::Delivered || outcome == Outcome::Repeated; }
};

struct Listeners {
  bool any = false;           // somebody acknowledges
  bool error_active = false;  // somebody sends an active error flag

  // The station of a fault, when it is among them:
  bool struck = false;
  bool struck_error_active = false;
  bool others = false;  // and it is not the only one
};

// Fills outcome, lengths and losers from the senders. `short_circuit`: the line carries no dominant level.
void resolve(Transfer& transfer, Listeners listeners, KnownFrames& known, bool short_circuit = false);

}  // namespace ipos::runtime
