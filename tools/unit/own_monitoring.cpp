// By index: it is the same for the units that name the parameter otherwise.
#include "tools/unit/own_monitoring.hpp"

namespace ipos::tools {

MonitoringIndices monitoring_indices(bool serial) {
  if (serial) return {8599, 8612, "P812", "P833"};
  return {8602, 8615, "P815 (P883 of MOVIDRIVE B)", "P836"};
}

OwnMonitoring own_monitoring(const stdlib::UnitType& unit, bool serial) {
  const MonitoringIndices indices = monitoring_indices(serial);
  const stdlib::ParameterTable& table = stdlib::parameter_table(unit);
  return {table.find(indices.timeout), table.find(indices.response)};
}

}  // namespace ipos::tools
