// What MOVILINK asks of the unit behind an interface: its parameters and its process data. SBus and RS-485
// slaves and MOVLNK address 253 all come through here.
#pragma once

#include <cstdint>
#include <span>

#include <tl/expected.hpp>

#include "runtime/bus/movilink/parameter_telegram.hpp"
#include "runtime/bus/movilink/process_data.hpp"
#include "runtime/clock/event_queue.hpp"

namespace ipos::runtime {

struct ParameterRequest {
  Service service;  // never None
  uint16_t index;
  uint8_t subindex;  // as received; a unit that has none ignores it
  int32_t value;     // of a write
};

// The parameters of the unit. A write returns the value stored.
class ParameterServer {
 public:
  virtual tl::expected<int32_t, ReturnCode> serve(Time now, const ParameterRequest& request) = 0;

  // Byte 1 of the channel is a subindex. Else it is reserved: it goes out as 0, whatever came (1053 1610
  // p. 30).
  virtual bool has_subindices() const { return true; }

 protected:
  ~ParameterServer() = default;
};

// Carries out the request of a parameter telegram and makes its answer. `wrong_length` is the code for a write of
// another length than 4 bytes, which is another one over a fieldbus.
ParameterTelegram execute(Time now, ParameterServer& parameters, const ParameterTelegram& request,
                          ReturnCode wrong_length = return_codes::kWrongManagement);

enum class OutputChannel : uint8_t { Single, Group, Sync };

// Process data of one kind of interface: where they come from is known by the object that takes them.
class ProcessDataServer {
 public:
  // One to three words; words that are not sent keep their value (RS-485 by TYP, 1053 1610 p. 23).
  virtual void take_output(Time now, OutputChannel channel, std::span<const uint16_t> words) = 0;
  virtual ProcessWords input(Time now) = 0;
  // The same in an event of the unit's own that was scheduled less than a millisecond ago: of a tick at this very moment, too.
  virtual ProcessWords input_after_tick(Time now) { return input(now); }
  virtual void synchronize(Time now) = 0;  // sync telegram, after its PO-sync words were taken

  // A valid cyclic request of RS-485 for this unit, before its content is carried out: starts or restarts the
  // monitoring by P812 (1053 1610 p. 27). Acyclic requests do not come here.
  virtual void cyclic_request(Time /*now*/) {}

 protected:
  ~ProcessDataServer() = default;
};

}  // namespace ipos::runtime
