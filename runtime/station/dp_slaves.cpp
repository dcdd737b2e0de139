// Looked up each time: an address may be set anew, and a data exchange begins and ends.
#include "runtime/station/dp_slaves.hpp"

#include <set>
#include <utility>

#include "runtime/station/profibus_control.hpp"

namespace ipos::runtime {

DpSlaveOfPlant dp_slave_at(const PlantParts& plant, const Bus& bus, uint8_t address) {
  for (const auto& station : plant.stations()) {
    const StationConfig& config = station->config();
    const ProfibusPort* port = std::as_const(*station).profibus();
    if (port == nullptr || config.profibus.bus.bus != bus.name()) continue;
    const profibus::DpSlave& slave = port->card().station().slave();
    if (slave.address() == address)
      return {config.name, config.profibus.option, slave.configuration(), station.get(), nullptr};
  }
  for (const Gateway* gateway : plant.all<Gateway>()) {
    const ProfibusUse& use = gateway->profibus();
    const profibus::DpSlave& slave = gateway->dp().slave();
    if (use.bus.bus == bus.name() && slave.address() == address)
      return {gateway->name(), use.option, slave.configuration(), nullptr, gateway};
  }
  return {};
}

FmsOperator& fms_operator_of(const PlantParts& plant, ProfibusBus& bus) {
  std::set<uint8_t> taken;
  for (const ProfibusControl* master : plant.all<ProfibusControl>()) taken.insert(master->settings().settings.address);
  for (const FmsControl* master : plant.all<FmsControl>()) taken.insert(master->settings().settings.address);
  for (uint8_t address = 0; address <= profibus::kLastStation; ++address)
    if (!dp_slave_at(plant, bus, address).name.empty()) taken.insert(address);
  return bus.fms_operator(taken);
}

const profibus::SlavePlan* dp_plan_of(const PlantParts& plant, const Bus& bus, uint8_t address) {
  for (const ProfibusControl* master : plant.all<ProfibusControl>())
    if (master->settings().bus == bus.name())
      for (const profibus::SlavePlan& plan : master->settings().slaves)
        if (plan.address == address) return &plan;
  return nullptr;
}

const profibus::Configuration* dp_configuration_of(const PlantParts& plant, const Bus& bus, uint8_t address) {
  const DpSlaveOfPlant slave = dp_slave_at(plant, bus, address);
  if (const profibus::SlavePlan* plan = dp_plan_of(plant, bus, address)) {
    const profibus::OptionType& option =
        slave.option != nullptr ? *slave.option : profibus::option_type(profibus::OptionKind::Ffp31);
    return profibus::find_configuration(plan->cfg, option.accepts);
  }
  return slave.configuration;
}

}  // namespace ipos::runtime
