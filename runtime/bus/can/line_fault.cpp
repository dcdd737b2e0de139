// Counting and drawing. A fault that draws does so for each frame it could strike, so its numbers do not
// depend on the other faults.
#include "runtime/bus/can/line_fault.hpp"

#include <algorithm>

namespace ipos::runtime {

const FaultType* find_fault_type(std::string_view word) {
  const auto* const found = std::find_if(std::begin(kFaultTypes), std::end(kFaultTypes),
                                         [word](const FaultType& type) { return type.word == word; });
  return found == std::end(kFaultTypes) ? nullptr : found;
}

size_t LineFaults::add(const LineFault& fault) {
  faults_.push_back({fault, Random(fault.seed)});
  return faults_.size() - 1;
}

bool LineFaults::may_strike(Time now) const {
  return std::any_of(faults_.begin(), faults_.end(), [now](const Planted& planted) {
    return fault_type(planted.fault.kind).scope == FaultScope::Frame && now < planted.fault.until;
  });
}

FrameFault LineFaults::strike(Time now, uint32_t id) {
  FrameFault struck;
  for (Planted& planted : faults_) {
    const LineFault& fault = planted.fault;
    if (fault_type(fault.kind).scope != FaultScope::Frame || now < fault.from || now >= fault.until ||
        (fault.id && *fault.id != id))
      continue;
    ++planted.seen;
    const bool hit =
        fault.frame != 0 ? planted.seen == fault.frame : planted.random.below(1000) < fault.per_mille;
    if (hit && !struck.kind) struck = {fault.kind, fault.node, planted.random.next(), fault.lag, fault.of_line};
  }
  return struck;
}

}  // namespace ipos::runtime
