// Return codes of the parameter channel from their table.
#include "stdlib/return_codes.hpp"

namespace ipos::stdlib {
namespace {

constexpr ReturnCodeRow kCodes[] = {
#define RETURN_CODE(name, error_class, code, additional, meaning) {return_codes::k##name, meaning},
#include "stdlib/return_codes.def"
};

struct ClassRow {
  uint8_t error_class;
  std::string_view meaning;
};

constexpr ClassRow kClasses[] = {
#define RETURN_CLASS(error_class, meaning) {error_class, meaning},
#include "stdlib/return_codes.def"
};

}  // namespace

std::span<const ReturnCodeRow> return_code_table() { return kCodes; }

std::string_view return_code_meaning(ReturnCode code) {
  for (const ReturnCodeRow& row : kCodes)
    if (row.code == code) return row.meaning;
  return {};
}

std::string_view return_class_meaning(uint8_t error_class) {
  for (const ClassRow& row : kClasses)
    if (row.error_class == error_class) return row.meaning;
  return {};
}

}  // namespace ipos::stdlib
