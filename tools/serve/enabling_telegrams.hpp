// Telegrams of the command `bus.send` that could enable a real drive, and why they do not go out: one telegram is no
// hand on a button, so only a drive that monitors its process data by itself may get it.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "tools/serve/arguments.hpp"
#include "tools/unit/bus_link.hpp"

namespace ipos::tools::serve {

// Process data of MOVILINK that could enable whoever gets them.
struct EnablingTelegram {
  std::optional<uint8_t> address;  // of the unit; else a group, or whoever hears it
  bool monitored = true;           // acyclic telegrams of RS-485 are not (1053 1610 p. 23)
};
// What the arguments of `bus.send` on such a line are, if they are one. `canopen`: process data travel as RPDO of the
// identifiers that nodes have by default.
std::optional<EnablingTelegram> enabling_on_can(const Arguments& arguments, bool canopen);
std::optional<EnablingTelegram> enabling_on_serial(const Arguments& arguments);

// Asks the unit. A Mistake says why the telegram does not go out, and what would have to be switched on.
void refuse_unmonitored(BusLink& link, const EnablingTelegram& telegram);

// On a line of a plant that goes on outside: no unit there can be asked. `simulated`: the plant has this address.
void refuse_outside(const EnablingTelegram& telegram, const std::function<bool(uint8_t)>& simulated);

}  // namespace ipos::tools::serve
