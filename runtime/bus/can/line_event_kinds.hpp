// The events a CAN line schedules for itself.
#pragma once

#include <cstdint>

namespace ipos::runtime::line_event {

enum Kind : uint32_t {
  kStart,        // argument: segment
  kEnd,          // segment
  kFaultBegins,  // number of the fault
  kFaultEnds,    // number of the fault
  kLate,         // number of the late frame
  kRecovered,    // node
};

}  // namespace ipos::runtime::line_event
