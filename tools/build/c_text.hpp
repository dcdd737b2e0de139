// A program as a C header, for firmware that has it in its flash (docs/guide/firmware.md).
#pragma once

#include <string>
#include <string_view>

#include "vm/image/image.hpp"

namespace ipos::tools {

// `path` is the source, whose name the names in the text begin with.
std::string c_text(const vm::Image& image, std::string_view path);

}  // namespace ipos::tools
