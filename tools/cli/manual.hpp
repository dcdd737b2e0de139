// The manual page, made of the rows of the command line.
#pragma once

#include <string>

#include "tools/cli/verb.hpp"

namespace ipos::tools::cli {

// roff for man(1), section 1.
std::string manual_page(const Verb& program, const std::string& version);

}  // namespace ipos::tools::cli
