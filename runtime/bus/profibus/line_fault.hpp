// What a planted fault leaves of a PROFIBUS frame. Which frames it strikes is octet_fault.hpp's.
#pragma once

#include <optional>

#include "runtime/bus/profibus/fdl_frame.hpp"
#include "runtime/bus/rs485/octet_fault.hpp"

namespace ipos::profibus {

using runtime::NodeId;
using runtime::OctetFault;
using runtime::OctetFaultKind;
using runtime::OctetFaults;
using runtime::OctetFaultScope;
using runtime::octet_fault_type;
using runtime::Time;

// A frame as it goes over the line. Without octets nobody hears anything.
struct WireFrame {
  Octets octets;
  std::optional<FrameError> damage;  // of a character: parity or frame
};

// `kind` strikes frames.
void damage(OctetFaultKind kind, WireFrame& frame, runtime::Random& random);

}  // namespace ipos::profibus
