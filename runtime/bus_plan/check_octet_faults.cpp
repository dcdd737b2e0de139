// Planted faults of the cable and plugs of lines that carry octets. What strikes single frames without a cause in the cable is no
// finding, as on CAN.
#include <fmt/format.h>

#include "runtime/bus_plan/checks.hpp"

namespace ipos::runtime {
namespace {

std::optional<FindingKind> kind_of(OctetFaultKind kind) {
  switch (kind) {
    case OctetFaultKind::Swap: return FindingKind::SwappedWires;
    case OctetFaultKind::Terminator:
    case OctetFaultKind::Length:
    case OctetFaultKind::Baud: return FindingKind::CableFault;
    default: return std::nullopt;
  }
}

}  // namespace

void check_octet_faults(const PlantFile& file, const BusConfig& bus, std::vector<Finding>& findings) {
  for (const FaultConfig& fault : file.faults) {
    if (fault.bus != bus.name || !fault.octets) continue;
    if (const auto kind = kind_of(fault.octets->kind))
      findings.push_back({*kind, bus.name, fmt::format("{} {}", fault.station.empty() ? "the line" : fault.station,
                                                       octet_fault_type(fault.octets->kind).text)});
  }
}

}  // namespace ipos::runtime
