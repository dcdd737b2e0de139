// A maker for each kind of control.
#include "runtime/station/control.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "runtime/station/plant_parts.hpp"

namespace ipos::runtime {
namespace {

// The SBus addresses that the file names, or those of all that speak MOVILINK on the gateway's SBus: its telegrams go to
// each of them.
std::vector<uint8_t> find_drives(const PlantParts& plant, const ControlConfig& config, const GatewayConfig& gateway) {
  std::vector<uint8_t> addresses = gateway.drives;
  if (addresses.empty())
    for (const auto& station : plant.stations())
      for (const int number : {1, 2}) {
        const StationConfig& on = station->config();
        if ((number == 1 ? on.sbus : on.sbus2) != config.sbus) continue;
        const SbusSettings settings = sbus_settings(std::as_const(*station).drive(), number);
        if (settings.movilink) addresses.push_back(settings.slave.address);
      }
  std::sort(addresses.begin(), addresses.end());
  addresses.erase(std::unique(addresses.begin(), addresses.end()), addresses.end());
  return addresses;
}

class Maker {
 public:
  Maker(const ControlPlace& place, const ControlConfig& config, std::vector<PlantError>& errors)
      : place_(place), config_(config), errors_(errors) {}

  using Made = std::unique_ptr<Control>;

  Made operator()(const ControlSettings& settings) {
    CanBus* const bus = sbus();
    if (bus == nullptr) return nullptr;
    return std::make_unique<MovilinkControl>(place_.queue, place_.next_source++, bus->line(), config_, settings);
  }

  Made operator()(const canopen::MasterSettings& settings) {
    CanBus* const bus = sbus();
    if (bus == nullptr) return nullptr;
    return std::make_unique<CanopenControl>(place_.queue, place_.next_source++, bus->line(), config_, settings,
                                            place_.journal);
  }

  Made operator()(const ProfibusMasterConfig& settings) {
    auto* const bus = as<ProfibusBus>(place_.plant.find_bus(settings.bus));
    if (bus == nullptr) return nullptr;
    return std::make_unique<ProfibusControl>(place_.queue, place_.next_source++, *bus, config_, settings, place_.journal);
  }

  Made operator()(const FmsMasterConfig& settings) {
    auto* const bus = as<ProfibusBus>(place_.plant.find_bus(settings.bus));
    if (bus == nullptr) return nullptr;
    return std::make_unique<FmsControl>(place_.queue, place_.next_source++, *bus, config_, settings, place_.journal);
  }

  Made operator()(const GatewayConfig& gateway) {
    const std::vector<uint8_t> drives = find_drives(place_.plant, config_, gateway);
    if (drives.empty() || drives.size() > kMostGatewayDrives) {
      errors_.push_back(
          {config_.place, fmt::format("gateway '{}' has {} drives on '{}', and it takes 1 to {}: name "
                                      "them with drives = [...]",
                                      config_.name, drives.size(), config_.sbus, kMostGatewayDrives)});
      return nullptr;
    }
    auto* const dp = as<ProfibusBus>(place_.plant.find_bus(gateway.profibus.bus.bus));
    CanBus* const bus = sbus();
    if (dp == nullptr || bus == nullptr) return nullptr;
    ControlSettings settings;
    for (const uint8_t address : drives) settings.targets.push_back({address, false, {}, kGatewayCycle});
    return std::make_unique<Gateway>(place_.queue, place_.next_source++, *dp, bus->line(), config_, gateway,
                                     std::move(settings), place_.journal);
  }

 private:
  CanBus* sbus() const { return as<CanBus>(place_.plant.find_bus(config_.sbus)); }

  const ControlPlace& place_;
  const ControlConfig& config_;
  std::vector<PlantError>& errors_;
};

}  // namespace

std::unique_ptr<Control> make_control(const ControlPlace& place, const ControlConfig& config,
                                      std::vector<PlantError>& errors) {
  return std::visit(Maker(place, config, errors), config.kind);
}

}  // namespace ipos::runtime
