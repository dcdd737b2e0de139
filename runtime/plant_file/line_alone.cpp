// The line and its faults; what is at its other end is nobody's here.
#include "runtime/plant_file/line_alone.hpp"

#include "runtime/plant_file/outer_port.hpp"

namespace ipos::runtime {

PlantFile line_alone(const PlantFile& file, const std::string& bus) {
  PlantFile alone;
  for (const BusConfig& each : file.buses)
    if (each.name == bus) alone.buses.push_back(each);
  for (BusConfig& each : alone.buses) each.port = kFmiPort;
  for (const FaultConfig& fault : file.faults)
    if (fault.bus == bus && fault.station.empty()) alone.faults.push_back(fault);
  return alone;
}

}  // namespace ipos::runtime
