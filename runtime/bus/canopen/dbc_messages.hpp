// The messages of a CANopen node in a DBC file: PDOs by its mapping, EMCY, sign of life, SDO, and those to all nodes.
#pragma once

#include <vector>

#include "runtime/bus/canopen/words.hpp"
#include "runtime/bus/movilink/dbc_signals.hpp"

namespace ipos::runtime::canopen {

std::vector<dbc::Message> dbc_messages(const NodeName& node);

}  // namespace ipos::runtime::canopen
