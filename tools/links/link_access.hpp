// The parameters of a real drive, or of a simulated one that answers at a port: the unit at an address of a
// bus.
#pragma once

#include <memory>
#include <string>

#include "tools/links/bus_link.hpp"
#include "tools/parameters/parameter_access.hpp"

namespace ipos::tools {

// A single question may be lost, or answered late on a busy machine: what changes nothing is asked again.
AccessReply ask(BusLink& link, uint8_t address, stdlib::Service service, uint16_t index);

// Which unit type answers, as far as its parameters tell (ours: no manual read prints the coding of P070);
// nullptr when none of the lists fits. `error` is why the first question was not answered.
const stdlib::UnitType* identify(BusLink& link, uint8_t address, AccessError* error = nullptr);

// `unit` may be empty: then the unit is asked. A Failure when it does not answer or is not known.
std::unique_ptr<ParameterAccess> open_unit(std::unique_ptr<BusLink> link, uint8_t address,
                                           const std::string& unit);

// The same over a link that others use, too.
std::unique_ptr<ParameterAccess> unit_at(BusLink& link, uint8_t address, const stdlib::UnitType& unit);

}  // namespace ipos::tools
