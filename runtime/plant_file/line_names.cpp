// Reads the names out of the configurations of all kinds.
#include "runtime/plant_file/line_names.hpp"

#include <initializer_list>

namespace ipos::runtime {
namespace {

std::vector<std::string> given(std::initializer_list<std::string> names) {
  std::vector<std::string> all;
  for (const std::string& name : names)
    if (!name.empty()) all.push_back(name);
  return all;
}

}  // namespace

std::vector<std::string> line_names(const StationConfig& station) {
  return given({station.sbus, station.sbus2, station.serial.x13.bus, station.serial.xt.bus, station.profibus.bus.bus});
}

std::vector<std::string> line_names(const ControlConfig& control) {
  if (const auto* dp = control.as<ProfibusMasterConfig>()) return given({dp->bus});
  if (const auto* fms = control.as<FmsMasterConfig>()) return given({fms->bus});
  if (const auto* gateway = control.as<GatewayConfig>()) return given({control.sbus, gateway->profibus.bus.bus});
  return given({control.sbus});
}

}  // namespace ipos::runtime
