// From the plant file alone.
#include "runtime/plant_file/profibus_paper.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "stdlib/parameters.hpp"

namespace ipos::runtime {
namespace {

struct Slave {
  std::string name;
  const ProfibusUse* use;
  uint32_t place;
};

// In the order of the cable, which is that of the file.
std::vector<Slave> slaves_of(const PlantFile& file, const std::string& bus) {
  std::vector<Slave> slaves;
  for (const StationConfig& station : file.stations)
    if (station.profibus.bus.bus == bus)
      slaves.push_back({station.name, &station.profibus, station.place.line});
  for (const ControlConfig& control : file.controls)
    if (const auto* gateway = control.as<GatewayConfig>(); gateway != nullptr && gateway->profibus.bus.bus == bus)
      slaves.push_back({control.name, &gateway->profibus, control.place.line});
  std::stable_sort(slaves.begin(), slaves.end(),
                   [](const Slave& a, const Slave& b) { return a.place < b.place; });
  return slaves;
}

std::vector<const ProfibusMasterConfig*> masters_of(const PlantFile& file, const std::string& bus) {
  std::vector<const ProfibusMasterConfig*> masters;
  for (const ControlConfig& control : file.controls)
    if (const auto* master = control.as<ProfibusMasterConfig>(); master != nullptr && master->bus == bus)
      masters.push_back(master);
  return masters;
}

// An option pcb of which the file says nothing is the one that fits the series.
profibus::Interface interface_of(profibus::OptionKind kind, const ProfibusFit& fit) {
  switch (kind) {
    case profibus::OptionKind::Ffp31:
      return fit.pcb == 'A' || (fit.pcb == 0 && fit.series == 'B') ? profibus::Interface::Ffp31A : profibus::Interface::Ffp31C;
    case profibus::OptionKind::Size0: return profibus::Interface::Size0;
    default: return profibus::Interface::Card;
  }
}

profibus::PlannedStation planned(const Slave& slave,
                                 const std::vector<const ProfibusMasterConfig*>& masters) {
  const profibus::OptionType& option = *slave.use->option;
  profibus::PlannedStation station;
  station.name = slave.name;
  station.address = slave.use->address;
  const ProfibusFit& fit = slave.use->fit;
  station.interface = interface_of(option.kind, fit);
  if (fit.series == 'B' || (fit.series == 0 && fit.pcb == 'A')) station.series = profibus::InverterSeries::B;
  if (station.interface == profibus::Interface::Size0) station.size = 0;
  station.size = fit.size.value_or(station.size);
  station.service_code_4 = fit.service_code.value_or(station.service_code_4);
  if (station.interface == profibus::Interface::Card) station.card = &option;
  station.ident = option.ident;
  station.octets = 0;
  for (const ProfibusMasterConfig* master : masters)
    for (const profibus::SlavePlan& plan : master->slaves) {
      if (plan.address != station.address || station.octets != 0) continue;
      station.octets = plan.outputs;
      station.ident = plan.prm.ident;
      if (plan.prm.watchdog) station.watchdog = plan.prm.watchdog_time();
    }
  return station;
}

// A MOVITRAC 31 stores what is written to it, unless P802 is OFF.
bool stores(const StationConfig& station) {
  if (!station.unit->has(stdlib::Trait::OwnParameterNumbers)) return false;
  const stdlib::ParameterTable& table = stdlib::parameter_table(*station.unit);
  const stdlib::Parameter* save = table.find("802");
  for (const ParameterSetting& setting : station.parameters)
    if (table.find(std::string_view(setting.parameter)) == save) return setting.value != 0;
  return save->default_value != 0;
}

// Download block, universal write and the parameters; the other objects are the card's own (MOVITRAC 31 PROFIBUS, 4.2).
bool is_stored(uint16_t object) { return object == 996 || object == 997 || object >= 1000; }

// Cyclic writing needs P802 = OFF (MOVITRAC 31 PROFIBUS, 6): here what a master of FMS does again and again.
std::vector<std::string> cyclic_writes(const PlantFile& file, const std::string& master, const FmsMasterConfig& fms) {
  std::vector<std::string> found;
  for (const FmsMasterConfig::Request& request : fms.requests) {
    const bool writes = request.request.service == profibus::fms::Service::Write && is_stored(request.request.index);
    if (request.every == 0 || !writes) continue;
    for (const StationConfig& station : file.stations)
      if (station.profibus.bus.bus == fms.bus && station.profibus.address == fms.links[request.link].address && stores(station))
        found.push_back(fmt::format("{} writes object {} of {} every {} ms, and each write goes to the EEPROM of {}: set its P802 (save "
                                    "EEPROM) to OFF",
                                    master, request.request.index, station.name, request.every / kMillisecond, station.name));
  }
  return found;
}

}  // namespace

profibus::LinePlan profibus_paper(const PlantFile& file, const BusConfig& bus) {
  profibus::LinePlan paper;
  paper.baud = bus.baud;
  paper.cable.metres = bus.length_mm / 1000.0;
  if (bus.impedance != 0) paper.cable.ohms = bus.impedance;
  if (bus.capacitance != 0) paper.cable.picofarads_a_metre = bus.capacitance;
  if (bus.loop_resistance != 0) paper.cable.ohms_a_kilometre = bus.loop_resistance;
  if (bus.core_diameter != 0) paper.cable.diameter = bus.core_diameter;
  if (bus.core_section != 0) paper.cable.section = bus.core_section;
  const auto masters = masters_of(file, bus.name);
  std::vector<const profibus::MasterSettings*> all;
  for (const ProfibusMasterConfig* master : masters) all.push_back(&master->settings);
  for (const ControlConfig& control : file.controls)
    if (const auto* master = control.as<FmsMasterConfig>(); master != nullptr && master->bus == bus.name)
      all.push_back(&master->settings);
  if (!all.empty()) {
    paper.masters.clear();
    for (const profibus::MasterSettings* master : all) paper.masters.push_back(master->address);
    paper.gap_poll = all[0]->gap_factor != 0;
  }
  const std::vector<Slave> slaves = slaves_of(file, bus.name);
  // Where the file says nothing of terminators, they are where they belong.
  const bool given = std::any_of(slaves.begin(), slaves.end(),
                                 [](const Slave& slave) { return slave.use->terminator.has_value(); });
  for (const Slave& slave : slaves) {
    paper.stations.push_back(planned(slave, masters));
    paper.stations.back().terminated = slave.use->terminator.value_or(!given && &slave == &slaves.back());
  }
  for (const ControlConfig& control : file.controls)
    if (const auto* master = control.as<FmsMasterConfig>(); master != nullptr && master->bus == bus.name)
      for (const FmsMasterConfig::Link& link : master->links)
        for (profibus::PlannedStation& station : paper.stations) station.of_fms |= station.address == link.address;
  return paper;
}

// A master that finds a slave with another one is told Master_Lock (MOVITRAC 31 PROFIBUS, 3.4.1).
std::vector<std::string> profibus_master_findings(const PlantFile& file, const BusConfig& bus) {
  std::vector<std::string> found;
  const std::vector<Slave> slaves = slaves_of(file, bus.name);
  for (const ControlConfig& control : file.controls)
    if (const auto* fms = control.as<FmsMasterConfig>(); fms != nullptr && fms->bus == bus.name)
      for (const FmsMasterConfig::Link& link : fms->links)
        for (const std::string& broken : profibus::fms::check_master_entry(link.entry, *link.connection))
          found.push_back(fmt::format("{}: its entry does not fit connection {} of slave {}: {}", control.name,
                                      link.connection->cref, link.address, broken));
  std::map<uint8_t, uint8_t> first;  // master of a slave's address
  for (const ProfibusMasterConfig* master : masters_of(file, bus.name))
    for (const profibus::SlavePlan& plan : master->slaves) {
      const uint8_t own = master->settings.address;
      const bool there = std::any_of(slaves.begin(), slaves.end(),
                                     [&](const Slave& slave) { return slave.use->address == plan.address; });
      if (!there && bus.port.empty())
        found.push_back(fmt::format("master {} configures a slave with the address {}, which no station has",
                                    own, plan.address));
      const auto [owner, is_first] = first.emplace(plan.address, own);
      if (!is_first)
        found.push_back(
            fmt::format("masters {} and {} both configure the slave {}: it takes the first that "
                        "parameterises it, and the other gets Master_Lock",
                        owner->second, own, plan.address));
    }
  return found;
}

std::vector<std::string> profibus_wear_findings(const PlantFile& file, const BusConfig& bus) {
  std::vector<std::string> found;
  for (const ControlConfig& control : file.controls)
    if (const auto* fms = control.as<FmsMasterConfig>(); fms != nullptr && fms->bus == bus.name)
      for (std::string& text : cyclic_writes(file, control.name, *fms)) found.push_back(std::move(text));
  return found;
}

}  // namespace ipos::runtime
