// What the telegrams of the lines of a plant carried last, as signals LINE.IDENTIFIER.WORD: of CAN with the identifier in
// hexadecimal ("sbus.013.PO2", "sbus.214.value", "can.185.PI1"), of RS-485 and PROFIBUS with the address of the unit
// ("line1.1.PO2", "dp.8.answer_value"). A line begins to keep its frames when the first of its signals is read; before
// that they are 0, and nobody looks at its frames for them.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "runtime/signals/find.hpp"
#include "runtime/station/plant_parts.hpp"

namespace ipos::signals {

// Of the identifiers and addresses that units, nodes and variable telegrams of the plant have by now. The plant must outlive them.
std::vector<Signal> telegram_signals(const runtime::PlantParts& plant);

// By name: also of identifiers and addresses that nobody in the plant has yet, with everything that such telegrams may
// carry.
std::optional<Signal> find_telegram_signal(const runtime::PlantParts& plant, std::string_view name);

// With a pattern that has a part for the identifier: "sbus.*.PO1", "sbus.013.*".
std::vector<Signal> match_telegram_signals(const runtime::PlantParts& plant, std::string_view pattern);

}  // namespace ipos::signals
