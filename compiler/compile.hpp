// The whole compiler in one call: source text in, image and diagnostics out.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/ast/ast.hpp"
#include "compiler/diag/diag.hpp"
#include "compiler/preprocess/preprocess.hpp"
#include "compiler/sema/checked.hpp"
#include "stdlib/unit_types.hpp"
#include "vm/image/image.hpp"

namespace ipos::compiler {

struct CompileOptions {
  std::vector<std::string> include_dirs;  // -I
  std::vector<std::string> defines;       // -D NAME or NAME=TEXT
  // Text of a file, nothing when it cannot be read. Empty: only the built-in headers exist.
  std::function<std::optional<std::string>(const std::string& path)> read_file;
  std::function<std::vector<std::string>(const std::string& folder)> list_files;  // for hints; may be empty
  WarningOptions warnings;
  bool atomic = false;      // variables that others see get their values once
  bool as_written = false;  // -O0: each statement as it stands, for comparisons; else forms with fewer commands where nobody sees it
  // Whether a unit has a value of this name in traces, tests and tools; a variable that hides it gets a note. May be empty.
  std::function<bool(const stdlib::UnitType& unit, std::string_view name)> is_unit_value;
  // Null: mdxb for a source that includes constb.h or iob.h, else md60a.
  const stdlib::UnitType* unit = nullptr;
};

struct Compilation {
  std::shared_ptr<SourceMap> sources = std::make_shared<SourceMap>();
  Diagnostics diagnostics;
  const stdlib::UnitType* unit = nullptr;  // the one compiled for
  std::optional<vm::Image> image;          // set when there are no errors
  std::optional<vm::Image> too_long;       // instead of the image when that is the only error: for listings
  std::vector<checked::MapEntry> map;      // with either; temporaries included
  std::optional<checked::Program> program;  // what it was generated from, its map apart; set when it is checked without errors
};

// What the front end made of the text, for who wants more of it than the image (symbols/index.hpp). It refers to the sources.
struct FrontEnd {
  PreprocessedText text;
  ast::Program tree;  // empty where the text is not complete
};

// `name` is how messages call the file, `path` where it was read from ("" for standard input).
Compilation compile(const std::string& name, const std::string& path, std::string text,
                    const CompileOptions& options = {}, FrontEnd* front = nullptr);

}  // namespace ipos::compiler
