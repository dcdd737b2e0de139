// What differs between FMI 2.0 and 3.0 in an FMU's files: one row a version.
#pragma once

#include <cstdint>
#include <string_view>

#include "runtime/fmi/variables.hpp"

namespace ipos::tools {

struct Platform {
  std::string_view library;  // the file that is looked for
  std::string_view ending;
  std::string_view folders[2];  // in `binaries`, of FMI 2.0 and 3.0
};
inline constexpr Platform kPlatforms[] = {{"libipos_fmu.so", ".so", {"linux64", "x86_64-linux"}},
                                          {"ipos_fmu.dll", ".dll", {"win64", "x86_64-windows"}}};

struct Dialect {
  int number;
  std::string_view version;
  std::string_view token;      // attribute
  std::string_view get_state;  // attributes of what an instance can do
  std::string_view serialize;
  std::string_view more;             // attributes of co-simulation that only this version has
  std::string_view more_of_a_line;   // the same of a line alone, which has no ticks and no faults to return for
  std::string_view types[4];         // elements of variables by fmi::Type
  bool nested;                       // the type is an element within the variable
};
inline constexpr Dialect kDialects[] = {
    {2, "2.0", "guid", "canGetAndSetFMUstate", "canSerializeFMUstate", "", "", {"Real", "Integer", "Boolean", "Enumeration"}, true},
    {3, "3.0", "instantiationToken", "canGetAndSetFMUState", "canSerializeFMUState",
     " fixedInternalStepSize=\"0.001\" mightReturnEarlyFromDoStep=\"true\" hasEventMode=\"true\"",
     " hasEventMode=\"true\"",
     {"Float64", "Int32", "Boolean", "Enumeration"}, false}};

}  // namespace ipos::tools
