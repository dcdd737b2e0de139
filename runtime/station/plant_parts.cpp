// Parts by name.
#include "runtime/station/plant_parts.hpp"

namespace ipos::runtime {

Bus* PlantParts::find_bus(std::string_view name) const {
  for (const auto& bus : buses())
    if (bus->name() == name) return bus.get();
  return nullptr;
}

Gateway* PlantParts::find_gateway(std::string_view name) const {
  for (Gateway* gateway : all<Gateway>())
    if (gateway->name() == name) return gateway;
  return nullptr;
}

}  // namespace ipos::runtime
