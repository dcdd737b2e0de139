// What a gateway has that has a value: its power, its data exchange, and the words, answers and losses of each of its
// drives, which are called by their SBus addresses ("gw.drive2.PO1").
#pragma once

#include <vector>

#include "runtime/signals/find.hpp"
#include "runtime/station/gateway.hpp"

namespace ipos::signals {

// The gateway must outlive them.
std::vector<Signal> gateway_signals(const runtime::Gateway& gateway);

}  // namespace ipos::signals
