// The system variables through which program and drive talk to each other (stdlib/system_variables.def): what
// the drive shows is copied before the tasks run, what the program orders after them.
#pragma once

#include <cstdint>
#include <span>

#include "runtime/drive/drive.hpp"
#include "stdlib/system_variables.hpp"

namespace ipos::runtime {

// Bits 1 and 2 of H473 have the numbers of /FAULT and READY among the functions of P62x. No manual read prints them; 19
// and 20, which are printed, have those of that list, too, and masters of others read them so (ours).
inline void show_drive(const Drive& drive, std::span<int32_t> h) {
  using stdlib::system_variable;
  constexpr uint32_t kNoFault = 1U << 1, kReady = 1U << 2;
  int32_t& status = h[system_variable("StatusWord")];
  const uint32_t bits = (drive.error() ? 0 : kNoFault) | (drive.ready() ? kReady : 0);
  status = static_cast<int32_t>((static_cast<uint32_t>(status) & ~(kNoFault | kReady)) | bits);
  h[system_variable("OutputLevel")] = drive.outputs();
  h[system_variable("InputLevel")] = drive.inputs();
  h[system_variable("ActPos_Mot")] = drive.position();
}

// Bits 0..7 of OptOutpIPOS are DO10..DO17; both words together are in the order of OutputLevel.
inline void take_program_orders(std::span<const int32_t> h, Drive& drive) {
  using stdlib::system_variable;
  drive.set_ipos_control_word(static_cast<uint32_t>(h[system_variable("ControlWord")]));
  const auto standard = static_cast<uint32_t>(h[system_variable("StdOutpIPOS")]) & 0xFFU;
  const auto option = static_cast<uint32_t>(h[system_variable("OptOutpIPOS")]) & 0xFFU;
  drive.set_ipos_outputs(static_cast<uint16_t>(standard | option << 8));
}

}  // namespace ipos::runtime
