// The signals of a plant: those of its stations as "unit1.speed", and those of its buses as "sbus.load". Names
// may be patterns: "unit1.D*" are all its binary inputs and outputs.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "runtime/signals/station_signals.hpp"
#include "runtime/station/plant_parts.hpp"

namespace ipos::signals {

// All of them (station_signals.hpp); the plant must outlive them.
std::vector<Signal> plant_signals(const runtime::PlantParts& plant);

// What a name or pattern stands for, at least one signal; else why it stands for none. With one station its
// name may be left out.
tl::expected<std::vector<Signal>, std::string> find_signals(const runtime::PlantParts& plant, std::string_view name);

}  // namespace ipos::signals
