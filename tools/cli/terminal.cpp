// TERM=dumb says that a terminal knows no escape sequences.
#include "tools/cli/terminal.hpp"

#include <unistd.h>

#include <cstdlib>
#include <string_view>

namespace ipos::tools {

namespace {

std::string_view variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

}  // namespace

bool is_terminal(int descriptor) { return isatty(descriptor) != 0 && variable("TERM") != "dumb"; }

bool has_colours(int descriptor) { return is_terminal(descriptor) && variable("NO_COLOR").empty(); }

}  // namespace ipos::tools
