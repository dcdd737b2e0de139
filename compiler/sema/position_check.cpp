// Two measured values may well be compared: that they are equal says that the axis stands. So both sides are followed: what
// is a measured position, shifted at most, and what is computed from one in any way.
#include "compiler/sema/position_check.hpp"

#include <algorithm>

#include "compiler/sema/command_writes.hpp"
#include "compiler/sema/expressions.hpp"
#include "compiler/sema/walk.hpp"
#include "compiler/sema/written.hpp"
#include "stdlib/system_variables.hpp"

namespace ipos::compiler {
namespace {

using checked::BinaryOp;
using checked::Expr;

constexpr uint32_t kMeasured[] = {stdlib::system_variable("ActPos_Abs"), stdlib::system_variable("ActPos_Ext"),
                                  stdlib::system_variable("ActPos_Mot"), stdlib::system_variable("ModActPos")};

class PositionCheck {
 public:
  PositionCheck(Context& context, const ProgramRoots& roots) : context_(context), roots_(roots) {
    for (const uint32_t number : kMeasured) plain_.set(number), derived_.set(number);
  }

  void run() {
    find_plain();
    find_derived();
    for (size_t n = 0; n < context_.program.functions.size(); ++n) {
      if (!roots_.alive[n]) continue;
      for (const Expr* expr : context_.contents[n].expressions)
        if (const auto* node = std::get_if<checked::Binary>(&expr->node); node != nullptr && node->op == BinaryOp::Eq) check(*expr);
      checked::walk_statements(context_.program.functions[n].body, [&](const checked::Stmt& stmt) {
        if (const auto* node = std::get_if<checked::While>(&stmt.node)) until_equal(node->condition);
        if (const auto* node = std::get_if<checked::DoWhile>(&stmt.node)) until_equal(node->condition);
        if (const auto* node = std::get_if<checked::For>(&stmt.node)) until_equal(node->condition);
      });
    }
  }

 private:
  static std::optional<uint32_t> number_of(const checked::Place& place) {
    const auto number = static_cast<uint32_t>(place.number);
    return place.offset == nullptr && number < kMaxNumbers ? std::optional(number) : std::nullopt;
  }

  bool is_derived(const Expr& expr) const {
    bool found = false;
    checked::walk(expr, [&](const Expr& inner) {
      const auto* load = std::get_if<checked::Load>(&inner.node);
      if (load == nullptr) return;
      const auto number = number_of(load->place);
      found = found || !number || derived_.test(*number);
    });
    return found;
  }

  // The position itself, or a distance from it.
  bool is_plain(const Expr& expr) const {
    if (const auto* load = std::get_if<checked::Load>(&expr.node)) {
      const auto number = number_of(load->place);
      return number && plain_.test(*number);
    }
    const auto* node = std::get_if<checked::Binary>(&expr.node);
    if (node == nullptr || (node->op != BinaryOp::Add && node->op != BinaryOp::Sub)) return false;
    return (is_plain(*node->left) && !is_derived(*node->right)) || (is_plain(*node->right) && !is_derived(*node->left));
  }

  template <typename Visit>
  void each_expression(Visit visit) const {
    for (size_t n = 0; n < context_.contents.size(); ++n)
      if (roots_.alive[n])
        for (const Expr* expr : context_.contents[n].expressions) visit(*expr);
  }

  // Variables that only take such a position, directly. One step: copies of copies are not followed.
  void find_plain() {
    Numbers only, other;
    each_expression([&](const Expr& expr) {
      const auto* node = std::get_if<checked::Assign>(&expr.node);
      const auto target = node != nullptr ? number_of(node->target) : std::nullopt;
      if (target && !node->op && is_plain(*node->value))
        only.set(*target);
      else
        written_by(expr, other);
    });
    for (const auto& [number, all] : context_.accesses)
      if (number < kMaxNumbers && !all.takers.empty()) other.set(number);
    for (const Variable& variable : context_.scope.variables())
      if (variable.storage == Storage::Global && variable.number < kMaxNumbers && only.test(variable.number) && !other.test(variable.number))
        plain_.set(variable.number);
  }

  // All that may hold something of a position: what is assigned from one, and what others than assignments write.
  void find_derived() {
    for (const auto& [number, all] : context_.accesses)
      if (number < kMaxNumbers && !all.takers.empty()) derived_.set(number);
    for (size_t before = 0; before != derived_.count();) {
      before = derived_.count();
      each_expression([&](const Expr& expr) {
        const auto* node = std::get_if<checked::Assign>(&expr.node);
        const bool plain = std::holds_alternative<checked::Step>(expr.node);
        if (!plain && (node == nullptr || is_derived(*node->value))) written_by(expr, derived_);
      });
    }
  }

  static void written_by(const Expr& expr, Numbers& numbers) {
    const auto mark = [&](uint32_t first, uint32_t count) {
      for (uint32_t n = first; n < first + count && n < kMaxNumbers; ++n) numbers.set(n);
    };
    const auto place = [&](const checked::Place& at, const std::optional<NumberRange>& within) {
      if (at.offset == nullptr) return mark(static_cast<uint32_t>(at.number), 1);
      if (within) mark(within->low, within->size());
    };
    if (const auto* node = std::get_if<checked::Step>(&expr.node)) place(node->place, node->within);
    if (const auto* node = std::get_if<checked::Assign>(&expr.node)) place(node->target, node->within);
    if (const auto* node = std::get_if<checked::CopyBlock>(&expr.node)) mark(node->target, node->count);
    if (const auto* node = std::get_if<checked::SystemCall>(&expr.node)) written_blocks(*node, mark);
  }

  void check(const Expr& comparison) {
    const auto& node = std::get<checked::Binary>(comparison.node);
    const bool exact = (is_plain(*node.left) && !is_derived(*node.right)) || (is_plain(*node.right) && !is_derived(*node.left));
    if (exact) context_.diagnostics.report(Diag::ExactPosition, comparison.span);
  }

  // while (ActPos_Mot != 5000): the loop waits for the value. Without a number on the other side it may look for movement.
  void until_equal(const checked::ExprPtr& condition) {
    if (condition == nullptr) return;
    const auto* node = std::get_if<checked::Binary>(&condition->node);
    if (node == nullptr) return;
    if (node->op == BinaryOp::LogicalAnd || node->op == BinaryOp::LogicalOr) return until_equal(node->left), until_equal(node->right);
    if (node->op == BinaryOp::Ne) check(*condition);
  }

  Context& context_;
  const ProgramRoots& roots_;
  Numbers plain_;
  Numbers derived_;
};

}  // namespace

void check_positions(Context& context, const ProgramRoots& roots) { PositionCheck(context, roots).run(); }

}  // namespace ipos::compiler
