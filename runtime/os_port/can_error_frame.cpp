// Error frames in words.
#include "runtime/os_port/can_error_frame.hpp"

#include <fmt/format.h>
#include <linux/can/error.h>

#include <string_view>

namespace ipos::runtime {
namespace {

struct Class {
  uint32_t bit;
  std::string_view text;
};
constexpr Class kClasses[] = {
#define CAN_ERROR_CLASS(bit, text) {bit, text},
#include "runtime/os_port/can_errors.def"
};

struct Detail {
  uint32_t error_class;
  size_t byte;
  unsigned bit;
  std::string_view text;
};
constexpr Detail kDetails[] = {
#define CAN_ERROR_DETAIL(error_class, byte, bit, text) {error_class, byte, bit, text},
#include "runtime/os_port/can_errors.def"
};

void append(std::string& list, std::string_view text) {
  if (!list.empty()) list += ", ";
  list += text;
}

}  // namespace

std::string describe(const CanErrorFrame& error) {
  std::string text;
  for (const Class& row : kClasses) {
    if ((error.classes & row.bit) == 0) continue;
    append(text, row.text);
    std::string details;
    for (const Detail& detail : kDetails)
      if (detail.error_class == row.bit && (error.data[detail.byte] & detail.bit) != 0)
        append(details, detail.text);
    if (!details.empty()) text += fmt::format(" ({})", details);
  }
  return text.empty() ? fmt::format("error frame of unknown class {:X}h", error.classes) : text;
}

}  // namespace ipos::runtime
