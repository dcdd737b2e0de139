// What lines that carry octets have in common about their planted faults (runtime/bus/rs485/octet_faults.def).
#pragma once

#include <string>
#include <vector>

#include "runtime/station/bus.hpp"

namespace ipos::runtime {

inline std::vector<FaultRule> octet_fault_rules(OctetLine line) {
  std::vector<FaultRule> rules;
  for (const OctetFaultType& type : octet_fault_types()) {
    const bool of_frames = type.scope == OctetFaultScope::Frame;
    if (type.is_of(line))
      rules.push_back({type.word, type.text, of_frames ? FaultPlace::Either : FaultPlace::Station, of_frames, false});
  }
  return rules;
}

inline FaultConfig make_octet_fault(const WantedFault& wanted, OctetLine line) {
  FaultConfig config;
  OctetFault& fault = config.octets.emplace();
  fault.kind = find_octet_fault(wanted.word, line)->kind;
  fault.per_mille = wanted.per_mille;
  fault.from = wanted.from;
  return config;
}

// kNoNode: there is none.
template <typename Line>
NodeId node_named(const Line& line, const std::string& station) {
  for (NodeId node = 0; node < line.node_count() && !station.empty(); ++node)
    if (line.node_name(node) == station) return node;
  return kNoNode;
}

// False: its station is not on the line.
template <typename Line>
bool plant_octet_fault(Line& line, const FaultConfig& config) {
  OctetFault fault = *config.octets;
  fault.sender = node_named(line, config.station);
  if (!config.station.empty() && fault.sender == kNoNode) return false;
  line.add_fault(fault);
  return true;
}

}  // namespace ipos::runtime
