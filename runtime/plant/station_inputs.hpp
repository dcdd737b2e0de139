// The lines that lead into a station, binary and analog: what was set, what a wire or switch says, and what
// is forced against both.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "runtime/plant/signal.hpp"

namespace ipos::runtime {

struct InputLine {
  int32_t set = 0;
  std::optional<int32_t> driven;
  std::optional<int32_t> forced;

  int32_t value() const { return forced.value_or(driven.value_or(set)); }
};

class StationInputs {
 public:
  // To be written at once, not kept: what the lines say together is found anew after this.
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
