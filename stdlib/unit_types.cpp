// Unit types from their tables.
#include "stdlib/unit_types.hpp"

#include <algorithm>
#include <cstddef>

namespace ipos::stdlib {
namespace {

using enum Trait;

constexpr Traits kFamilyTraits[] = {
#define FAMILY(name, ...) {__VA_ARGS__},
#include "stdlib/unit_families.def"
};

constexpr ObjectClass kObjects[] = {
#define SBUS_OBJECTS(family, shortest, longest, step, objects, longest_offset, offset_step, rule) \
  {Family::family, shortest, longest, step, objects, longest_offset, offset_step, OffsetRule::rule},
#include "stdlib/unit_families.def"
};

constexpr std::span<const ObjectClass> objects_of_family(Family family) {
  const auto mine = [&](const ObjectClass& row) { return row.family == family; };
  const auto first = std::find_if(std::begin(kObjects), std::end(kObjects), mine);
  return {first, std::find_if_not(first, std::end(kObjects), mine)};
}

constexpr UnitType kUnits[] = {
#define UNIT(code, name, title, family, lists, variables, parameter_words, program_words, tasks, call_depth, \
             receive, ...)                                                                                   \
  {code,                                                                                                     \
   #name,                                                                                                    \
   title,                                                                                                    \
   Family::family,                                                                                           \
   lists,                                                                                                    \
   variables,                                                                                                \
   parameter_words,                                                                                          \
   program_words,                                                                                            \
   tasks,                                                                                                    \
   call_depth,                                                                                               \
   receive,                                                                                                  \
   kFamilyTraits[static_cast<size_t>(Family::family)] | Traits{__VA_ARGS__},                                 \
   objects_of_family(Family::family)},
#include "stdlib/unit_types.def"
};

#define SIGNS(name, ...) constexpr uint16_t name##_signs[] = {__VA_ARGS__};
#include "stdlib/unit_types.def"
constexpr UnitSigns kSigns[] = {
#define SIGNS(name, ...) {#name, name##_signs},
#include "stdlib/unit_types.def"
};

// A new trait must fit into the set.
#define TRAIT(name, meaning) +1
static_assert(0
#include "stdlib/unit_traits.def"
              <= 64);

}  // namespace

const ObjectClass* UnitType::objects_of(int32_t cycle) const {
  const auto found =
      std::find_if(objects.begin(), objects.end(), [&](const ObjectClass& one) { return one.has_cycle(cycle); });
  return found == objects.end() ? nullptr : &*found;
}

std::span<const UnitType> unit_types() { return kUnits; }

const UnitType* find_unit(std::string_view name) {
  for (const UnitType& unit : kUnits)
    if (unit.name == name) return &unit;
  return nullptr;
}

const UnitType* find_unit(uint8_t code) {
  for (const UnitType& unit : kUnits)
    if (unit.code == code) return &unit;
  return nullptr;
}

const UnitType& usual_unit() { return kUnits[0]; }

const UnitType& unit_with(Trait trait) {
  return *std::find_if(std::begin(kUnits), std::end(kUnits), [&](const UnitType& unit) { return unit.has(trait); });
}

std::span<const UnitSigns> unit_signs() { return kSigns; }

}  // namespace ipos::stdlib
