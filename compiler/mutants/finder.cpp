// Statements, and the list of what has been found.
#include "compiler/mutants/finder.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "compiler/sema/fold.hpp"

namespace ipos::compiler::mutants {

using checked::Expr;
using checked::Stmt;

std::string_view word_of(Kind kind) {
  switch (kind) {
    case Kind::Constant: return "constant";
    case Kind::Comparison: return "comparison";
    case Kind::Condition: return "condition";
    case Kind::Sign: return "sign";
    case Kind::Statement: return "statement";
    case Kind::Variables: return "variables";
    case Kind::Mask: return "mask";
    case Kind::Wait: return "wait";
  }
  return "";
}

void Change::toggle() {
  for (auto& [node, other] : exprs) std::swap(*node, other);
  for (auto& [node, other] : stmts) std::swap(*node, other);
}

std::vector<Change> find_changes(checked::Program& program, const SourceMap& sources) {
  return Finder(program, sources).run();
}

std::vector<Change> Finder::run() {
  for (const checked::Function& function : program_.functions) {
    if (function.body == nullptr) continue;
    site_.function = function.body->span;
    statement(*function.body);
  }
  std::stable_sort(changes_.begin(), changes_.end(),
                   [](const Change& a, const Change& b) { return a.at.value < b.at.value; });
  return std::move(changes_);
}

// A mistake in the text of a macro is one, however often the macro is used. A macro of a built-in header is right: what
// may be wrong is which one is used, so one change of its value is enough.
void Finder::add(Kind kind, Span span, std::string text, Edits edits) {
  const std::optional<MacroUse> macro = texts_.macro_of(span);
  Location at = texts_.use(span.begin);
  if (macro) {
    const bool named = text.starts_with(macro->name);  // DI10 became !DI10
    if (!named) text = fmt::format("{}: {}", macro->name, text);
    if (!macro->built_in)
      at = texts_.spelling(span.begin);
    else if (kind != Kind::Condition && !built_in_.insert(macro->use.value).second)
      return;
  }
  if (!texts_.is_own(at)) return;
  if (macro && !macro->built_in) {
    const auto [known, is_new] = in_macros_.try_emplace({at.value, text}, changes_.size());
    if (!is_new) {
      Change& same = changes_[known->second];
      same.sites.push_back(site_);
      same.exprs.insert(same.exprs.end(), edits.exprs.begin(), edits.exprs.end());
      same.stmts.insert(same.stmts.end(), edits.stmts.begin(), edits.stmts.end());
      return;
    }
  }
  changes_.push_back({kind, at, std::move(text), {site_}, std::move(edits.exprs), std::move(edits.stmts)});
}

void Finder::at_head(Location begin, Location end) { site_.text = site_.executed = {begin, end}; }

void Finder::statement(Stmt& stmt) {
  std::visit([&](auto& node) { find_in(stmt, node); }, stmt.node);
}

void Finder::remove(Stmt& stmt, Kind kind) {
  add(kind, stmt.span, fmt::format("removed: {}", texts_.written(stmt.span)),
      {.stmts = {{&stmt, {stmt.span, checked::Block{}}}}});
}

void Finder::find_in(Stmt& stmt, checked::ExprStmt& node) {
  at_head(stmt.span.begin, stmt.span.end);
  remove(stmt, Kind::Statement);
  part(*node.expr);
}

void Finder::find_in(Stmt&, checked::Block& node) {
  for (Stmt* inner : node.body) statement(*inner);
}

void Finder::find_in(Stmt& stmt, checked::If& node) {
  at_head(stmt.span.begin, node.condition->span.end);
  condition_part(*node.condition);
  statement(*node.then);
  if (node.otherwise != nullptr) statement(*node.otherwise);
}

// A loop with nothing in it is a wait. One without end has no condition that is executed: to be in it is enough.
void Finder::find_in(Stmt& stmt, checked::While& node) {
  at_head(stmt.span.begin, node.condition->span.end);
  const auto* body = std::get_if<checked::Block>(&node.body->node);
  const bool is_endless = std::holds_alternative<checked::Constant>(node.condition->node);
  if (is_endless) {
    site_.executed = stmt.span;
  } else if (body != nullptr && body->body.empty()) {
    site_.text = stmt.span;
    remove(stmt, Kind::Wait);
  }
  condition_part(*node.condition);
  statement(*node.body);
}

void Finder::find_in(Stmt&, checked::DoWhile& node) {
  statement(*node.body);
  at_head(node.condition->span.begin, node.condition->span.end);
  condition_part(*node.condition);
}

void Finder::find_in(Stmt& stmt, checked::For& node) {
  Location end = stmt.span.begin;
  for (const Expr* one : {node.init, node.condition, node.step})
    if (one != nullptr) end = one->span.end;
  at_head(stmt.span.begin, end);
  part_of_for(stmt, &checked::For::init);
  if (node.condition == nullptr || std::holds_alternative<checked::Constant>(node.condition->node)) site_.executed = stmt.span;
  if (node.condition != nullptr) condition_part(*node.condition);
  part_of_for(stmt, &checked::For::step);
  statement(*node.body);
}

void Finder::part_of_for(Stmt& stmt, checked::ExprPtr checked::For::*which) {
  const auto& node = std::get<checked::For>(stmt.node);
  if (node.*which == nullptr) return;
  checked::For without = node;
  without.*which = nullptr;
  const Span span = (node.*which)->span;
  add(Kind::Statement, span, fmt::format("removed: {}", texts_.written(span)), {.stmts = {{&stmt, {stmt.span, without}}}});
  part(*(node.*which));
}

void Finder::find_in(Stmt& stmt, checked::Switch& node) {
  at_head(stmt.span.begin, node.value->span.end);
  switches_.push_back(&stmt);
  heads_.push_back(site_.executed);
  part(*node.value);
  statement(*node.body);
  switches_.pop_back();
  heads_.pop_back();
}

void Finder::find_in(Stmt& stmt, checked::CaseLabel& node) {
  Stmt& around = *switches_.back();
  checked::Switch other = std::get<checked::Switch>(around.node);
  std::vector<std::pair<int32_t, size_t>> cases(other.cases.begin(), other.cases.end());
  const auto row = std::find_if(cases.begin(), cases.end(), [&](const auto& one) { return one.second == node.label; });
  if (row == cases.end()) return;  // default
  const int32_t before = row->first;
  const auto is_taken = [&](int32_t value) {
    return std::any_of(other.cases.begin(), other.cases.end(), [&](const auto& one) { return one.first == value; });
  };
  while (is_taken(row->first)) row->first = *fold(checked::BinaryOp::Add, row->first, 1);
  site_.text = stmt.span;
  site_.executed = heads_.back();
  other.cases = program_.arena.list(cases);
  add(Kind::Constant, stmt.span, fmt::format("case {} became case {}", before, row->first),
      {.stmts = {{&around, {around.span, other}}}});
}

void Finder::find_in(Stmt& stmt, checked::Break&) {
  at_head(stmt.span.begin, stmt.span.end);
  remove(stmt, Kind::Statement);
}

void Finder::find_in(Stmt& stmt, checked::Continue&) {
  at_head(stmt.span.begin, stmt.span.end);
  remove(stmt, Kind::Statement);
}

void Finder::find_in(Stmt& stmt, checked::Return&) {
  at_head(stmt.span.begin, stmt.span.end);
  remove(stmt, Kind::Statement);
}

}  // namespace ipos::compiler::mutants
