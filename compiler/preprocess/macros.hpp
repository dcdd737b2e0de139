// Macros without parameters: the table and the expansion.
#pragma once

#include <span>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "compiler/preprocess/preprocess.hpp"
#include "compiler/preprocess/word_filter.hpp"

namespace ipos::compiler {

struct Macro {
  Span name;  // in its #define
  std::span<const Token> body;  // of its definition in the record
  bool expanding = false;  // its name inside its own text stays as it is, as in C
};

class Macros {
 public:
  Macros(SourceMap& map, std::vector<PreprocessRecord::Use>& uses) : map_(map), uses_(uses) {}

  // nullptr when the name is no macro. Names live in the source text.
  const Macro* find(std::string_view name) const;
  void define(std::string_view name, Macro macro) {
    names_.add(name);
    macros_.insert_or_assign(name, macro);
  }
  void undefine(std::string_view name) { macros_.erase(name); }

  // Appends what the token stands for: itself or the text of a macro. Counts every token made down from
  // `budget`; false when that is used up.
  bool expand(const Token& token, std::vector<Token>& out, size_t& budget) {
    if (token.kind == TokenKind::Name && names_.may_have(token.text)) return replace(token, out, budget);
    out.push_back(token);
    return true;
  }

 private:
  bool replace(const Token& token, std::vector<Token>& out, size_t& budget);
  Macro* expandable(const Token& token);

  SourceMap& map_;
  std::vector<PreprocessRecord::Use>& uses_;
  std::unordered_map<std::string_view, Macro> macros_;
  WordFilter names_;
};

}  // namespace ipos::compiler
