// Text files compiled into the program, see cmake/embed.cmake.
#pragma once

#include <span>
#include <string_view>

namespace ipos::stdlib {

struct EmbeddedFile {
  std::string_view name;
  std::string_view text;
};

}  // namespace ipos::stdlib
