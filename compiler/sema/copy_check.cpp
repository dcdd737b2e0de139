// `before = now; if (now && !before)`: an edge that is never seen. Only variables of one task, whose number nobody takes,
// and only what follows the copy in its own block.
#include "compiler/sema/copy_check.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "compiler/sema/command_writes.hpp"
#include "compiler/sema/expressions.hpp"
#include "compiler/sema/fold.hpp"
#include "compiler/sema/walk.hpp"
#include "compiler/sema/timers.hpp"
#include "stdlib/system_variables.hpp"

namespace ipos::compiler {
namespace {

using checked::BinaryOp;
using checked::ExprPtr;


std::optional<uint32_t> plain_load(const ExprPtr& expr) {
  const auto* load = expr == nullptr ? nullptr : std::get_if<checked::Load>(&expr->node);
  if (load == nullptr || load->place.offset != nullptr) return std::nullopt;
  return static_cast<uint32_t>(load->place.number);
}

class CopyCheck {
 public:
  CopyCheck(Context& context, const ProgramRoots& roots, const Written& written)
      : context_(context), roots_(roots), written_(written) {}

  void run() {
    for (size_t n = 0; n < context_.program.functions.size(); ++n) {
      if (!roots_.alive[n] || roots_.of[n].size() != 1) continue;
      root_ = roots_.of[n].front();
      checked::walk_statements(context_.program.functions[n].body, [&](const checked::Stmt& stmt) {
        const auto* block = std::get_if<checked::Block>(&stmt.node);
        for (size_t at = 0; block != nullptr && at + 1 < block->body.size(); ++at) follow(block->body, at);
      });
    }
    for (const uint32_t timer : kTimers) check_timer(timer);
  }

 private:
  struct Copy {
    uint32_t to, from;
    Span place;
  };

  // Written by this task alone, and nothing of the unit.
  bool is_own(uint32_t number) const {
    const auto found = context_.accesses.find(number);
    if (number >= stdlib::kFirstSystemVariable || found == context_.accesses.end() || !found->second.takers.empty()) return false;
    const bool declared = std::any_of(context_.scope.variables().begin(), context_.scope.variables().end(), [&](const Variable& one) {
      return one.storage == Storage::Global && number >= one.number && number < one.number + one.type.size();
    });
    return declared && !context_.raw_names.contains(number) &&
           std::all_of(found->second.writers.begin(), found->second.writers.end(), [&](const AccessPlace& writer) {
             return std::all_of(roots_.of[writer.function].begin(), roots_.of[writer.function].end(),
                                [&](size_t root) { return root == root_; });
           });
  }

  void follow(std::span<const checked::StmtPtr> body, size_t at) {
    const auto* stmt = std::get_if<checked::ExprStmt>(&body[at]->node);
    const auto* assign = stmt == nullptr || stmt->expr == nullptr ? nullptr : std::get_if<checked::Assign>(&stmt->expr->node);
    if (assign == nullptr || assign->op || assign->target.offset != nullptr) return;
    const auto from = plain_load(assign->value);
    const Copy copy{static_cast<uint32_t>(assign->target.number), from.value_or(0), stmt->expr->span};
    if (!from || copy.to == copy.from || !is_own(copy.to) || !is_own(copy.from)) return;
    for (size_t next = at + 1; next < body.size(); ++next) {
      if (std::holds_alternative<checked::CaseLabel>(body[next]->node)) return;
      if (const auto* test = std::get_if<checked::If>(&body[next]->node); test != nullptr && !has_effect(*test->condition))
        if (const auto truth = outcome(*test->condition, copy)) {
          context_.diagnostics.report(Diag::DecidedCondition, test->condition->span, {*truth ? "always" : "never"})
              .notes.push_back({copy.place, "the two are equal since here"});
          return;
        }
      Numbers changed;
      written_.add(*body[next], changed);
      if (changed.test(copy.to) || changed.test(copy.from)) return;
    }
  }

  static bool is_one(const ExprPtr& expr, const Copy& copy) {
    const auto number = plain_load(expr);
    return number && (*number == copy.to || *number == copy.from);
  }

  // Of conditions that look at both.
  static std::optional<bool> outcome(const checked::Expr& expr, const Copy& copy) {
    const auto* node = std::get_if<checked::Binary>(&expr.node);
    if (node == nullptr) return std::nullopt;
    const auto both = [&](const ExprPtr& a, const ExprPtr& b) { return is_one(a, copy) && is_one(b, copy) && plain_load(a) != plain_load(b); };
    if (is_comparison(node->op) && both(node->left, node->right)) return fold(node->op, 0, 0) != 0;
    if (node->op == BinaryOp::Xor && both(node->left, node->right)) return false;
    if (node->op != BinaryOp::LogicalAnd && node->op != BinaryOp::And) return std::nullopt;
    std::vector<ExprPtr> parts;
    collect(*node, node->op, parts);
    for (const ExprPtr& part : parts) {
      if (outcome(*part, copy) == false) return false;
      const auto* no = std::get_if<checked::Unary>(&part->node);
      if (no == nullptr || no->op != checked::UnaryOp::Not) continue;
      for (const ExprPtr& other : parts)
        if (both(no->operand, other)) return false;
    }
    return std::nullopt;
  }

  static void collect(const checked::Binary& node, BinaryOp op, std::vector<ExprPtr>& parts) {
    for (const ExprPtr& side : {node.left, node.right}) {
      const auto* inner = std::get_if<checked::Binary>(&side->node);
      if (inner != nullptr && inner->op == op)
        collect(*inner, op, parts);
      else
        parts.push_back(side);
    }
  }

  template <typename Visit>
  void each_expression(Visit visit) const {
    for (size_t n = 0; n < context_.contents.size(); ++n)
      if (roots_.alive[n])
        for (const checked::Expr* expr : context_.contents[n].expressions) visit(*expr);
  }

  // The largest constant that is assigned to it; nothing where something else is, too.
  std::optional<int32_t> most(uint32_t number) const {
    const auto found = context_.accesses.find(number);
    if (found != context_.accesses.end() && !found->second.takers.empty()) return std::nullopt;
    int32_t highest = 0;
    bool known = true;
    each_expression([&](const checked::Expr& expr) {
      const auto* node = std::get_if<checked::Assign>(&expr.node);
      const bool here = node != nullptr && node->target.offset == nullptr && static_cast<uint32_t>(node->target.number) == number;
      const int32_t* constant = here && !node->op ? constant_value(node->value) : nullptr;
      if (here) known = known && constant != nullptr;
      if (constant != nullptr) highest = std::max(highest, *constant);
      if (here) return;
      const auto place = [&](const checked::Place& at, const std::optional<NumberRange>& within) {
        if (at.offset == nullptr ? static_cast<uint32_t>(at.number) == number : within && number >= within->low && number <= within->high)
          known = false;
      };
      if (node != nullptr) place(node->target, node->within);
      if (const auto* step = std::get_if<checked::Step>(&expr.node)) place(step->place, step->within);
      if (const auto* call = std::get_if<checked::SystemCall>(&expr.node))
        written_blocks(*call, [&](uint32_t first, uint32_t count) { known = known && (number < first || number >= first + count); });
    });
    return known ? std::optional(highest) : std::nullopt;
  }

  // Timer_1 > 1000, where it is never more than 1000.
  void check_timer(uint32_t timer) {
    auto highest = most(timer);
    if (timer == kTimers[0] && highest) {
      const auto reload = most(kReload);
      highest = reload ? std::optional(std::max(*highest, *reload)) : std::nullopt;
    }
    const auto found = context_.accesses.find(timer);
    const bool set = found != context_.accesses.end() && !found->second.writers.empty();
    if (!highest || (*highest == 0 && !set)) return;  // a timer that nobody sets: program_check.cpp
    each_expression([&](const checked::Expr& expr) {
      const auto* node = std::get_if<checked::Binary>(&expr.node);
      if (node == nullptr) return;
      const bool left = plain_load(node->left) == timer, right = plain_load(node->right) == timer;
      const int32_t* limit = left ? constant_value(node->right) : right ? constant_value(node->left) : nullptr;
      if (limit == nullptr) return;
      const bool above = node->op == (left ? BinaryOp::Gt : BinaryOp::Lt) && *limit >= *highest;
      const bool at = node->op == (left ? BinaryOp::Ge : BinaryOp::Le) && *limit > *highest;
      if (above || at)
        context_.diagnostics.report(Diag::DecidedCondition, expr.span, {"never"})
            .notes.push_back({{}, fmt::format("the timer counts down, and the program sets it to {} at most", *highest)});
    });
  }

  Context& context_;
  const ProgramRoots& roots_;
  const Written& written_;
  size_t root_ = 0;
};

}  // namespace

void check_copies(Context& context, const ProgramRoots& roots, const Written& written) { CopyCheck(context, roots, written).run(); }

}  // namespace ipos::compiler
