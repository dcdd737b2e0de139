// Quantities, units and conversion factors as data, from units.def: what a transferred parameter value means.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace ipos::stdlib {

inline constexpr uint8_t kNoQuantity = 255;

// Value in the base unit of the quantity = transferred value x a + b.
struct Conversion {
  double a;
  double b;
};

// Nothing for 69 and for indices the manual does not list.
std::optional<Conversion> find_conversion(int index);

// Empty when there is none.
std::string_view quantity_name(uint8_t quantity);
std::string_view unit_abbreviation(uint8_t quantity, int conversion);

// Conversion index of a unit of the quantity by its abbreviation, for example (11, "rpm") = 67.
std::optional<int> find_unit_conversion(uint8_t quantity, std::string_view abbreviation);

}  // namespace ipos::stdlib
