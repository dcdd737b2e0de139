// A program as a debugger looks at it: which commands begin a line of the source, in which function an
// address is, and the commands one by one. Made once of an image.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/asm/disassembler.hpp"
#include "vm/image/image.hpp"

namespace ipos::tools::debug {

struct SourcePlace {
  std::string file;
  uint32_t line = 0;  // 0: not known
  uint32_t column = 0;

  std::string text() const;  // "SCOM1.IPC:12", or empty
};

class CodeMap {
 public:
  // The image must outlive the map.
  explicit CodeMap(const vm::Image& image);

  bool is_of(const vm::Image* image) const { return image == &image_; }
  // A step stops here: the first command of a line. Without a line table every command.
  bool starts_line(uint32_t address) const;
  bool is_command(uint32_t address) const;
  SourcePlace place(uint32_t address) const;
  std::string_view function(uint32_t address) const;  // empty: not known
  std::optional<uint32_t> function_address(std::string_view name) const;

  // The first command of the line, or of the next line that has one.
  std::optional<uint32_t> address_of(std::string_view file, uint32_t line) const;
  bool has_file(std::string_view file) const;

  // Text of the command at an address, with the word address of its label.
  std::string text(uint32_t address) const;
  const std::vector<compiler::CodeItem>& items() const { return items_; }
  // The item that covers the address, or the last one.
  size_t item_at(uint32_t address) const;

 private:
  const vm::Image& image_;
  std::vector<compiler::CodeItem> items_;
  std::vector<bool> starts_;
};

}  // namespace ipos::tools::debug
