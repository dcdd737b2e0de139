// A CAN port over an adapter whose maker has a library for it: from the port's name to the library, and from the channel's
// calls to a port that never waits, keeps a queue and counts what is lost.
#pragma once

#include <string_view>

#include "runtime/os_port/can_port.hpp"

namespace ipos::runtime {

// Whether the name begins with the prefix of an adapter ("pcan:USB1").
bool is_adapter_port(std::string_view name);

// A system that loads no libraries has no such port. `library` is loaded in place of the maker's; for tests.
CanPortResult open_adapter_port(std::string_view name, uint32_t baud, RealClock& clock,
                                const std::string& library = {});

}  // namespace ipos::runtime
