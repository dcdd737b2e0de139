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
constexpr uint32_t kNoFaultBit = 1U << 1, kReadyBit = 1U << 2;

// They follow what the drive decides (Drive::changes()).
inline uint32_t drive_bits(const Drive& drive) {
  return (drive.error() ? 0 : kNoFaultBit) | (drive.ready() ? kReadyBit : 0);
}

inline void show_drive(const Drive& drive, uint32_t bits, std::span<int32_t> h) {
  using stdlib::system_variable;
  int32_t& status = h[system_variable("StatusWord")];
  status = static_cast<int32_t>((static_cast<uint32_t>(status) & ~(kNoFaultBit | kReadyBit)) | bits);
  h[system_variable("OutputLevel")] = drive.outputs();
  h[system_variable("InputLevel")] = drive.inputs();
  h[system_variable("ActPos_Mot")] = drive.position();
}

inline void take_program_orders(std::span<const int32_t> h, Drive& drive) {
  using stdlib::system_variable;
  drive.set_ipos_control_word(static_cast<uint32_t>(h[system_variable("ControlWord")]));
  const auto standard = static_cast<uint32_t>(h[system_variable("StdOutpIPOS")]) & 0xFFU;
  const auto option = static_cast<uint32_t>(h[system_variable("OptOutpIPOS")]) & 0xFFU;
  drive.set_ipos_outputs(static_cast<uint16_t>(standard | option << 8));
}

}  // namespace ipos::runtime
