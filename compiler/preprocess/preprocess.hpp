// The preprocessor: from the main file to one list of tokens, with includes, macros and conditions done.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/diag/diag.hpp"
#include "compiler/preprocess/token.hpp"
#include "stdlib/embedded.hpp"

namespace ipos::compiler {

struct PreprocessOptions {
  std::vector<std::string> include_dirs;          // -I, in order
  std::vector<std::string> defines;               // -D: "NAME" (means 1) or "NAME=TEXT"
  std::span<const stdlib::EmbeddedFile> headers;  // built-in ones, searched last
  // Text of a file, nothing when it cannot be read. Empty function: only the built-in headers exist.
  std::function<std::optional<std::string>(const std::string& path)> read_file;
  // Names of the files in a folder ("" is the current one), for hints only. May be empty.
  std::function<std::vector<std::string>(const std::string& folder)> list_files;
  // Tokens read or made by macros; more is an error. Far above any program a drive could hold (ours).
  size_t max_tokens = 1'000'000;
};

// What the directives of the text were about; for editors, which look names up in them.
struct PreprocessRecord {
  struct Definition {
    Span name;
    std::vector<Token> body;
  };
  struct Use {
    Span name;        // in the text or in the body of another macro
    Span definition;  // name in the #define
  };
  struct Include {
    Span header;  // with its quotes or brackets
    const SourceFile* file;
  };
  struct LeftOut {
    Span name;
    Span condition;  // the #if that leaves it out, itself or an #else of it
  };
  std::vector<Definition> definitions;
  std::vector<Use> uses;
  std::map<std::string_view, LeftOut> left_out;  // names that are declared or defined there, the first place of each
  std::vector<Include> includes;
};

struct PreprocessedText {
  std::vector<Token> tokens;  // the last one is End
  PreprocessRecord record;
  // False when an include failed or a limit was reached: names would be missing, so that syntax messages
  // would mislead.
  bool complete = true;
};

// The tokens refer to the text in `map`. #pragma and #declare stay in the list, each closed by a
// DirectiveEnd.
PreprocessedText preprocess(SourceMap& map, const SourceFile& main, const PreprocessOptions& options,
                            Diagnostics& diagnostics);

}  // namespace ipos::compiler
