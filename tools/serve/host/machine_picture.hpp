// What the page draws of the machine that a station drives: what [station.machine] of the plant file says, else what
// switches and parameters tell of it, else a shaft; and where it is.
#pragma once

#include "runtime/plant/plant.hpp"
#include "tools/serve/host/arguments.hpp"

namespace ipos::tools::serve {

// What seldom changes: kind, unit, travel, software limit switches. Places in increments are those of H511.
Json machine_picture(const runtime::Station& station, const runtime::PlantFile& file);

// Where it is, where it is going, and what lies on it.
Json machine_state(const runtime::Station& station, const runtime::Surroundings& surroundings);

}  // namespace ipos::tools::serve
