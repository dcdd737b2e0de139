// The pairs, and who changed last.
#include "runtime/services/mirrored_values.hpp"

#include <string_view>
#include <utility>

#include "stdlib/system_variables.hpp"

namespace ipos::runtime {
namespace {

using stdlib::system_variable;

constexpr struct {
  size_t variable;
  std::string_view parameter;
} kRows[] = {
    // IPOSplus p. 38, 39
    {system_variable("PID_Mode"), "260"},    {system_variable("PID_K_p"), "263"},
    {system_variable("PID_Feedf"), "266"},   {system_variable("PID_Command"), "271"},
    {system_variable("PID_SetpMin"), "284"}, {system_variable("PID_SetpMax"), "285"},
};

}  // namespace

MirroredValues::MirroredValues(ParameterStore& parameters) : parameters_(parameters) {
  static_assert(std::size(kRows) == kPairs);
  for (size_t n = 0; n < kPairs; ++n) {
    const stdlib::Parameter* parameter = parameters.table().find(kRows[n].parameter);
    exist_ = exist_ && parameter != nullptr;
    if (exist_) indices_[n] = parameter->index;
  }
}

void MirroredValues::show_changed(std::span<int32_t> h) {
  const bool first = !seen_;
  seen_ = parameters_.changes();
  for (size_t n = 0; n < kPairs; ++n)
    if (const int32_t value = parameters_.stored(indices_[n]); first || agreed_[n] != value)
      agreed_[n] = h[kRows[n].variable] = value;
}

inline bool MirroredValues::written(std::span<const int32_t> h) const {
  return [&]<size_t... n>(std::index_sequence<n...>) {
    return ((h[kRows[n].variable] ^ agreed_[n]) | ...) != 0;
  }
  (std::make_index_sequence<kPairs>());
}

void MirroredValues::take(std::span<int32_t> h) {
  const bool shown = seen_.has_value();
  if (!exist_ || (shown && !written(h))) return;
  for (size_t n = 0; n < kPairs; ++n) {
    int32_t& value = h[kRows[n].variable];
    if (shown && agreed_[n] == value) continue;
    if (parameters_.execute(ParameterService::WriteVolatile, indices_[n], value)) agreed_[n] = value;
    value = agreed_[n];
  }
}

}  // namespace ipos::runtime
