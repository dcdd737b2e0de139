// The terminals of a CAN line alone, one for each node of somebody else: with them the FMU is a bus simulation of FMI-LS-BUS 1.0. The
// line is that of the plant; what it tells a node goes out as operations.
#pragma once

#include "runtime/fmi/bus_terminal.hpp"

namespace ipos::fmi {

// "sbus.node1", "sbus.node2", ...
Terminals terminals_of_line(const LineChoice& line);

}  // namespace ipos::fmi
