// The unit types as data, from unit_types.def, and in what they differ, from unit_traits.def and unit_families.def.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <span>
#include <string_view>

namespace ipos::stdlib {

enum class Family : uint8_t {
#define FAMILY(name, ...) name,
#include "stdlib/unit_families.def"
};

enum class Trait : uint8_t {
#define TRAIT(name, meaning) name,
#include "stdlib/unit_traits.def"
};

// A set of traits.
class Traits {
 public:
  constexpr Traits(std::initializer_list<Trait> traits) {
    for (const Trait trait : traits) bits_ |= bit(trait);
  }
  constexpr bool has(Trait trait) const { return (bits_ & bit(trait)) != 0; }
  constexpr Traits operator|(Traits other) const {
    other.bits_ |= bits_;
    return other;
  }

 private:
  static constexpr uint64_t bit(Trait trait) { return uint64_t{1} << static_cast<unsigned>(trait); }
  uint64_t bits_ = 0;
};

// Which offsets a cyclic object may have beside those of its range.
enum class OffsetRule : uint8_t { Any, OffsetBelowCycle, SumWithin };

// Cyclic SBus objects of like cycle times.
struct ObjectClass {
  Family family;
  int32_t shortest, longest, step;  // cycle times in ms
  uint8_t objects;                  // of this class
  int32_t longest_offset, offset_step;
  OffsetRule rule;

  constexpr bool has_cycle(int32_t cycle) const {
    return cycle >= shortest && cycle <= longest && cycle % step == 0;
  }
  constexpr bool has_offset(int32_t offset, int32_t cycle) const {
    if (offset < 0 || offset > longest_offset || offset % offset_step != 0) return false;
    if (rule == OffsetRule::OffsetBelowCycle) return offset < cycle;
    return rule == OffsetRule::Any || offset + cycle <= longest;
  }
};

struct UnitType {
  uint8_t code;           // number in the image
  std::string_view name;  // as in the plant file and --unit
  std::string_view title;
  Family family;
  std::string_view lists;    // files of its parameters, with spaces
  uint16_t variables;        // H0 .. variables - 1
  uint16_t parameter_words;  // code words reachable at 16000 + n
  uint16_t program_words;    // longest program
  uint8_t tasks;             // 0..3
  uint8_t call_depth;        // nested calls of a task
  uint8_t receive_objects;
  Traits traits;
  std::span<const ObjectClass> objects;  // cyclic ones, in rising order of the cycle times

  constexpr bool has(Trait trait) const { return traits.has(trait); }
  constexpr bool runs_programs() const { return tasks != 0; }
  // nullptr: no object may have this cycle time.
  const ObjectClass* objects_of(int32_t cycle) const;
};

std::span<const UnitType> unit_types();

// nullptr when there is no such unit.
const UnitType* find_unit(std::string_view name);
const UnitType* find_unit(uint8_t code);
// Of who does not say which, and of who needs one with the trait.
const UnitType& usual_unit();
const UnitType& unit_with(Trait trait);

// How a unit at a port is recognised: the first row all of whose indices it can read.
struct UnitSigns {
  std::string_view unit;
  std::span<const uint16_t> indices;
};
std::span<const UnitSigns> unit_signs();

}  // namespace ipos::stdlib
