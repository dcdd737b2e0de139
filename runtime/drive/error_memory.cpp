// Each kind of value has five indices in a row, t-0 first. A unit without one of them keeps the others.
#include "runtime/drive/error_memory.hpp"

#include "runtime/drive/indices.hpp"

namespace ipos::runtime {
namespace {

constexpr uint16_t kFaultNumber = 8366;
constexpr uint16_t kUnitUtilization = 8416;  // has no display value in the lists
constexpr uint16_t kEntries = 5;

struct Kind {
  uint16_t first;   // index of t-0
  uint16_t source;  // index of the display value
};

constexpr Kind kKinds[] = {
    {8371, index::kInputs},
    {8376, index::kOptionInputs},
    {8381, index::kOutputs},
    {8386, index::kOptionOutputs},
    {8391, index::kStatus},
    {8396, index::kHeatSink},
    {8401, index::kSpeed},
    {8406, index::kOutputCurrent},
    {8411, index::kActiveCurrent},
    {8421, index::kDcLink},
    {8426, index::kMainsOnTime},
    {8431, index::kEnabledTime},
    {8441, index::kMotorUtilization1},
    {8446, index::kMotorUtilization2},
};

void push(ParameterStore& parameters, uint16_t first, int32_t value) {
  for (uint16_t k = kEntries - 1; k > 0; --k) {
    const auto at = static_cast<uint16_t>(first + k);
    parameters.set_display(at, parameters.value(static_cast<uint16_t>(at - 1)));
  }
  parameters.set_display(first, value);
}

}  // namespace

void remember_fault(ParameterStore& parameters, uint8_t fault, int32_t unit_utilization) {
  for (const Kind& kind : kKinds) push(parameters, kind.first, parameters.value(kind.source));
  push(parameters, kUnitUtilization, unit_utilization);
  push(parameters, kFaultNumber, fault);
}

void clear_error_memory(ParameterStore& parameters) {
  for (uint16_t k = 0; k < kEntries; ++k) {
    parameters.set_display(static_cast<uint16_t>(kFaultNumber + k), 0);
    parameters.set_display(static_cast<uint16_t>(kUnitUtilization + k), 0);
    for (const Kind& kind : kKinds) parameters.set_display(static_cast<uint16_t>(kind.first + k), 0);
  }
}

}  // namespace ipos::runtime
