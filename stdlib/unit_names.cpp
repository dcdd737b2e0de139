// Names in the order of the table.
#include "stdlib/unit_names.hpp"

#include <span>

#include "stdlib/spelling.hpp"

namespace ipos::stdlib {
namespace {

template <typename Test>
std::string names_of(Test test) {
  std::string names;
  for (const UnitType& unit : unit_types())
    if (test(unit)) names.append(names.empty() ? "" : ", ").append(unit.name);
  return names;
}

// As the nameplate begins, in capitals.
struct UnitPlates {
  std::string_view unit;
  std::span<const std::string_view> types;
};
#define PLATES(name, ...) constexpr std::string_view name##_plates[] = {__VA_ARGS__};
#include "stdlib/unit_types.def"
constexpr UnitPlates kPlates[] = {
#define PLATES(name, ...) {#name, name##_plates},
#include "stdlib/unit_types.def"
};

// The name of the unit whose nameplate begins so, in any case of letters: "MDX61B0011-5A3-4-00" is an mdxb.
std::string_view unit_of_plate(std::string_view text) {
  for (const UnitPlates& row : kPlates)
    for (const std::string_view type : row.types)
      if (equal_but_for_case(text.substr(0, type.size()), type)) return row.unit;
  return {};
}

}  // namespace

const UnitType* find_unit_or_plate(std::string_view name) {
  if (const UnitType* unit = find_unit(name)) return unit;
  const std::string_view plate = unit_of_plate(name);
  return plate.empty() ? nullptr : find_unit(plate);
}

std::string unit_names() {
  return names_of([](const UnitType&) { return true; });
}

std::string program_unit_names() {
  return names_of([](const UnitType& unit) { return unit.runs_programs(); });
}

std::string unit_names(Trait trait) {
  return names_of([&](const UnitType& unit) { return unit.has(trait); });
}

std::string no_unit_text(std::string_view name) {
  return "'" + std::string(name) + "' is no unit type; known are " + unit_names();
}

std::string cycle_text(const ObjectClass& objects) {
  std::string text = std::to_string(objects.shortest) + " to " + std::to_string(objects.longest) + " ms";
  if (objects.step != 1) text += " in steps of " + std::to_string(objects.step);
  return text;
}

}  // namespace ipos::stdlib
