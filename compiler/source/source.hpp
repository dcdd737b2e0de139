// Source files and places in them. A Location is one 32-bit number for a byte of any file or for a token that
// a macro produced; the SourceMap knows what it means, so tokens, AST and diagnostics stay small.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace ipos::compiler {

// 0 is "no place". Bit 31 set: entry of the macro expansions, else an offset into all files laid end to end.
struct Location {
  uint32_t value = 0;
  bool valid() const { return value != 0; }
  bool in_macro() const { return (value & 0x8000'0000U) != 0; }
  bool operator==(const Location&) const = default;
};

// From the first byte of the first token to after the last byte of the last one.
struct Span {
  Location begin;
  Location end;
  bool operator==(const Span&) const = default;
};

struct SourceFile {
  std::string name;  // as the user or the #include gave it
  std::string path;  // where it was read from; empty for built-in headers and standard input
  std::string text;
  uint32_t base = 0;                  // Location of the first byte
  Location included_at;               // the #include, invalid for the main file
  std::vector<uint32_t> line_starts;  // offset of each line in text
};

// A place in words: file, line and column from 1. Columns count bytes, tabs as one.
struct Position {
  const SourceFile* file = nullptr;
  uint32_t line = 0;
  uint32_t column = 0;
};

class SourceMap {
 public:
  // Adds a file and returns it; it stays where it is for the life of the map.
  const SourceFile& add(std::string name, std::string path, std::string text, Location included_at = {});

  // A token of a macro: written at `spelling` in the #define, used at `use` (which may be in a macro again).
  // The name is text of a file of this map.
  Location add_expansion(std::string_view macro, Location spelling, Location use);

  // Where the text of a location stands: in a file, through any macros.
  Location spelling(Location at) const;
  // Where the user sees it: the place of use of the outermost macro.
  Location use(Location at) const;

  struct Expansion {
    std::string_view macro;
    Location spelling;
    Location use;
  };
  // The innermost expansion a location is in; only when at.in_macro().
  const Expansion& expansion(Location at) const;

  // Position of a location in a file (of its place of use when in a macro).
  Position position(Location at) const;

  // Text of a line (from 1) without its end.
  static std::string_view line_text(const SourceFile& file, uint32_t line);

  // The file a location stands in (of its place of use when in a macro); nullptr for "no place".
  const SourceFile* file_of(Location at) const;

  const std::vector<std::unique_ptr<SourceFile>>& files() const { return files_; }

 private:
  std::vector<std::unique_ptr<SourceFile>> files_;
  std::vector<Expansion> expansions_;
};

}  // namespace ipos::compiler
