// Names in the order of the table.
#include "stdlib/unit_names.hpp"

namespace ipos::stdlib {
namespace {

template <typename Test>
std::string names_of(Test test) {
  std::string names;
  for (const UnitType& unit : unit_types())
    if (test(unit)) names.append(names.empty() ? "" : ", ").append(unit.name);
  return names;
}

}  // namespace

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
