// The fault table from faults.def.
#include "stdlib/faults.hpp"

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

}  // namespace ipos::stdlib
