// Settings that are accepted and not simulated, from unsimulated.def: what a user has to know of a run.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "stdlib/parameters.hpp"
#include "stdlib/unit_types.hpp"

namespace ipos::stdlib {

// Ideal: true while the plant does not ask for control = "real". Uncoupled: while the plant names no master encoder X42.
enum class UnsimulatedScope : uint8_t { Unit, Bus, Ideal, Uncoupled };

// A row as it stands in the file, for documents.
struct UnsimulatedRow {
  std::string_view parameters;
  std::string_view values;
  bool (*units)(const UnitType& unit);  // nullptr: all that have the parameter
  UnsimulatedScope scope;
  std::string_view text;

  std::string unit_names() const;  // "all" or names
};
std::span<const UnsimulatedRow> unsimulated_rows();

// What a display value of the unit reads where the simulation has nothing to show; empty: it shows something.
std::string_view unshown(const UnitType& unit, const Parameter& parameter);

// A row for one parameter of one unit.
struct Unsimulated {
  const Parameter* parameter;  // leads its index
  const UnsimulatedRow* row;
  std::vector<ValueRange> values;  // empty: every value but the factory setting

  bool applies(int32_t value) const;
  // "P138 Ramp limit is YES: the ramps are not limited"
  std::string text(int32_t value) const;
};

// Of all parameters of the unit, in rising order of the indices; read on first use.
std::span<const Unsimulated> unsimulated(const UnitType& unit);
std::span<const Unsimulated> unsimulated(const UnitType& unit, uint16_t index);

}  // namespace ipos::stdlib
