// modelDescription.xml of a plant.
#pragma once

#include <string>

#include "runtime/fmi/bus_terminal.hpp"
#include "runtime/fmi/variables.hpp"
#include "tools/fmu/dialect.hpp"

namespace ipos::tools {

struct DescriptionHead {
  std::string model;       // its name
  std::string identifier;  // of the library
  std::string token;
  bool is_line = false;    // alone, without stations
};

// Terminals are of FMI 3.0.
std::string description_of(const Dialect& dialect, const DescriptionHead& head, const fmi::Variables& variables,
                           const fmi::Terminals& terminals);

}  // namespace ipos::tools
