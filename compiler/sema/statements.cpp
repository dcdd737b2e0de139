// Statements of a function.
#include "compiler/sema/statements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "compiler/sema/decided.hpp"

namespace ipos::compiler {
namespace {

using checked::StmtPtr;

template <typename... Kinds>
bool is_one_of(const ast::Stmt& stmt) {
  return (std::holds_alternative<Kinds>(stmt.node) || ...);
}

bool always(const checked::ExprPtr& condition) {
  const int32_t* known = constant_value(condition);
  return known != nullptr && *known != 0;
}

}  // namespace

StatementChecker::Result StatementChecker::statement(const ast::Stmt& stmt) {
  return std::visit([&](const auto& node) { return check(node, stmt.span); }, stmt.node);
}

StatementChecker::Result StatementChecker::check(const ast::Empty&, Span span) {
  return {make_stmt(span, checked::Block{}), true};
}

StatementChecker::Result StatementChecker::check(const ast::ExprStmt& node, Span span) {
  return {make_stmt(span, checked::ExprStmt{expressions_.effect(*node.expr)}), true};
}

StatementChecker::Result StatementChecker::check(const ast::Block& node, Span span) {
  return block(node, span, true);
}

StatementChecker::Result StatementChecker::block(const ast::Block& node, Span span, bool reached) {
  std::vector<StmtPtr> body;
  bool reported = false;
  const ast::Stmt* before = nullptr;
  for (const ast::Stmt* stmt : node.body) {
    if (is_one_of<ast::Case, ast::Default>(*stmt)) {
      if (reached && before != nullptr && !is_one_of<ast::Case, ast::Default>(*before) &&
          !meant(*before, *stmt))
        context_.diagnostics.report(Diag::FallThrough, stmt->span);
      reached = true;
      reported = false;
    }
    const Frame* around = innermost_switch();
    const size_t labels = around == nullptr ? 0 : around->target->labels;
    Result result = statement(*stmt);
    // A label inside, as in switch (x) { while (1) { case 1: ... } }, is a way in.
    if (around != nullptr && innermost_switch()->target->labels != labels) reached = true;
    // A break after a return is a habit of case branches, not a mistake.
    if (!reached && !reported && !is_one_of<ast::Empty, ast::Break>(*stmt)) {
      context_.diagnostics.report(Diag::UnreachableCode, stmt->span);
      reported = true;
    }
    reached = reached && result.falls_through;
    body.push_back(result.stmt);
    before = stmt;
  }
  return {make_stmt(span, checked::Block{context_.program.arena.list(body)}), reached};
}

// A comment between the two says "falls through", "fallthrough" or the like.
bool StatementChecker::meant(const ast::Stmt& before, const ast::Stmt& label) const {
  const SourceFile* file = context_.sources.file_of(label.span.begin);
  if (file == nullptr || label.span.begin.in_macro() || before.span.end.in_macro()) return false;
  const uint32_t begin = before.span.end.value - file->base;
  const uint32_t end = label.span.begin.value - file->base;
  if (begin > end || end > file->text.size()) return false;
  std::string between = file->text.substr(begin, end - begin);
  std::transform(between.begin(), between.end(), between.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return between.find("fall") != std::string::npos;
}

StatementChecker::Result StatementChecker::check(const ast::If& node, Span span) {
  checked::ExprPtr condition = expressions_.condition(*node.condition);
  check_decided(*node.condition, condition, ConditionOf::Choice, context_);
  if (is_one_of<ast::Empty>(*node.then) && node.otherwise == nullptr)
    context_.diagnostics.report(Diag::EmptyIf, node.then->span);
  Result then = statement(*node.then);
  Result otherwise;
  if (node.otherwise != nullptr) otherwise = statement(*node.otherwise);
  const bool falls_through = then.falls_through || otherwise.falls_through;
  return {make_stmt(span, checked::If{condition, then.stmt, otherwise.stmt}), falls_through};
}

StatementChecker::Result StatementChecker::check(const ast::While& node, Span span) {
  checked::ExprPtr condition = expressions_.condition(*node.condition);
  check_decided(*node.condition, condition, ConditionOf::Loop, context_);
  frames_.push_back({});
  Result body = statement(*node.body);
  const bool falls_through = frames_.back().left_by_break || !always(condition);
  frames_.pop_back();
  return {make_stmt(span, checked::While{condition, body.stmt}), falls_through};
}

StatementChecker::Result StatementChecker::check(const ast::DoWhile& node, Span span) {
  frames_.push_back({});
  Result body = statement(*node.body);
  checked::ExprPtr condition = expressions_.condition(*node.condition);
  check_decided(*node.condition, condition, ConditionOf::LoopEnd, context_);
  const bool falls_through = frames_.back().left_by_break || !always(condition);
  frames_.pop_back();
  return {make_stmt(span, checked::DoWhile{body.stmt, condition}), falls_through};
}

StatementChecker::Result StatementChecker::check(const ast::For& node, Span span) {
  checked::For out;
  if (node.init != nullptr) out.init = expressions_.effect(*node.init);
  if (node.condition != nullptr) {
    out.condition = expressions_.condition(*node.condition);
    check_decided(*node.condition, out.condition, ConditionOf::Loop, context_);
  }
  if (node.step != nullptr) out.step = expressions_.effect(*node.step);
  frames_.push_back({});
  out.body = statement(*node.body).stmt;
  const bool endless = node.condition == nullptr || always(out.condition);
  const bool falls_through = frames_.back().left_by_break || !endless;
  frames_.pop_back();
  return {make_stmt(span, out), falls_through};
}

StatementChecker::Result StatementChecker::check(const ast::Switch& node, Span span) {
  checked::Switch out;
  out.value = expressions_.value(*node.value);
  frames_.push_back({&out});
  const auto* body = std::get_if<ast::Block>(&node.body->node);
  // Nothing in front of the first label is ever reached.
  Result inside = body != nullptr ? block(*body, node.body->span, false) : statement(*node.body);
  const bool falls_through = inside.falls_through || frames_.back().left_by_break || !out.otherwise;
  out.cases = context_.program.arena.list(frames_.back().cases);
  frames_.pop_back();
  out.body = inside.stmt;
  return {make_stmt(span, out), falls_through};
}

StatementChecker::Result StatementChecker::check(const ast::Case& node, Span span) {
  const auto value = expressions_.constant(*node.value, "the value of a case");
  Frame* frame = innermost_switch();
  if (frame == nullptr) {
    context_.diagnostics.report(Diag::OutsideSwitch, span, {"case"});
    return {make_stmt(span, checked::Block{}), true};
  }
  checked::Switch* target = frame->target;
  if (value) {
    const auto same = [&](const auto& row) { return row.first == *value; };
    const auto first = std::find_if(frame->cases.begin(), frame->cases.end(), same);
    if (first != frame->cases.end()) {
      const Span place = frame->places[static_cast<size_t>(first - frame->cases.begin())];
      context_.diagnostics.report(Diag::DuplicateCase, span, {fmt::format("{}", *value)})
          .notes.push_back({place, "the first one is here"});
    }
    frame->cases.emplace_back(*value, target->labels);
    frame->places.push_back(span);
  }
  return {make_stmt(span, checked::CaseLabel{target->labels++}), true};
}

StatementChecker::Result StatementChecker::check(const ast::Default&, Span span) {
  Frame* frame = innermost_switch();
  if (frame == nullptr) {
    context_.diagnostics.report(Diag::OutsideSwitch, span, {"default"});
    return {make_stmt(span, checked::Block{}), true};
  }
  checked::Switch* target = frame->target;
  if (target->otherwise)
    context_.diagnostics.report(Diag::DuplicateDefault, span)
        .notes.push_back({frame->otherwise, "the first one is here"});
  else
    frame->otherwise = span;
  target->otherwise = target->labels;
  return {make_stmt(span, checked::CaseLabel{target->labels++}), true};
}

StatementChecker::Result StatementChecker::check(const ast::Break&, Span span) {
  // A misplaced break or continue leads nowhere; what follows it is not unreachable because of it.
  const bool misplaced = frames_.empty();
  if (misplaced)
    context_.diagnostics.report(Diag::OutsideLoop, span, {"break", "loop or switch"});
  else
    frames_.back().left_by_break = true;
  return {make_stmt(span, checked::Break{}), misplaced};
}

StatementChecker::Result StatementChecker::check(const ast::Continue&, Span span) {
  const auto is_loop = [](const Frame& frame) { return frame.target == nullptr; };
  const bool misplaced = std::none_of(frames_.begin(), frames_.end(), is_loop);
  if (misplaced) context_.diagnostics.report(Diag::OutsideLoop, span, {"continue", "loop"});
  return {make_stmt(span, checked::Continue{}), misplaced};
}

StatementChecker::Result StatementChecker::check(const ast::Return&, Span span) {
  return {make_stmt(span, checked::Return{}), false};
}

StatementChecker::Frame* StatementChecker::innermost_switch() {
  for (auto frame = frames_.rbegin(); frame != frames_.rend(); ++frame)
    if (frame->target != nullptr) return &*frame;
  return nullptr;
}

}  // namespace ipos::compiler
