// H variables that are the same datum as a parameter (PID_Mode = P260, IPOSplus p. 38): a change of one shows
// in the other within a millisecond.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "runtime/drive/parameters.hpp"

namespace ipos::runtime {

class MirroredValues {
 public:
  // A unit has all of these parameters or none.
  explicit MirroredValues(ParameterStore& parameters);

  // Before the tasks run: changed parameters, and at first all of them, into the variables.
  void show(std::span<int32_t> h) {
    if (exist_ && seen_ != parameters_.changes()) show_changed(h);
  }
  // After them: changed variables into the parameters, volatile. A value the parameter refuses is taken back
  // (ours).
  void take(std::span<int32_t> h);

 private:
  void show_changed(std::span<int32_t> h);
  bool written(std::span<const int32_t> h) const;

  static constexpr size_t kPairs = 6;

  ParameterStore& parameters_;
  std::array<uint16_t, kPairs> indices_{};  // of the parameters
  std::array<int32_t, kPairs> agreed_{};
  bool exist_ = true;
  std::optional<uint32_t> seen_;  // parameters_.changes() when they were shown
};

}  // namespace ipos::runtime
