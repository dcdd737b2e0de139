// The front end as a whole: from a source file to its tree.
#pragma once

#include <string>

#include "compiler/ast/ast.hpp"
#include "compiler/diag/diag.hpp"
#include "compiler/preprocess/preprocess.hpp"

namespace ipos::compiler {

// Always returns a tree of what could be understood, fit for printing. It is the whole program only when
// `diagnostics` has no errors; look at nothing but its text otherwise.
ast::Program parse_program(SourceMap& map, const SourceFile& main, const PreprocessOptions& options,
                           Diagnostics& diagnostics);

// The same from tokens that are there already.
ast::Program parse_tokens(const SourceMap& map, const PreprocessedText& text, Diagnostics& diagnostics);

// The tokens after the preprocessor, one a line: `line:col kind text`, with the file in front when it is not
// `main`.
std::string print_tokens(const SourceMap& map, const SourceFile& main, const PreprocessedText& text);

}  // namespace ipos::compiler
