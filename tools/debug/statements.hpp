// Where in a source text statements begin, as far as its lines and brackets tell.
#pragma once

#include <string_view>
#include <vector>

namespace ipos::tools::debug {

// Of each line, from 1 on: whether its first word begins a statement, and does not go on with that of a line before.
std::vector<bool> statement_lines(std::string_view text);

}  // namespace ipos::tools::debug
