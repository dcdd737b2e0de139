// The rules a line is checked against. Each function appends what it finds.
#pragma once

#include <vector>

#include "runtime/bus_plan/plan.hpp"
#include "runtime/bus_plan/roster.hpp"

namespace ipos::runtime {

// Stations, baud rates, length, termination, cable, planted cable faults.
void check_cable(const LineRoster& roster, const PlantFile& file, std::vector<Finding>& findings);

// Planted cable faults of RS-485, RS-232 and PROFIBUS.
void check_octet_faults(const PlantFile& file, const BusConfig& bus, std::vector<Finding>& findings);

// Addresses, identifiers, MOVLNK partners, master/slave operation, who follows process data.
void check_profile(const LineRoster& roster, const LinePlan& plan, std::vector<Finding>& findings);

// Variable objects, and commands the trial did not reach.
void check_objects(const LineRoster& roster, const LinePlan& plan, std::vector<Finding>& findings);
void check_reached(const Plant& plant, std::vector<Finding>& findings);

// Load and response times.
void check_timing(const LinePlan& plan, std::vector<Finding>& findings);

}  // namespace ipos::runtime
