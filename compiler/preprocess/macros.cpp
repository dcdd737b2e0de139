// Expansion of macros. Works on a list of open macros instead of recursion, so a chain of any length is safe.
#include "compiler/preprocess/macros.hpp"

namespace ipos::compiler {

const Macro* Macros::find(std::string_view name) const {
  const auto found = macros_.find(name);
  return found == macros_.end() ? nullptr : &found->second;
}

Macro* Macros::expandable(const Token& token) {
  if (token.kind != TokenKind::Name || !names_.may_have(token.text)) return nullptr;
  const auto found = macros_.find(token.text);
  if (found == macros_.end() || found->second.expanding) return nullptr;
  uses_.push_back({token.span, found->second.name});
  return &found->second;
}

bool Macros::replace(const Token& token, std::vector<Token>& out, size_t& budget) {
  struct Open {
    Token use;
    Macro* macro;
    size_t next;
  };
  Macro* const first = expandable(token);
  if (first == nullptr) {
    out.push_back(token);
    return true;
  }
  std::vector<Open> open{{token, first, 0}};
  first->expanding = true;
  bool line_start = token.line_start;
  while (!open.empty()) {
    Open& top = open.back();
    if (top.next == top.macro->body.size() || budget == 0) {
      top.macro->expanding = false;
      open.pop_back();
      continue;
    }
    --budget;
    Token made = top.macro->body[top.next++];
    made.span.begin = map_.add_expansion(top.use.text, made.span.begin, top.use.span.begin);
    made.span.end = map_.add_expansion(top.use.text, made.span.end, top.use.span.end);
    made.line_start = false;
    if (Macro* const inner = expandable(made)) {
      inner->expanding = true;
      open.push_back({made, inner, 0});
    } else {
      made.line_start = line_start;
      line_start = false;
      out.push_back(made);
    }
  }
  return budget != 0;
}

}  // namespace ipos::compiler
