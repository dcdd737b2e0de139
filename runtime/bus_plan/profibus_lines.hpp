// The PROFIBUS lines of a plant on paper: their stations, how long a cycle takes, and what is wrong.
#pragma once

#include "runtime/bus_plan/plan.hpp"

namespace ipos::runtime {

// Adds lines and findings.
void plan_profibus_lines(const Plant& plant, BusPlan& plan);

}  // namespace ipos::runtime
