// The functions of FMI under sequences of calls, right and wrong ones: for a fuzzer and for ctest.
#pragma once

#include <cstdint>
#include <span>

namespace ipos::tests {

// Null, or what was broken: a call answered with a status that is none, or an error came without a text.
const char* play_fmi_calls(std::span<const uint8_t> bytes);

}  // namespace ipos::tests
