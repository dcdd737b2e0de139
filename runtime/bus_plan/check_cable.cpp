// What can be wrong with the cable and its stations (1053 1610 p. 8, 12, 13; MOVITRAC 07
// chapters 2.1, 3.1, 7.1): what the file says, the rates of the stations, and the faults that it plants.
#include <fmt/format.h>

#include "runtime/bus_plan/checks.hpp"
#include "runtime/plant_file/can_cable.hpp"

namespace ipos::runtime {
namespace {

constexpr FindingKind kind_of(CableRule rule) {
  switch (rule) {
    case CableRule::TooManyStations: return FindingKind::TooManyStations;
    case CableRule::LineTooLong: return FindingKind::LineTooLong;
    case CableRule::CableData: return FindingKind::CableData;
    case CableRule::Termination: return FindingKind::Termination;
    case CableRule::MixedMch42a: break;
  }
  return FindingKind::MixedMch42a;
}

class CableCheck {
 public:
  CableCheck(const LineRoster& roster, std::vector<Finding>& findings)
      : roster_(roster), findings_(findings) {}

  void run(const PlantFile& file) {
    rates();
    for (CableFinding& finding : can_cable_findings(file, *roster_.config))
      find(kind_of(finding.rule), std::move(finding.text));
    for (const FaultConfig& fault : file.faults)
      if (fault.bus == roster_.config->name) planted(fault);
  }

 private:
  void find(FindingKind kind, std::string text) {
    findings_.push_back({kind, roster_.config->name, std::move(text)});
  }

  void rates() {
    for (const Member& member : roster_.members)
      if (member.station != nullptr && settings_of(member).baud != roster_.config->baud)
        find(FindingKind::BaudRate,
             fmt::format("{} is set to {} kbaud ({}), the line has {} kbaud: it neither hears nor answers",
                         member.name, settings_of(member).baud / 1000,
                         !member.station->config().unit->has(stdlib::Trait::NewSbusNumbers) ? "P816"
                         : member.sbus == 1                                                ? "P884"
                                                                                           : "P894",
                         roster_.config->baud / 1000));
  }

  void planted(const FaultConfig& config) {
    const FaultType& type = fault_type(config.fault.kind);
    const std::string whose = config.station.empty() ? "the line" : config.station;
    if (config.fault.kind == FaultKind::Swap)
      find(FindingKind::SwappedWires, fmt::format("{} {}", whose, type.text));
    else if (config.fault.behind)
      find(FindingKind::CableFault, fmt::format("the line {} behind {}", type.text, whose));
    else if (type.scope == FaultScope::Wiring || config.fault.kind == FaultKind::Terminator ||
             config.fault.kind == FaultKind::Length)
      find(FindingKind::CableFault, fmt::format("{} {}", whose, type.text));
  }

  const LineRoster& roster_;
  std::vector<Finding>& findings_;
};

}  // namespace

void check_cable(const LineRoster& roster, const PlantFile& file, std::vector<Finding>& findings) {
  CableCheck(roster, findings).run(file);
}

}  // namespace ipos::runtime
