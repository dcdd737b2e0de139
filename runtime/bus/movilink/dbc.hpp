// A DBC file of what runs over an SBus: variable telegrams with the names of their variables, and the process
// data of each unit by P870..P875 with the bits of control and status words, and the parameter channel with the
// index as multiplexor.
#pragma once

#include <string>

#include "runtime/bus/movilink/describe.hpp"

namespace ipos::runtime {

std::string dbc_text(const TelegramNames& names);

}  // namespace ipos::runtime
