// modelDescription.xml of a plant.
#pragma once

#include <string>

#include "runtime/fmi/variables.hpp"
#include "tools/fmu/dialect.hpp"

namespace ipos::tools {

struct DescriptionHead {
  std::string model;       // its name
  std::string identifier;  // of the library
  std::string token;
};

std::string description_of(const Dialect& dialect, const DescriptionHead& head, const fmi::Variables& variables);

}  // namespace ipos::tools
