// The fault table from faults.def.
#include "stdlib/faults.hpp"

#include "stdlib/unit_text.hpp"

namespace ipos::stdlib {
namespace {

constexpr FaultRow kFaults[] = {
#define FAULT(number, name, response, parameter, meaning) \
  {number, name, FaultResponse::response, parameter, meaning},
#include "stdlib/faults.def"
};

}  // namespace

std::span<const FaultRow> fault_table() { return kFaults; }

const FaultRow* find_fault(uint8_t number) {
  for (const FaultRow& row : kFaults)
    if (row.number == number) return &row;
  return nullptr;
}

std::string meaning_on(const UnitType& unit, const FaultRow& row) { return unit_text(unit, row.meaning); }

const Parameter* response_parameter(const ParameterTable& table, const FaultRow& row) {
  for (std::string_view numbers = row.parameter; !numbers.empty();) {
    const size_t comma = std::min(numbers.find(','), numbers.size());
    if (const Parameter* found = table.find(numbers.substr(0, comma))) return found;
    numbers.remove_prefix(std::min(comma + 1, numbers.size()));
  }
  return nullptr;
}

FaultResponse fixed_response(const UnitType& unit, const FaultRow& row) {
  const bool by_parameter = !row.parameter.empty() && row.parameter != kByCommand;
  return by_parameter && unit.has(Trait::RapidStopFaults) ? FaultResponse::RapidError : row.response;
}

}  // namespace ipos::stdlib
