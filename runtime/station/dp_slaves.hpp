// The slaves of a PROFIBUS line as the plant has them, cards and gateways alike: who is at an address, and how the octets of
// its data exchange are divided. Signals and words of telegrams ask here.
#pragma once

#include <string>

#include "runtime/bus/profibus/card.hpp"
#include "runtime/bus/profibus/cfg_data.hpp"
#include "runtime/bus/profibus/slave_handler.hpp"
#include "runtime/station/bus.hpp"
#include "runtime/station/gateway.hpp"
#include "runtime/station/plant_parts.hpp"
#include "runtime/station/station.hpp"

namespace ipos::runtime {

// The slave of an address, as far as the plant has it.
struct DpSlaveOfPlant {
  std::string name;                                        // empty: it is not in the plant
  const profibus::OptionType* option = nullptr;            // its card
  const profibus::Configuration* configuration = nullptr;  // of the data exchange now
  const Station* station = nullptr;                        // one of the two
  const Gateway* gateway = nullptr;
};
DpSlaveOfPlant dp_slave_at(const PlantParts& plant, const Bus& bus, uint8_t address);

// The operator of FMS on the line, at an address that nobody of the plant has.
FmsOperator& fms_operator_of(const PlantParts& plant, ProfibusBus& bus);

// What a master of the plant plans for an address. Null: no master does.
const profibus::SlavePlan* dp_plan_of(const PlantParts& plant, const Bus& bus, uint8_t address);

// That of the master of the plant, which lasts when the data exchange has ended; else that of the data exchange now.
const profibus::Configuration* dp_configuration_of(const PlantParts& plant, const Bus& bus, uint8_t address);

}  // namespace ipos::runtime
