// The files of FMI-LS-BUS in an FMU: its terminals, and the manifest of the layered standard.
#pragma once

#include <string>

#include "runtime/fmi/bus_terminal.hpp"

namespace ipos::tools {

// "sbus.Rx_Data" as an FMU names it.
std::string member_name(const fmi::BusTerminal& terminal, fmi::TerminalMember member);

std::string terminals_xml(const fmi::Terminals& terminals);
std::string manifest_xml(bool is_bus_simulation);

}  // namespace ipos::tools
