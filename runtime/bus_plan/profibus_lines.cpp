// From the plant file: stations, the configurations that the masters have of them, the cable.
#include "runtime/bus_plan/profibus_lines.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/bus/profibus/line_plan.hpp"

namespace ipos::runtime {
namespace {

class ProfibusPlanner {
 public:
  ProfibusPlanner(const PlantFile& file, const BusConfig& bus, BusPlan& plan)
      : file_(file), bus_(bus), plan_(plan) {
    on_paper_.baud = bus.baud;
    on_paper_.cable.metres = bus.length_mm / 1000.0;
    if (bus.impedance != 0) on_paper_.cable.ohms = bus.impedance;
    if (bus.capacitance != 0) on_paper_.cable.picofarads_a_metre = bus.capacitance;
  }

  void run() {
    std::vector<const ProfibusMasterConfig*> masters;
    for (const ControlConfig& control : file_.controls)
      if (control.profibus && control.profibus->bus == bus_.name) masters.push_back(&*control.profibus);
    if (!masters.empty()) {
      on_paper_.master = masters[0]->settings.address;
      on_paper_.gap_poll = masters[0]->settings.gap_factor != 0;
    }
    std::vector<Slave> slaves;
    for (const StationConfig& station : file_.stations)
      slaves.push_back({station.name, &station.profibus, station.terminator, station.place.line});
    for (const ControlConfig& control : file_.controls)
      if (control.gateway)  // whose terminator is that of its SBus
        slaves.push_back({control.name, &control.gateway->profibus, std::nullopt, control.place.line});
    std::stable_sort(slaves.begin(), slaves.end(),
                     [](const Slave& a, const Slave& b) { return a.place < b.place; });
    for (const Slave& slave : slaves)
      if (slave.use->bus.bus == bus_.name) add(slave, masters);
    for (const ProfibusMasterConfig* master : masters)
      for (const profibus::SlavePlan& slave : master->slaves)
        if (bus_.port.empty() && !has(slave.address))
          tell(fmt::format("master {} configures a slave with the address {}, which no station has",
                           master->settings.address, slave.address));
    for (std::string& text : check_plan(on_paper_)) tell(std::move(text));
    plan_.profibus_lines.push_back(std::move(line_));
    ProfibusLinePlan& line = plan_.profibus_lines.back();
    line.name = bus_.name;
    line.baud = bus_.baud;
    line.length = (bus_.length_mm + 999) / 1000;
    line.length_limit = profibus::find_baud_rate(bus_.baud)->metres;
    line.master = on_paper_.master;
    line.cycle_bits = cycle_bits(on_paper_);
    line.cycle = profibus::time_of(line.cycle_bits, bus_.baud);
  }

 private:
  void tell(std::string text) {
    plan_.findings.push_back({FindingKind::ProfibusLine, bus_.name, std::move(text)});
  }
  bool has(uint8_t address) const {
    return std::any_of(
        on_paper_.stations.begin(), on_paper_.stations.end(),
        [address](const profibus::PlannedStation& station) { return station.address == address; });
  }

  struct Slave {
    std::string name;
    const ProfibusUse* use;
    std::optional<bool> terminator;
    uint32_t place;
  };

  static profibus::Interface interface_of(profibus::OptionKind kind) {
    switch (kind) {
      case profibus::OptionKind::Ffp31: return profibus::Interface::Ffp31C;
      case profibus::OptionKind::Size0: return profibus::Interface::Size0;
      default: return profibus::Interface::Card;
    }
  }

  void add(const Slave& station, const std::vector<const ProfibusMasterConfig*>& masters) {
    const profibus::OptionType& option = *station.use->option;
    profibus::PlannedStation planned;
    planned.name = station.name;
    planned.address = station.use->address;
    planned.interface = interface_of(option.kind);
    if (planned.interface == profibus::Interface::Size0) planned.size = 0;
    if (planned.interface == profibus::Interface::Card) planned.card = &option;
    planned.ident = option.ident;
    planned.octets = 0;
    for (profibus::PlannedStation& before : on_paper_.stations)
      before.terminated = before.terminated && given_;
    // Where the file says nothing of terminators, they are where they belong.
    given_ = given_ || station.terminator.has_value();
    planned.terminated = station.terminator.value_or(!given_);
    for (const ProfibusMasterConfig* master : masters)
      for (const profibus::SlavePlan& slave : master->slaves) {
        if (slave.address != planned.address || planned.octets != 0) continue;
        planned.octets = slave.outputs;
        planned.ident = slave.prm.ident;
        if (slave.prm.watchdog) planned.watchdog = slave.prm.watchdog_time();
      }
    line_.stations.push_back(
        {planned.name, planned.address, planned.ident, planned.octets, planned.watchdog.value_or(kNever)});
    on_paper_.stations.push_back(std::move(planned));
  }

  const PlantFile& file_;
  const BusConfig& bus_;
  BusPlan& plan_;
  profibus::LinePlan on_paper_;
  ProfibusLinePlan line_;
  bool given_ = false;  // a terminator of the file
};

}  // namespace

void plan_profibus_lines(const Plant& plant, BusPlan& plan) {
  for (const BusConfig& bus : plant.file().buses)
    if (bus.kind == BusKind::Profibus) ProfibusPlanner(plant.file(), bus, plan).run();
}

}  // namespace ipos::runtime
