// The pairs, and who changed last.
#include "runtime/services/mirrored_values.hpp"

namespace ipos::runtime {

MirroredValues::MirroredValues(ParameterStore& parameters) : parameters_(parameters) {
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

void MirroredValues::take_written(std::span<int32_t> h) {
  const bool shown = seen_.has_value();
  for (size_t n = 0; n < kPairs; ++n) {
    int32_t& value = h[kRows[n].variable];
    if (shown && agreed_[n] == value) continue;
    if (parameters_.execute(ParameterService::WriteVolatile, indices_[n], value)) agreed_[n] = value;
    value = agreed_[n];
  }
}

}  // namespace ipos::runtime
