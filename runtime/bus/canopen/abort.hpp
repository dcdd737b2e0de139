// Why an SDO transfer ended without success.
#pragma once

#include <cstdint>
#include <string_view>

#include "stdlib/return_codes.hpp"

namespace ipos::runtime::canopen {

enum class Abort : uint32_t {
#define ABORT(name, code, text) name = code,
#include "runtime/bus/canopen/abort_codes.def"
};

// Empty for a code that is not in the table.
std::string_view abort_text(uint32_t code);

// What a refusal of the parameter channel becomes.
Abort abort_of(stdlib::ReturnCode code);

// The first refusal that becomes this code; class 8 without a number for any other.
stdlib::ReturnCode return_code_of(uint32_t abort);

}  // namespace ipos::runtime::canopen
