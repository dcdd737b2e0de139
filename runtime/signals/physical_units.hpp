// Units by their names, and numbers from one into another: for what meets the variables of other tools.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "runtime/plant_file/foreign_machine.hpp"
#include "runtime/signals/signal.hpp"

namespace ipos::signals {

// The units that ipos has a base unit of.
std::span<const runtime::PhysicalUnit> physical_units();
// Null: the name stands for none of them.
const runtime::PhysicalUnit* find_physical_unit(std::string_view name);

// They measure the same. Radians are not looked at: many tools leave them out of their base units.
bool measure_the_same(const runtime::PhysicalUnit& one, const runtime::PhysicalUnit& other);

// The number that `value` in `from` is in `to`.
double converted(double value, const runtime::PhysicalUnit& from, const runtime::PhysicalUnit& to);

// What other tools take a signal for: its number is that of people, but shafts have Nm, rad/s and rad.
struct OwnNumber {
  double per_sample = 1;
  std::optional<runtime::PhysicalUnit> unit{};  // nothing: a plain number
};
OwnNumber own_number(const Signal& signal);

}  // namespace ipos::signals
