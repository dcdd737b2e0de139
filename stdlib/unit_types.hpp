// The unit types as data, from unit_types.def.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace ipos::stdlib {

// Which manual's rules for SBus objects hold.
enum class Generation : uint8_t { None, A, M07, B };

struct UnitType {
  uint8_t code;           // number in the image
  std::string_view name;  // as in the plant file and --unit
  std::string_view title;
  uint16_t variables;        // H0 .. variables - 1
  uint16_t parameter_words;  // code words reachable at 16000 + n
  uint16_t program_words;    // longest program
  uint8_t tasks;             // 0..3
  uint8_t call_depth;        // nested calls of a task
  uint8_t fast_objects;      // cyclic transmit objects of 1..9 ms
  uint8_t slow_objects;      // cyclic transmit objects of 10..65530 ms
  uint8_t receive_objects;
  Generation generation;
};

std::span<const UnitType> unit_types();

// nullptr when there is no such unit.
const UnitType* find_unit(std::string_view name);
const UnitType* find_unit(uint8_t code);

// A list of names with spaces has this unit; an empty list has all.
bool among_units(std::string_view names, const UnitType& unit);

}  // namespace ipos::stdlib
