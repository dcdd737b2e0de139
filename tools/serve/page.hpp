// The page, compiled in from web/dist/index.html; in a source tree without it a line of text.
#pragma once

#include <span>

#include "stdlib/embedded.hpp"

namespace ipos::tools::serve {

std::span<const stdlib::EmbeddedFile> embedded_files();

}  // namespace ipos::tools::serve
