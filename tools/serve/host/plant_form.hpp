// A new table of a plant without writing TOML: what a form for it asks, and the table as text, inserted where nothing else of
// the file moves. The readers of plants are asked what there is: keys, words, units, which key joins which line.
#pragma once

#include <string>
#include <string_view>

#include "tools/serve/host/arguments.hpp"

namespace ipos::tools::serve {

// Of the text of a plant and the table (station, bus, wire, control): `keys` with their words; of a station with the `unit`
// of the arguments also the lines that it can join, with the addresses and settings that make it heard there.
Json plant_form(const std::string& plant, const Arguments& arguments);

// The text with one more table: `table`, `values` by key (texts are put in quotes), `written` by key (as TOML, as they are),
// of a station also `parameters`. A Mistake is what the readers have against it; then nothing is changed.
std::string with_table(const std::string& plant, const Arguments& arguments);

}  // namespace ipos::tools::serve
