// What a program can write by itself: known beforehand where its commands name their variables.
#pragma once

#include "vm/verify/verify.hpp"

namespace ipos::vm {

// False: no command writes one of these variables, whatever happens, apart from what the host does for system
// commands.
bool may_write(const VerifiedImage& program, uint32_t first, uint32_t last);

}  // namespace ipos::vm
