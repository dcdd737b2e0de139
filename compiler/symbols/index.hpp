// Where the names of a program stand and what they mean: for editors. Made from the tokens and the
// declarations, so a program with mistakes has an index, too; what its mistakes hide is missing.
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compiler/compile.hpp"
#include "compiler/preprocess/preprocess.hpp"

namespace ipos::compiler {

enum class SymbolKind : uint8_t {
  Macro,
  Variable,
  Alias,  // #declare
  Function,
  Structure,
  Member,
  RawVariable,     // H5
  SystemFunction,  // _Wait
  Parameter,       // a number assigned to MOVLNK's Index
};

// A piece of a file. Files that are included several times count as one.
struct Place {
  const SourceFile* file = nullptr;
  uint32_t begin = 0;  // offsets in its text
  uint32_t end = 0;
  auto operator<=>(const Place&) const = default;
};

struct IndexedSymbol {
  SymbolKind kind = SymbolKind::Variable;
  std::string name;
  std::optional<Place> definition;  // of the name; nothing for what the language brings
  Place extent;                     // the whole declaration; for main file and headers
  std::string type;                 // "long[3]"; the text of a macro
  std::string structure;            // type of a variable or member when that is a structure
  std::string container;            // structure of a member
  std::optional<uint32_t> number;   // of the first variable; offset of a member; index of a parameter
  uint32_t count = 1;               // variables
  bool array = false;
  bool initial = false;
};

struct Occurrence {
  Place place;
  size_t symbol = 0;
  bool definition = false;
  std::optional<uint32_t> number;  // of the variable this very use means
};

struct ProgramIndex {
  std::shared_ptr<const SourceMap> sources;
  const SourceFile* main = nullptr;
  std::vector<IndexedSymbol> symbols;
  std::vector<Occurrence> occurrences;  // by file in order of the map, then offset; no two at one place
  struct Include {
    Place header;
    const SourceFile* file;
  };
  std::vector<Include> includes;

  // The occurrence an offset is in or directly after; nullptr when there is none.
  const Occurrence* at(const SourceFile& file, uint32_t offset) const;
  const IndexedSymbol* find(std::string_view name, std::string_view container = {}) const;
  // The file of this path, or the built-in header of this name; nullptr when the program does not read it.
  const SourceFile* file(std::string_view path_or_name) const;
};

// Path of a file, or the name of a built-in header.
const std::string& identity(const SourceFile& file);

// A program compiled, and its index made of what the compiler read: every keystroke in an editor asks for both.
struct IndexedCompilation {
  Compilation compiled;
  ProgramIndex index;
};
IndexedCompilation compile_indexed(const std::string& name, const std::string& path, std::string text,
                                   const CompileOptions& options);

}  // namespace ipos::compiler
