// H variables that are the same datum as a parameter (PID_Mode = P260, IPOSplus p. 38): a change of one shows
// in the other within a millisecond.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "runtime/drive/parameters.hpp"
#include "stdlib/system_variables.hpp"

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
  void take(std::span<int32_t> h) {
    if (exist_ && (!seen_ || written(h))) take_written(h);
  }

 private:
  void show_changed(std::span<int32_t> h);
  void take_written(std::span<int32_t> h);
  bool written(std::span<const int32_t> h) const {
    return [&]<size_t... n>(std::index_sequence<n...>) {
      return ((h[kRows[n].variable] ^ agreed_[n]) | ...) != 0;
    }
    (std::make_index_sequence<kPairs>());
  }

  struct Row {
    size_t variable;
    std::string_view parameter;
  };
  static constexpr Row kRows[] = {
      // IPOSplus p. 38, 39
      {stdlib::system_variable("PID_Mode"), "260"},    {stdlib::system_variable("PID_K_p"), "263"},
      {stdlib::system_variable("PID_Feedf"), "266"},   {stdlib::system_variable("PID_Command"), "271"},
      {stdlib::system_variable("PID_SetpMin"), "284"}, {stdlib::system_variable("PID_SetpMax"), "285"},
  };
  static constexpr size_t kPairs = std::size(kRows);

  ParameterStore& parameters_;
  std::array<uint16_t, kPairs> indices_{};  // of the parameters
  std::array<int32_t, kPairs> agreed_{};
  bool exist_ = true;
  std::optional<uint32_t> seen_;  // parameters_.changes() when they were shown
};

}  // namespace ipos::runtime
