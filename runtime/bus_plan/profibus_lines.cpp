// From the plant file: stations, the configurations that the masters have of them, the cable.
#include "runtime/bus_plan/profibus_lines.hpp"

#include "runtime/bus/profibus/line_plan.hpp"
#include "runtime/bus_plan/checks.hpp"
#include "runtime/plant_file/profibus_paper.hpp"

namespace ipos::runtime {
namespace {

ProfibusLinePlan plan_line(const PlantFile& file, const BusConfig& bus, std::vector<Finding>& findings) {
  const profibus::LinePlan paper = profibus_paper(file, bus);
  const auto tell = [&](FindingKind kind, std::vector<std::string> texts) {
    for (std::string& text : texts) findings.push_back({kind, bus.name, std::move(text)});
  };
  tell(FindingKind::ProfibusLine, profibus_master_findings(file, bus));
  tell(FindingKind::ProfibusLine, profibus::check_plan(paper));
  tell(FindingKind::ProfibusWear, profibus_wear_findings(file, bus));
  check_octet_faults(file, bus, findings);
  ProfibusLinePlan line;
  line.name = bus.name;
  line.baud = bus.baud;
  line.length = (bus.length_mm + 999) / 1000;
  line.length_limit = profibus::find_baud_rate(bus.baud)->metres;
  line.masters = paper.masters;
  for (const profibus::PlannedStation& station : paper.stations)
    line.stations.push_back(
        {station.name, station.address, station.ident, station.octets, station.watchdog.value_or(kNever)});
  line.cycle_bits = cycle_bits(paper);
  line.cycle = profibus::time_of(line.cycle_bits, bus.baud);
  return line;
}

}  // namespace

void plan_profibus_lines(const Plant& plant, BusPlan& plan) {
  for (const ProfibusBus* bus : plant.all<ProfibusBus>())
    plan.profibus_lines.push_back(plan_line(plant.file(), bus->config(), plan.findings));
}

}  // namespace ipos::runtime
