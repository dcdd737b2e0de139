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
  InputLine& line(size_t n) { return lines_[n]; }
  const InputLine& line(size_t n) const { return lines_[n]; }

  uint16_t levels() const {  // as InputLevel H483
    uint32_t levels = 0;
    for (size_t n = 0; n < kBinaryLines; ++n) levels |= (lines_[n].value() != 0 ? 1U : 0U) << n;
    return static_cast<uint16_t>(levels);
  }
  AnalogInputs analog() const {
    AnalogInputs inputs;
    for (size_t n = kBinaryLines; n < kInputLines; ++n) analog_value(inputs, n) = lines_[n].value();
    return inputs;
  }

 private:
  std::array<InputLine, kInputLines> lines_{};
};

}  // namespace ipos::runtime
