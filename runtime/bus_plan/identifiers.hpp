// The identifiers of a line: who uses which, and which are closed to the variable objects of a station.
#pragma once

#include <vector>

#include "runtime/bus_plan/plan.hpp"
#include "runtime/bus_plan/roster.hpp"

namespace ipos::runtime {

std::vector<PlannedIdentifier> planned_identifiers(const LineRoster& roster);

// EX-16 to EX-19 of the manual's example: transmit = all the station's own MOVILINK identifiers and those the
// others send; receive = its own. Only stations that can run programs.
std::vector<ClosedIdentifiers> closed_identifiers(const LineRoster& roster);

}  // namespace ipos::runtime
