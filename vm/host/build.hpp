// What a build of the VM can hold. A microcontroller sets these smaller; they are sizes of arrays inside a
// machine and on the stack of the verifier, so everything that is linked together has to agree on them.
#pragma once

#include <cstdint>

#ifndef IPOS_VARIABLES
#define IPOS_VARIABLES 1024  // H variables of a machine; the largest unit has 1024
#endif
#ifndef IPOS_PROGRAM_WORDS
#define IPOS_PROGRAM_WORDS 16384  // the longest program
#endif
#ifndef IPOS_FAST
#define IPOS_FAST 1  // with the fast engine
#endif

namespace ipos::vm {

inline constexpr uint32_t kMaxVariables = IPOS_VARIABLES;
inline constexpr uint32_t kMaxProgramWords = IPOS_PROGRAM_WORDS;
inline constexpr bool kFastEngine = IPOS_FAST != 0;
static_assert(kMaxProgramWords <= UINT16_MAX, "word addresses are kept in 16 bits");

}  // namespace ipos::vm
