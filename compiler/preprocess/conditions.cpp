// #if, #ifdef, #ifndef, #elif, #else, #endif. In a branch that is left out only these are obeyed.
#include "compiler/preprocess/condition.hpp"
#include "compiler/preprocess/preprocessor.hpp"

namespace ipos::compiler {

bool Preprocessor::conditional(const Token& directive) {
  const std::string_view word = directive.text;
  if (word == "if" || word == "ifdef" || word == "ifndef")
    open_condition(directive);
  else if (word == "elif" || word == "else")
    next_branch(directive);
  else if (word == "endif")
    end_condition(directive);
  else
    return false;
  return true;
}

void Preprocessor::open_condition(const Token& directive) {
  const bool parent_live = live();
  const Line line = read_line();
  const bool taken = parent_live && holds(directive, line);
  files_.back().conditions.push_back({directive, parent_live, taken, taken});
}

void Preprocessor::next_branch(const Token& directive) {
  const Line line = read_line();
  std::vector<Condition>& conditions = files_.back().conditions;
  if (conditions.empty()) {
    diagnostics_.report(Diag::StrayConditional, directive.span, {std::string(directive.text)});
    return;
  }
  if (conditions.back().else_seen) {
    Diagnostic& error =
        diagnostics_.report(Diag::ConditionalAfterElse, directive.span, {std::string(directive.text)});
    error.notes.push_back({conditions.back().directive.span, "the condition begins here"});
    conditions.back().live = false;
    return;
  }
  const bool is_else = directive.text == "else";
  const bool open = conditions.back().parent_live && !conditions.back().taken;
  const bool now = open && (is_else || holds(directive, line));
  Condition& top = conditions.back();
  top.live = now;
  top.taken = top.taken || now;
  top.else_seen = is_else;
  if (is_else && top.parent_live) no_more(directive, line, 0);
}

void Preprocessor::end_condition(const Token& directive) {
  const Line line = read_line();
  std::vector<Condition>& conditions = files_.back().conditions;
  if (conditions.empty()) {
    diagnostics_.report(Diag::StrayConditional, directive.span, {std::string(directive.text)});
    return;
  }
  if (conditions.back().parent_live) no_more(directive, line, 0);
  conditions.pop_back();
}

bool Preprocessor::holds(const Token& directive, const Line& line) {
  if (directive.text == "ifdef" || directive.text == "ifndef") {
    if (!macro_name(directive, line)) return false;
    no_more(directive, line, 1);
    macro_used(line[0]);
    return (macros_.find(line[0].text) != nullptr) == (directive.text == "ifdef");
  }
  bool good = true;
  const Line plain = replace_defined(directive, line, good);
  return good && evaluate_condition(expand(plain), directive, diagnostics_).value_or(false);
}

// `defined NAME` and `defined(NAME)` become 1 or 0 before macros are expanded.
Preprocessor::Line Preprocessor::replace_defined(const Token& directive, const Line& line, bool& good) {
  Line plain;
  for (size_t i = 0; i < line.size(); ++i) {
    if (line[i].kind != TokenKind::Name || line[i].text != "defined") {
      plain.push_back(line[i]);
      continue;
    }
    const bool bracket = i + 1 < line.size() && line[i + 1].kind == TokenKind::LeftParen;
    const size_t name = i + (bracket ? 2 : 1);
    const size_t last = name + (bracket ? 1 : 0);
    if (last >= line.size() || line[name].kind != TokenKind::Name ||
        (bracket && line[last].kind != TokenKind::RightParen)) {
      diagnostics_.report(Diag::BadCondition, line[i].span,
                          {std::string(directive.text), "write defined NAME or defined(NAME)"});
      good = false;
      return plain;
    }
    macro_used(line[name]);
    Token value = line[i];
    value.kind = TokenKind::Number;
    value.span.end = line[last].span.end;
    value.text = macros_.find(line[name].text) != nullptr ? "1" : "0";
    plain.push_back(value);
    i = last;
  }
  return plain;
}

}  // namespace ipos::compiler
