// Mistakes that can be planted into a checked program: nodes of its tree, and what they become. The tree stays one and the
// same: toggle() plants a mistake, and a second time takes it out again.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/sema/checked.hpp"

namespace ipos::compiler::mutants {

enum class Kind : uint8_t { Constant, Comparison, Condition, Sign, Statement, Variables, Mask, Wait };
std::string_view word_of(Kind kind);

// The part of a program that has a mistake.
struct Site {
  Span text;      // the statement, of an `if` or a loop its head: where a comment behind it speaks of it
  Span executed;  // what is executed before the mistake can be seen; for a `case` the head of its `switch`
  Span function;
};

struct Change {
  Kind kind;
  Location at;              // in a file, in no macro
  std::string text;         // "< became <="
  std::vector<Site> sites;  // several when it stands in the text of a macro
  std::vector<std::pair<checked::Expr*, checked::Expr>> exprs;  // a node, and what it becomes
  std::vector<std::pair<checked::Stmt*, checked::Stmt>> stmts;

  void toggle();
};

// In the order of the source. None is in a built-in header; what a macro of such a header stands for is changed where the
// macro is used. A mistake in the text of a macro of the program is in all of its uses at once.
std::vector<Change> find_changes(checked::Program& program, const SourceMap& sources);

}  // namespace ipos::compiler::mutants
