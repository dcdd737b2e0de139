// PID_Outp_P + PID_Outp_I + PID_Outp_D + PID_Feedf, within PID_SetpMin and PID_SetpMax, is IPOS_Setp.
#include "runtime/services/pid_block.hpp"

#include <algorithm>

#include "stdlib/system_variables.hpp"

namespace ipos::runtime {
namespace {

using stdlib::system_variable;

// Bits of PID_Status (IPOSplus p. 39). 0 and 1 need limits of the actual value, which are on no page read.
enum Status : int32_t {
  kLimitedP = 1 << 2,
  kNoI = 1 << 3,
  kLimitedI = 1 << 4,
  kLimitedD = 1 << 5,
  kLimitedPid = 1 << 6,
  kLimitedOutput = 1 << 7,
};

constexpr int64_t kShareLimit = 32'000;  // of each share and their sum: the range of the printed limits
constexpr int64_t kWeightLimit = int64_t{1} << 46;  // keeps the products within 64 bits
constexpr int64_t kUnit = 65'536;                   // H543: high word whole part, low word fraction

int64_t limited(int64_t value, int64_t low, int64_t high, Status bit, int32_t& status) {
  const int64_t within = std::clamp(value, low, std::max(low, high));
  if (within != value) status |= bit;
  return within;
}

}  // namespace

PidBlock::PidBlock(const ParameterStore& parameters) : parameters_(parameters) {
  const auto index_of = [&](std::string_view number) {
    const stdlib::Parameter* row = parameters.table().find(number);
    return row == nullptr ? uint16_t{0} : row->index;
  };
  integral_ms_ = index_of("264");
  derivative_ms_ = index_of("265");
  actual_ = index_of("276");
}

void PidBlock::control(std::span<int32_t> h) {
  auto& [integral, last_error, started] = memory_;
  const int32_t mode = h[system_variable("PID_Mode")];
  if (mode != kControl) {
    integral = 0;
    started = false;
  }
  const int64_t integral_ms = parameters_.value(integral_ms_);
  const int64_t gain = std::clamp(h[system_variable("PID_K_p")], 0, 32'000);  // 1/1000
  const int64_t command = h[system_variable("PID_Command")];
  const int64_t error = command - h[static_cast<size_t>(parameters_.value(actual_))];

  int32_t status = 0;
  int64_t sum = command;  // step response: the setpoint goes to the output
  if (mode == kControl) {
    const int64_t p = limited(gain * error / 1000, -kShareLimit, kShareLimit, kLimitedP, status);
    if (integral_ms > 0)
      integral = limited(
          integral + std::clamp(gain * error, -kWeightLimit, kWeightLimit) * kUnit / (1000 * integral_ms),
          -kShareLimit * kUnit, kShareLimit * kUnit, kLimitedI, status);
    else
      integral = 0, status |= kNoI;
    const int64_t d =
        limited(gain * (started ? error - last_error : 0) / 1000 * parameters_.value(derivative_ms_),
                -kShareLimit, kShareLimit, kLimitedD, status);
    last_error = error;
    started = true;
    h[system_variable("PID_Outp_P")] = static_cast<int32_t>(p);
    h[system_variable("PID_Outp_I")] = static_cast<int32_t>(integral);
    h[system_variable("PID_Outp_D")] = static_cast<int32_t>(d);
    sum = limited(p + (integral >> 16) + d, -kShareLimit, kShareLimit, kLimitedPid, status);
  }
  const int64_t output = limited(sum + h[system_variable("PID_Feedf")], h[system_variable("PID_SetpMin")],
                                 h[system_variable("PID_SetpMax")], kLimitedOutput, status);
  h[system_variable("IPOS_Setp")] = static_cast<int32_t>(output);
  h[system_variable("PID_Status")] = status;
}

}  // namespace ipos::runtime
