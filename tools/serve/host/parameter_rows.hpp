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
// "P130"; empty for an index of the system.
std::string number_of(const stdlib::Parameter& parameter);
// As the list has it: units need not be asked for what never changes.
int32_t factory_setting(const stdlib::Parameter& parameter);
// `value`, `text` and `changed`.
Json value_json(const stdlib::Parameter& parameter, int32_t value);
// What came of a file of `ipos param`.
Json load_settings(ParameterAccess& access, const std::string& text);

// The transferred value of a text; a Mistake says what would be accepted.
int32_t value_of(const Target& target, const std::string& text);
// A Refusal is the unit's, with its reason.
void write_parameter(ParameterAccess& access, uint16_t index, int32_t value, bool is_volatile);

}  // namespace ipos::tools::serve
