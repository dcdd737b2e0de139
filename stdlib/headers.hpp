// The header files of the language, built into the compiler: const.h, io.h, constb.h, iob.h.
#pragma once

#include <span>

#include "stdlib/embedded.hpp"

namespace ipos::stdlib::headers {

std::span<const EmbeddedFile> embedded_files();

}  // namespace ipos::stdlib::headers
