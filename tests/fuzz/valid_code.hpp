// Programs the verifier has to accept, made of any bytes.
#pragma once

#include <cstdint>
#include <vector>

#include "tests/fuzz/fuzz.hpp"

namespace ipos::tests {

// What the unit has the code is for; at first that of a MOVIDRIVE B.
struct UnitShape {
  uint32_t variables = 1024;
  uint8_t tasks = 3;
};

// Commands made of the input that the verifier has to accept for a unit of this shape. Half of their
// variables are H0, H8 .. H120, so that commands meet each other's results, and a host knows where to put
// structures.
std::vector<uint32_t> valid_code(Input& input, UnitShape unit = {});

}  // namespace ipos::tests
