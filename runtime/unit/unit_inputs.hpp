// The lines that lead into a unit, binary and analog: what was set, what a wire or switch says, and what is
// forced against both.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "runtime/drive/setpoint.hpp"

namespace ipos::runtime {

// The lines 0..15 are the binary inputs by their bit in InputLevel H483, then the analog ones.
enum class AnalogLine : uint8_t { Ai1Voltage, Ai1Current, Ai2Voltage, Ai2Current, Frequency, Potentiometer };
inline constexpr size_t kBinaryLines = 16;
inline constexpr size_t kInputLines = kBinaryLines + 6;

// Where the value of an analog line (kBinaryLines and above) stands.
constexpr int32_t& analog_value(AnalogInputs& inputs, size_t line) {
  switch (static_cast<AnalogLine>(line - kBinaryLines)) {
    case AnalogLine::Ai1Voltage: return inputs.ai1.millivolt;
    case AnalogLine::Ai1Current: return inputs.ai1.microampere;
    case AnalogLine::Ai2Voltage: return inputs.ai2.millivolt;
    case AnalogLine::Ai2Current: return inputs.ai2.microampere;
    case AnalogLine::Frequency: return inputs.frequency;
    case AnalogLine::Potentiometer: break;
  }
  return inputs.potentiometer;
}

struct InputLine {
  int32_t set = 0;
  std::optional<int32_t> driven;
  std::optional<int32_t> forced;

  int32_t value() const { return forced.value_or(driven.value_or(set)); }
};

class UnitInputs {
 public:
  // To be written at once, not kept: after this the lines are combined again.
  InputLine& line(size_t n) {
    known_ = false;
    return lines_[n];
  }
  const InputLine& line(size_t n) const { return lines_[n]; }

  bool known() const { return known_; }  // no line was written since somebody looked

  uint16_t levels() const {  // as InputLevel H483
    look();
    return levels_;
  }
  const AnalogInputs& analog() const {
    look();
    return analog_;
  }

 private:
  void look() const {
    if (known_) return;
    uint32_t levels = 0;
    for (size_t n = 0; n < kBinaryLines; ++n) levels |= (lines_[n].value() != 0 ? 1U : 0U) << n;
    levels_ = static_cast<uint16_t>(levels);
    for (size_t n = kBinaryLines; n < kInputLines; ++n) analog_value(analog_, n) = lines_[n].value();
    known_ = true;
  }

  std::array<InputLine, kInputLines> lines_{};
  mutable bool known_ = false;
  mutable uint16_t levels_ = 0;
  mutable AnalogInputs analog_;
};

}  // namespace ipos::runtime
