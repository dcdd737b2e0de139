// Quantities, units and conversion factors from their table.
#include "stdlib/units.hpp"

#include <cmath>
#include <numbers>

namespace ipos::stdlib {
namespace {

struct QuantityRow {
  uint8_t index;
  std::string_view name;
};
constexpr QuantityRow kQuantities[] = {
#define QUANTITY(index, name) {index, name},
#include "stdlib/units.def"
};

struct UnitRow {
  uint8_t quantity;
  int conversion;
  std::string_view abbreviation;
};
constexpr UnitRow kUnitRows[] = {
#define UNIT_OF(quantity, conversion, name, abbreviation) {quantity, conversion, abbreviation},
#include "stdlib/units.def"
};

struct ConversionRow {
  int index;
  Conversion conversion;
};
constexpr ConversionRow kConversions[] = {
#define CONVERSION(index, a, b) {index, {a, b}},
#include "stdlib/units.def"
};

}  // namespace

std::optional<Conversion> find_conversion(int index) {
  // Of a negative power some C libraries know less than a division gives.
  if (index >= -64 && index <= 64) return Conversion{index < 0 ? 1 / std::pow(10.0, -index) : std::pow(10.0, index), 0};
  for (const ConversionRow& row : kConversions)
    if (row.index == index) return row.conversion;
  return std::nullopt;
}

std::string_view quantity_name(uint8_t quantity) {
  for (const QuantityRow& row : kQuantities)
    if (row.index == quantity) return row.name;
  return {};
}

std::string_view unit_abbreviation(uint8_t quantity, int conversion) {
  for (const UnitRow& row : kUnitRows)
    if (row.quantity == quantity && row.conversion == conversion) return row.abbreviation;
  return {};
}

std::optional<int> find_unit_conversion(uint8_t quantity, std::string_view abbreviation) {
  for (const UnitRow& row : kUnitRows)
    if (row.quantity == quantity && row.abbreviation == abbreviation) return row.conversion;
  return std::nullopt;
}

}  // namespace ipos::stdlib
