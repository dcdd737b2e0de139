// Where in the source a command of an image comes from.
#pragma once

#include <cstdint>
#include <string>

#include "vm/image/image.hpp"

namespace ipos::runtime {

// "SCOM1.IPC:12:5" of a word address, or empty when the image does not tell.
std::string source_place(const vm::Image& image, uint32_t address);
uint32_t source_line(const vm::Image& image, uint32_t address);  // 12, or 0

}  // namespace ipos::runtime
