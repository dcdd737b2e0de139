// The PID controller of MOVIDRIVE B, variables H524 and H540 to H559 (IPOSplus p. 38, 39), once a
// millisecond. Printed are the variables, their limits and the bits of PID_Status; the formula is the
// textbook's, in integers, and with P264, P265 and P276 for times and actual value ours.
#pragma once

#include <cstdint>
#include <span>

#include "runtime/drive/parameters.hpp"
#include "runtime/part/part.hpp"
#include "stdlib/system_variables.hpp"

namespace ipos::runtime {

class PidBlock {
 public:
  // The parameters must outlive it.
  explicit PidBlock(const ParameterStore& parameters);

  void tick(std::span<int32_t> h) {
    if (!is_off(h)) return control(h);
    memory_.integral = 0;
    memory_.started = false;
  }
  // With this mode H540 a tick does nothing.
  static bool is_off(std::span<const int32_t> h) {
    const int32_t mode = h[stdlib::system_variable("PID_Mode")];
    return mode != kControl && mode != kStepResponse;
  }
  // What a tick leaves for the next one does not change by time alone, so with the same variables they go on
  // alike (pace/part.hpp).
  void advance(Ticks) {}
  Ticks bound() const { return kNoBound; }
  friend bool operator==(const PidBlock& a, const PidBlock& b) { return a.memory_ == b.memory_; }

 private:
  enum Mode : int32_t { kOff = 0, kControl = 1, kStepResponse = 2 };

  void control(std::span<int32_t> h);

  const ParameterStore& parameters_;
  uint16_t integral_ms_;    // indices: P264; 0: no I share
  uint16_t derivative_ms_;  // P265; 0: no D share
  uint16_t actual_;         // P276: number of the variable with the actual value
  struct Memory {
    int64_t integral = 0;  // 1/65536
    int64_t last_error = 0;
    bool started = false;  // last_error is there
    bool operator==(const Memory&) const = default;
  };
  Memory memory_;
};

}  // namespace ipos::runtime
