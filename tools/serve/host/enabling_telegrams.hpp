// Telegrams of the command `bus.send` that could enable a real drive, and why they do not go out: one telegram is no
// hand on a button, so only a drive that monitors its process data by itself may get it.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/serve/host/arguments.hpp"

namespace ipos::tools::serve {

// Process data of MOVILINK that could enable the drive that receives them.
struct EnablingTelegram {
  uint8_t address = 0;            // of the unit
  const char* unasked = nullptr;  // why no unit can be asked whether it monitors them
};
// What the arguments of `bus.send` on such a line are, if they are one. RPDO count with the identifiers that nodes have by
// default. `canopen`: nodes can be asked, and units of the SBus cannot.
std::optional<EnablingTelegram> enabling_on_can(const Arguments& arguments, bool canopen);
std::optional<EnablingTelegram> enabling_on_serial(const Arguments& arguments);
std::optional<EnablingTelegram> enabling_on_profibus(const std::vector<uint8_t>& octets);

// On a line of a plant that goes on outside: no unit there can be asked. `simulated`: the plant has this address.
void refuse_outside(const EnablingTelegram& telegram, const std::function<bool(uint8_t)>& simulated);

}  // namespace ipos::tools::serve
