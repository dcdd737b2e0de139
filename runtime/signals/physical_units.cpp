// The rows of physical_units.def, and the way over base units.
#include "runtime/signals/physical_units.hpp"

#include <algorithm>
#include <numbers>
#include <vector>

#include "runtime/motion/machine_data.hpp"
#include "runtime/signals/collector.hpp"

namespace ipos::signals {

using runtime::PhysicalUnit;

namespace {

constexpr size_t kBaseUnitsButAngle = 7;

}  // namespace

std::span<const PhysicalUnit> physical_units() {
  static const std::vector<PhysicalUnit> units{
#define PHYSICAL_UNIT(name, kg, m, s, a, k, rad, factor, offset) {name, {kg, m, s, a, k, 0, 0, rad}, factor, offset},
#include "runtime/signals/physical_units.def"
  };
  return units;
}

const PhysicalUnit* find_physical_unit(std::string_view name) {
  const auto units = physical_units();
  const auto found = std::find_if(units.begin(), units.end(), [name](const PhysicalUnit& unit) { return unit.name == name; });
  return found == units.end() ? nullptr : &*found;
}

bool measure_the_same(const PhysicalUnit& one, const PhysicalUnit& other) {
  return std::equal(one.exponents.begin(), one.exponents.begin() + kBaseUnitsButAngle, other.exponents.begin());
}

// The same unit keeps its digits.
double converted(double value, const PhysicalUnit& from, const PhysicalUnit& to) {
  if (from.factor == to.factor && from.offset == to.offset) return value;
  return (value * from.factor + from.offset - to.offset) / to.factor;
}

OwnNumber own_number(const Signal& signal) {
  std::string_view name = signal.group == Group::Drive ? signal.own_name() : std::string_view();
  if (name.starts_with(kUnitPrefix)) name.remove_prefix(kUnitPrefix.size());
  if (name == "shaft_speed") return {signal.factor * find_physical_unit("rpm")->factor, *find_physical_unit("rad/s")};
  if (name == "torque" && signal.owner != nullptr) {  // in % of what the motor is rated for
    const double rated = runtime::rated_torque(runtime::within_limits(signal.owner->config().machine));
    return {signal.factor / 100 * rated, *find_physical_unit("Nm")};
  }
  OwnNumber own{signal.factor, {}};
  if (const PhysicalUnit* unit = find_physical_unit(signal.unit)) own.unit = *unit;
  return own;
}

}  // namespace ipos::signals
