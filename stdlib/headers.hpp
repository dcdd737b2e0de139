// The files that a program includes without having them, built into the compiler: the headers of the language const.h, io.h,
// constb.h and iob.h, and the blocks, blocks/ramp.h and others (docs/reference/blocks.md).
#pragma once

#include <span>

#include "stdlib/embedded.hpp"

namespace ipos::stdlib {

namespace headers {
std::span<const EmbeddedFile> embedded_files();
}
namespace blocks {
std::span<const EmbeddedFile> embedded_files();
}

// Both.
std::span<const EmbeddedFile> built_in_files();
// The name ignores case, as in an #include; nullptr: there is none.
const EmbeddedFile* find_built_in_file(std::string_view name);

}  // namespace ipos::stdlib
