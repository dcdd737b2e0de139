// Copies between H variables and drive, once a millisecond in each direction.
#include "runtime/unit/drive_variables.hpp"

#include "stdlib/system_variables.hpp"

namespace ipos::runtime {
namespace {

using stdlib::system_variable;

}  // namespace

void show_drive(const Drive& drive, std::span<int32_t> h) {
  h[system_variable("OutputLevel")] = drive.outputs();
  h[system_variable("InputLevel")] = drive.inputs();
  h[system_variable("ActPos_Mot")] = drive.position();
}

// Bits 0..7 of OptOutpIPOS are DO10..DO17; both words together are in the order of OutputLevel.
void take_program_orders(std::span<const int32_t> h, Drive& drive) {
  drive.set_ipos_control_word(static_cast<uint32_t>(h[system_variable("ControlWord")]));
  const auto standard = static_cast<uint32_t>(h[system_variable("StdOutpIPOS")]) & 0xFFU;
  const auto option = static_cast<uint32_t>(h[system_variable("OptOutpIPOS")]) & 0xFFU;
  drive.set_ipos_outputs(static_cast<uint16_t>(standard | option << 8));
}

}  // namespace ipos::runtime
