// One occupation of a CAN line, from start of frame to the end of intermission, and how it ends. resolve() is
// the one place where that is decided; faults of the line belong there.
#pragma once

#include <cstdint>
#include <vector>

#include "runtime/bus/can/frame.hpp"
#include "runtime/bus/can/node.hpp"

namespace ipos::runtime {

struct Transfer {
  enum class Outcome : uint8_t { Delivered, NoAcknowledge, Collision };
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

  const Sender& winner() const;  // the first sender whose frame the line carries
};

struct Listeners {
  bool any = false;           // somebody acknowledges
  bool error_active = false;  // somebody sends an active error flag
};

// Fills outcome, lengths and losers from the senders.
void resolve(Transfer& transfer, Listeners listeners);

}  // namespace ipos::runtime
