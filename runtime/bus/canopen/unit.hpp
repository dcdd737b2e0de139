// What a CANopen node asks of the unit behind it, beside its parameters: process data, what is wrong with it,
// and what it does when the line goes wrong.
#pragma once

#include <array>
#include <cstdint>

#include "runtime/bus/canopen/nmt.hpp"
#include "runtime/bus/canopen/object_dictionary.hpp"
#include "runtime/clock/event_queue.hpp"

namespace ipos::runtime::canopen {

using Words = std::array<uint16_t, objects::kProcessWords>;  // PO1..PO10 or PI1..PI10

struct UnitStatus {
  uint16_t status_word_1 = 0;
  bool fault = false;          // the fault bit of the status word
  bool mains_missing = false;  // only the 24 V backup supplies it
};

class Unit {
 public:
  // Of the words those count whose bit is set in `written`, PO1 in bit 0.
  virtual void take_output(Time now, const Words& words, uint16_t written) = 0;
  // Those whose bit is set in `which`, PI1 in bit 0.
  virtual Words input(Time now, uint16_t which) = 0;
  virtual UnitStatus status(Time now) = 0;
  // What it sends on change is other than before, or was held back: Node::unit_changed() is to come in the next millisecond.
  virtual void follow_again(Time /*now*/) {}
  virtual void synchronize(Time now) = 0;  // a SYNC came, and its process data have been taken

  // Process data are exchanged in `operational` only.
  virtual void state_changed(Time now, State state) = 0;
  virtual void reset_node(Time now) = 0;

  // The guarding or heartbeat of the other side stayed away: the response of P836 or P837; and came again.
  virtual void partner_lost(Time now) = 0;
  virtual void partner_back(Time now) = 0;

 protected:
  ~Unit() = default;
};

}  // namespace ipos::runtime::canopen
