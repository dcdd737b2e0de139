// The GSD file of a PROFIBUS interface, written from the tables that the simulated slave itself works by, for the
// configuration tool of a master (MOVITRAC 31 PROFIBUS, 3.8).
#pragma once

#include <string>

#include "runtime/bus/profibus/card.hpp"

namespace ipos::profibus {

std::string gsd_text(const OptionType& option);

}  // namespace ipos::profibus
