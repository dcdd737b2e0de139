// The parameters of a station of a plant file, as they are at power-on: factory values, then what its memory
// holds, then what the plant file sets. The plant does not run.
#pragma once

#include <memory>
#include <string>

#include "runtime/nv_memory/medium/file_medium.hpp"
#include "tools/parameters/parameter_access.hpp"

namespace ipos::tools {

// `station` may be empty when the plant has only one. Reading leaves the memory file as it is, and does not
// make one. A Failure says what is wrong.
std::unique_ptr<ParameterAccess> open_station(const std::string& plant, const std::string& station,
                                              runtime::FileUse use);

// A unit as it leaves the factory.
std::unique_ptr<ParameterAccess> open_factory(const stdlib::UnitType& unit);

}  // namespace ipos::tools
