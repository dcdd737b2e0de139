// The pairs, and who changed last.
#include "runtime/services/mirrored_values.hpp"

#include <string_view>

#include "stdlib/system_variables.hpp"

namespace ipos::runtime {
namespace {

using stdlib::system_variable;

constexpr struct {
  size_t variable;
  std::string_view parameter;
} kPairs[] = {
    // IPOSplus p. 38, 39
    {system_variable("PID_Mode"), "260"},    {system_variable("PID_K_p"), "263"},
    {system_variable("PID_Feedf"), "266"},   {system_variable("PID_Command"), "271"},
    {system_variable("PID_SetpMin"), "284"}, {system_variable("PID_SetpMax"), "285"},
};

}  // namespace

MirroredValues::MirroredValues(ParameterStore& parameters) : parameters_(parameters) {
  for (const auto& row : kPairs)
    if (const stdlib::Parameter* parameter = parameters.table().find(row.parameter))
      pairs_.push_back({row.variable, parameter->index, std::nullopt});
}

void MirroredValues::show(std::span<int32_t> h) {
  if (seen_ == parameters_.changes()) return;
  seen_ = parameters_.changes();
  for (Pair& pair : pairs_)
    if (const int32_t value = parameters_.stored(pair.index); pair.agreed != value)
      pair.agreed = h[pair.variable] = value;
}

void MirroredValues::take(std::span<int32_t> h) {
  for (Pair& pair : pairs_) {
    const int32_t value = h[pair.variable];
    if (pair.agreed == value) continue;
    if (parameters_.execute(ParameterService::WriteVolatile, pair.index, value)) pair.agreed = value;
    h[pair.variable] = *pair.agreed;
  }
}

}  // namespace ipos::runtime
