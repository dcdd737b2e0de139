// The pages of docs/reference/diagnostics, built into the program: one file E0123.md a message; and stdlib.md.
#pragma once

#include <span>

#include "stdlib/embedded.hpp"

namespace ipos::tools::explain::pages {

std::span<const stdlib::EmbeddedFile> embedded_files();

}  // namespace ipos::tools::explain::pages
