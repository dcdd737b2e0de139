// What GETSYS and SETSYS share with other commands that change the ramp of a travel.
#pragma once

#include "runtime/commands/command_call.hpp"

namespace ipos::runtime {

// True while the ramp must not be changed: the drive is enabled and P916 is sine or squared (fault list of
// the later units). A command that does it all the same causes F99; this notes it in the call.
bool ramp_is_locked(CommandCall& call);

}  // namespace ipos::runtime
