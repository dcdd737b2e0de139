// Which verbs a program has: one table (program_verbs.cpp) for `ipos` on every system, for that of a browser, which has no
// ports, sockets and terminals, and for `ipos-demo`, which builds and runs, so that a first look needs a third less to be
// compiled.
#pragma once

#include <span>
#include <string_view>

#include "tools/cli/verb.hpp"

namespace ipos::tools {

struct VerbRow {
  std::string_view group;  // its heading in --help
  std::string_view name;
  void (*add)(cli::Verb& program);  // null: the build does not have it, and says so
};

// In the order of --help.
std::span<const VerbRow> program_verbs();

// What one room of the program has for another; before its verbs.
void join_rooms();

}  // namespace ipos::tools
