// The dictionary of a plant or of a single program for describing telegrams.
#pragma once

#include <string>

#include "runtime/bus/movilink/describe.hpp"
#include "runtime/bus/words/bus_words.hpp"
#include "runtime/plant/plant.hpp"

namespace ipos::runtime {

// Symbol of a variable, with index or member; "H426" without one.
std::string variable_name(const vm::Image* image, uint32_t variable);

// Units and the objects they have defined so far; of one line, or of all when it is null.
TelegramNames telegram_names(const Plant& plant, const CanLine* line = nullptr);

// The same with the CANopen nodes of the line.
CanLineNames can_line_names(const Plant& plant, const CanLine* line = nullptr);

// How many objects of variable telegrams its stations have defined by now.
size_t defined_objects(const Plant& plant, const CanLine& line);

// For all CAN lines of the plant.
CanNames can_names(const Plant& plant);

// The same for RS-485: P810 as address, P811 as group, no objects.
TelegramNames serial_names(const Plant& plant);

// The slaves of a PROFIBUS line.
std::vector<DpSlaveNames> dp_names(const Plant& plant, const Bus& bus);

// For every line of the plant.
BusNames bus_names(const Plant& plant);

}  // namespace ipos::runtime
