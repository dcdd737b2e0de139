// Both forms have the same digits.
#include "runtime/bus/can/identifier_text.hpp"

#include <fmt/format.h>

namespace ipos::runtime {

std::string id_text(uint32_t id, bool extended) {
  return fmt::format("{:0{}X}", id, extended ? kExtendedIdDigits : kStandardIdDigits);
}

std::string id_words(uint32_t id, bool extended) {
  return fmt::format("{}h ({})", id_text(id, extended), id);
}

}  // namespace ipos::runtime
