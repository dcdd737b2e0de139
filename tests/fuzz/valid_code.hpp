// Programs the verifier has to accept, made of any bytes.
#pragma once

#include <cstdint>
#include <vector>

#include "tests/fuzz/fuzz.hpp"

namespace ipos::tests {

// Commands made of the input that the verifier has to accept for a MOVIDRIVE B.
std::vector<uint32_t> valid_code(Input& input);

}  // namespace ipos::tests
