// After how many turns a loop repeats itself when nothing from outside changes: state machines, counters with an end, edges.
#pragma once

#include <cstdint>
#include <optional>
#include <set>

#include "compiler/analysis/places.hpp"

namespace ipos::compiler::analysis {

// `kept`: variables that the turn keeps for the next one, with all that they come of in it. Begins with any values that they can
// have, and with anything from outside. The number is of turns until one begins as the one before it did; none: it may go on
// for ever, or too many cases are to be looked at.
std::optional<uint64_t> turns_until_rest(const Places& places, const Turn& turn, const std::set<uint32_t>& kept);

}  // namespace ipos::compiler::analysis
