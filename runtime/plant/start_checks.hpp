// What is wrong with a plant as it starts goes into its journal, and what has to be watched on its lines is told there.
#pragma once

#include "runtime/plant/plant.hpp"

namespace ipos::runtime {

// Before the power: what the plant file, the programs and the parameters say.
void tell_findings(const Plant& plant, Journal& journal);

// After it: the addresses of those that are on a CAN line now.
void check_nodes(const Plant& plant, Journal& journal);

}  // namespace ipos::runtime
