// Parameters of a unit as the page shows and sets them, however the unit is reached.
#pragma once

#include <cstdint>
#include <string>

#include "stdlib/parameters.hpp"
#include "tools/parameters/parameter_access.hpp"
#include "tools/parameters/parameter_target.hpp"
#include "tools/serve/host/arguments.hpp"

namespace ipos::tools::serve {

// `groups` and `parameters` of the reply to the command.
Json parameter_list(ParameterAccess& access);
// `value`, `text` and `changed`.
Json value_json(const stdlib::Parameter& parameter, int32_t value);
// Settings that differ.
Json compare(ParameterAccess& one, ParameterAccess& other);
// What came of a file of `ipos param`.
Json load_settings(ParameterAccess& access, const std::string& text);

// The transferred value of a text; a Mistake says what would be accepted.
int32_t value_of(const Target& target, const std::string& text);
// A Refusal is the unit's, with its reason.
void write_parameter(ParameterAccess& access, uint16_t index, int32_t value, bool is_volatile);

}  // namespace ipos::tools::serve
