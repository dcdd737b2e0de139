// [[vary]] of a campaign file: what it changes, and its levels. Only readers include this; it needs toml++.
#pragma once

#include "runtime/plant_file/plant_reader.hpp"
#include "tools/campaign/campaign.hpp"

namespace ipos::tools::campaign {

using runtime::place_of;
using runtime::PlantReader;

// The plant has been read into the reader, its units are known. Adds the factor and its outline; errors go to the reader.
void read_vary(PlantReader& reader, const toml::table& table, Campaign& campaign);

// A level for a number, and one for a text.
void add_level(FactorOutline& outline, Factor& factor, Setting setting, const toml::node& written, FilePlace place);
// Two levels that are the same, or none at all, are errors.
void check_levels(PlantReader& reader, const FactorOutline& outline, const Factor& factor, FilePlace place);

// As TOML writes it.
std::string toml_of(const toml::node& node);

}  // namespace ipos::tools::campaign
