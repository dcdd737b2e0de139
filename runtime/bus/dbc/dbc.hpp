// A DBC file of what runs over a CAN line: variable telegrams with the names of their variables, the process data of each
// unit by P870..P875 with the bits of control and status words, the parameter channel with the index as multiplexor, and
// the messages of CANopen nodes. Every name is there once.
#pragma once

#include <string>

#include "runtime/bus/words/can_words.hpp"

namespace ipos::runtime {

std::string dbc_text(const CanLineNames& names);

}  // namespace ipos::runtime
