// What a gateway has that has a value: its power, its data exchange, and the words, answers and losses of each of its
// drives, which are called by their SBus addresses ("gw.drive2.PO1").
#pragma once

#include <vector>

#include "runtime/plant/gateway.hpp"
#include "runtime/plant/station_signals.hpp"

namespace ipos::runtime {

// The gateway must outlive them.
std::vector<PlantSignal> gateway_signals(const Gateway& gateway);

}  // namespace ipos::runtime
