// The scanner: cuts one source file into tokens. Knows nothing of directives, macros or words of the
// language.
#pragma once

#include <memory>

#include "compiler/diag/diag.hpp"
#include "compiler/preprocess/token.hpp"

namespace ipos::compiler {

class Scanner {
 public:
  // File and diagnostics must outlive the scanner.
  Scanner(const SourceFile& file, Diagnostics& diagnostics);
  ~Scanner();
  Scanner(Scanner&&) noexcept;
  Scanner& operator=(Scanner&&) noexcept;

  // The next token; at the end of the file End, again and again.
  Token next();

  // As next(), but <...> and "..." are a HeaderName: for the place after #include.
  Token header_name();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace ipos::compiler
