// What a planted fault leaves of the bits of a transmission on RS-485 or RS-232. Which characters and errors become of them
// is decided by the receivers (levels.hpp).
#pragma once

#include <vector>

#include "runtime/bus/rs485/octet_fault.hpp"

namespace ipos::runtime {

// The time that they take stays. `kind` strikes frames.
void damage(OctetFaultKind kind, std::vector<bool>& bits, Random& random);

}  // namespace ipos::runtime
