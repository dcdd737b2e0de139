// Copies between H variables and drive, once a millisecond in each direction.
#include "runtime/services/drive_variables.hpp"

namespace ipos::runtime {
namespace {

enum SystemVariable : size_t {
  kOptOutpIpos = 480,
  kStdOutpIpos = 481,
  kOutputLevel = 482,
  kInputLevel = 483,
  kControlWord = 484,
  kActPosMot = 511,
};

}  // namespace

void show_drive(const Drive& drive, std::span<int32_t> h) {
  h[kOutputLevel] = drive.outputs();
  h[kInputLevel] = drive.inputs();
  h[kActPosMot] = drive.axis().position;
}

// Bits 0..7 of OptOutpIPOS are DO10..DO17; both words together are in the order of OutputLevel.
void take_program_orders(std::span<const int32_t> h, Drive& drive) {
  drive.set_ipos_control_word(static_cast<uint32_t>(h[kControlWord]));
  const auto standard = static_cast<uint32_t>(h[kStdOutpIpos]) & 0xFFU;
  const auto option = static_cast<uint32_t>(h[kOptOutpIpos]) & 0xFFU;
  drive.set_ipos_outputs(static_cast<uint16_t>(standard | option << 8));
}

}  // namespace ipos::runtime
