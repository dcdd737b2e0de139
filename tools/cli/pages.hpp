// The pages of docs/reference/diagnostics, built into the program: one file E0123.md a message.
#pragma once

#include <span>

#include "stdlib/embedded.hpp"

namespace ipos::tools::pages {

std::span<const stdlib::EmbeddedFile> embedded_files();

}  // namespace ipos::tools::pages
