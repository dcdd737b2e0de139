// The parameter channel of a unit, as every tool uses it that asks the unit itself and not a bus.
#pragma once

#include <cstdint>

#include "runtime/unit/unit_interface.hpp"
#include "stdlib/services.hpp"

namespace ipos::signals {

runtime::ParameterReply parameter_channel(runtime::UnitInterface& drive, stdlib::Service service, uint16_t index,
                                          int32_t value);

}  // namespace ipos::signals
