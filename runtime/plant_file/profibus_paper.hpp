// A PROFIBUS line of a plant on paper: stations, the configurations that the masters have of them, the cable.
#pragma once

#include <string>
#include <vector>

#include "runtime/bus/profibus/line_plan.hpp"
#include "runtime/plant_file/plant_file.hpp"

namespace ipos::runtime {

profibus::LinePlan profibus_paper(const PlantFile& file, const BusConfig& bus);

// What the masters of the line have wrong of its slaves, in words: one that is not there, one that another master has.
std::vector<std::string> profibus_master_findings(const PlantFile& file, const BusConfig& bus);

// What they write again and again into memory that wears out.
std::vector<std::string> profibus_wear_findings(const PlantFile& file, const BusConfig& bus);

}  // namespace ipos::runtime
