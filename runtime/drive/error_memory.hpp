// The error memory t-0..t-4: what the drive showed at the moment of the last five faults (1053 1610 p.
// 69-71).
#pragma once

#include <cstdint>

#include "runtime/drive/parameters.hpp"

namespace ipos::runtime {

// Moves the entries back by one and writes `fault` and the present display values into t-0.
void remember_fault(ParameterStore& parameters, uint8_t fault, int32_t unit_utilization);

// P804 = 1.
void clear_error_memory(ParameterStore& parameters);

}  // namespace ipos::runtime
