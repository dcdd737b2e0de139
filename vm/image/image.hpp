// The program image (.ipx): unit type, code words, and optionally symbols and a line table, in a container
// with magic, version and CRC-32. Layout in docs/reference/isa.md. All numbers little endian.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "vm/image/view.hpp"

namespace ipos::vm {

// A named variable, or a named run of them: a structure member is one symbol ("TrCycl.ObjectNo"), an array is
// one symbol with a count.
struct Symbol {
  std::string name;
  uint16_t variable = 0;  // number of the first H variable
  uint16_t count = 1;     // 1.. consecutive variables

  bool operator==(const Symbol&) const = default;
};

// Commands from `address` up to the next entry come from this place of the source.
struct LineEntry {
  uint32_t address = 0;
  uint16_t file = 0;    // index into Image::files
  uint32_t line = 0;    // from 1
  uint16_t column = 0;  // from 1

  bool operator==(const LineEntry&) const = default;
};

// A function of the source and its first command.
struct FunctionEntry {
  std::string name;
  uint32_t address = 0;

  bool operator==(const FunctionEntry&) const = default;
};

struct Image {
  uint8_t unit = 0;                      // row of stdlib/unit_types.def
  std::vector<uint32_t> code;            // task 1 starts at word 0
  std::vector<Symbol> symbols;           // in rising order of variable, then name
  std::vector<FunctionEntry> functions;  // in rising order of address
  std::vector<std::string> files;
  std::vector<LineEntry> lines;  // in rising order of address

  bool operator==(const Image&) const = default;
};

// offset is the byte where the trouble was seen.
struct ImageResult {
  ImageError error = ImageError::None;
  uint32_t offset = 0;
  Image image;
};

// The same image always gives the same bytes.
std::vector<uint8_t> write_image(const Image& image);

// Any byte string gives an image or an error, never undefined behaviour.
ImageResult read_image(std::span<const uint8_t> bytes);

}  // namespace ipos::vm
