// The system variables through which program and drive talk to each other (stdlib/system_variables.def): what
// the drive shows is copied before the tasks run, what the program orders after them.
#pragma once

#include <cstdint>
#include <span>

#include "runtime/drive/drive.hpp"

namespace ipos::runtime {

// OutputLevel, InputLevel, ActPos_Mot.
void show_drive(const Drive& drive, std::span<int32_t> h);

// ControlWord, StdOutpIPOS, OptOutpIPOS.
void take_program_orders(std::span<const int32_t> h, Drive& drive);

}  // namespace ipos::runtime
