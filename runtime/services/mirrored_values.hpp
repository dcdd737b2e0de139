// H variables that are the same datum as a parameter (PID_Mode = P260, IPOSplus p. 38): a change of one shows
// in the other within a millisecond.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "runtime/drive/parameters.hpp"

namespace ipos::runtime {

class MirroredValues {
 public:
  // Parameters the unit does not have are left out.
  explicit MirroredValues(ParameterStore& parameters);

  // Before the tasks run: changed parameters, and at first all of them, into the variables.
  void show(std::span<int32_t> h);
  // After them: changed variables into the parameters, volatile. A value the parameter refuses is taken back
  // (ours).
  void take(std::span<int32_t> h);

 private:
  struct Pair {
    size_t variable;
    uint16_t index;
    std::optional<int32_t> agreed;
  };
  ParameterStore& parameters_;
  std::vector<Pair> pairs_;
  std::optional<uint32_t> seen_;  // parameters_.changes() at the last look
};

}  // namespace ipos::runtime
