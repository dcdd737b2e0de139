// The variables of the timers that count down, and what timer 0 begins with again.
#pragma once

#include "stdlib/system_variables.hpp"

namespace ipos::compiler {

inline constexpr uint32_t kTimers[] = {stdlib::system_variable("Timer_0"), stdlib::system_variable("Timer_1"),
                                       stdlib::system_variable("Timer_2")};
inline constexpr uint32_t kReload = stdlib::system_variable("T0_Reload");

}  // namespace ipos::compiler
