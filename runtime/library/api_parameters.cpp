// The C functions about parameters of unit types, which need no plant.
#include <algorithm>
#include <cstring>
#include <exception>
#include <string>
#include <utility>

#include "runtime/library/include/ipos_plant.h"
#include "stdlib/parameters.hpp"
#include "stdlib/return_codes.hpp"
#include "stdlib/unit_types.hpp"

using namespace ipos;

namespace {

// Runs `action(row)` with the parameter of a unit type that `find` picks of its list.
template <typename Find, typename Do>
ipos_plant_status with_parameter(const char* unit, Find find, Do action) noexcept {
  if (unit == nullptr) return IPOS_PLANT_INVALID_ARGUMENT;
  try {
    const stdlib::UnitType* type = stdlib::find_unit(unit);
    if (type == nullptr) return IPOS_PLANT_NO_STATION;
    const stdlib::Parameter* row = find(stdlib::parameter_table(*type));
    if (row == nullptr || row->index == 0) return IPOS_PLANT_NO_SIGNAL;
    return action(*row);
  } catch (const std::exception&) {
    return IPOS_PLANT_OUT_OF_MEMORY;
  }
}

ipos_plant_status copy(const std::string& words, char* text, size_t size) {
  if (size == 0) return IPOS_PLANT_TOO_SMALL;
  const size_t length = std::min(words.size(), size - 1);
  std::memcpy(text, words.data(), length);
  text[length] = 0;
  return length == words.size() ? IPOS_PLANT_OK : IPOS_PLANT_TOO_SMALL;
}

}  // namespace

ipos_plant_status ipos_plant_parameter_index(const char* unit, const char* name, uint16_t* index) {
  if (name == nullptr || index == nullptr) return IPOS_PLANT_INVALID_ARGUMENT;
  return with_parameter(
      unit, [=](const stdlib::ParameterTable& table) { return table.find(std::string_view(name)); },
      [=](const stdlib::Parameter& row) {
        *index = row.index;
        return IPOS_PLANT_OK;
      });
}

ipos_plant_status ipos_plant_parameter_text(const char* unit, uint16_t index, int32_t value, char* text,
                                            size_t size) {
  if (text == nullptr) return IPOS_PLANT_INVALID_ARGUMENT;
  return with_parameter(
      unit, [=](const stdlib::ParameterTable& table) { return table.find(index); },
      [=](const stdlib::Parameter& row) { return copy(stdlib::parameter_text(row, value), text, size); });
}

ipos_plant_status ipos_plant_parameter_value(const char* unit, uint16_t index, const char* written,
                                             int32_t* value, char* text, size_t size) {
  if (written == nullptr || value == nullptr || text == nullptr) return IPOS_PLANT_INVALID_ARGUMENT;
  return with_parameter(
      unit, [=](const stdlib::ParameterTable& table) { return table.find(index); },
      [=](const stdlib::Parameter& row) {
        const auto parsed = stdlib::parse_parameter_text(row, written);
        if (!parsed) {
          copy(parsed.error(), text, size);
          return ipos_plant_status{IPOS_PLANT_BAD_VALUE};
        }
        *value = *parsed;
        return ipos_plant_status{IPOS_PLANT_OK};
      });
}

const char* ipos_plant_return_code(uint32_t code) {
  const std::string_view meaning = stdlib::return_code_meaning(stdlib::ReturnCode::unpack(code));
  return meaning.empty() ? "" : meaning.data();  // of the table, where it ends with 0
}

const char* ipos_plant_unit_name(size_t number) {
  const auto units = stdlib::unit_types();
  return number < units.size() ? units[number].name.data() : nullptr;
}

ipos_plant_status ipos_plant_unit_signs(size_t number, const char** unit, uint16_t* indices, size_t* count) {
  if (unit == nullptr || indices == nullptr || count == nullptr) return IPOS_PLANT_INVALID_ARGUMENT;
  const auto rows = stdlib::unit_signs();
  if (number >= rows.size()) return IPOS_PLANT_NOTHING;
  const stdlib::UnitSigns& row = rows[number];
  const size_t places = std::exchange(*count, row.indices.size());
  if (places < row.indices.size()) return IPOS_PLANT_TOO_SMALL;
  *unit = row.unit.data();
  std::copy(row.indices.begin(), row.indices.end(), indices);
  return IPOS_PLANT_OK;
}
