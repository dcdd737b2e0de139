// Return codes in words.
#include "runtime/bus/movilink/return_code.hpp"

#include <fmt/format.h>

namespace ipos::runtime {

std::string describe(ReturnCode code) {
  std::string_view meaning = stdlib::return_code_meaning(code);
  if (meaning.empty()) meaning = stdlib::return_class_meaning(code.error_class);
  return fmt::format("class {} code {} additional {:02X}h: {}", code.error_class, code.code, code.additional,
                     meaning.empty() ? "unknown" : meaning);
}

}  // namespace ipos::runtime
