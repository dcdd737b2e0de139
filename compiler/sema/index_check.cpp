// Counters from a constant to a constant that only the loop itself moves, in loops that are not left early; of what their
// bodies use, only what no condition keeps them from.
#include "compiler/sema/index_check.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "compiler/sema/expressions.hpp"
#include "compiler/sema/fold.hpp"
#include "compiler/sema/walk.hpp"

namespace ipos::compiler {
namespace {

using checked::BinaryOp;
using checked::ExprPtr;

struct Counter {
  uint32_t number;
  int64_t first, last;  // in the turns that are done
};

// a * counter + b
struct Line {
  int64_t factor;
  int64_t fixed;
};

std::optional<Line> line_of(const ExprPtr& expr, uint32_t counter) {
  if (expr == nullptr) return Line{0, 0};
  if (const int32_t* known = constant_value(expr)) return Line{0, *known};
  if (const auto* load = std::get_if<checked::Load>(&expr->node)) {
    if (load->place.offset != nullptr || static_cast<uint32_t>(load->place.number) != counter) return std::nullopt;
    return Line{1, 0};
  }
  const auto* node = std::get_if<checked::Binary>(&expr->node);
  if (node == nullptr) return std::nullopt;
  const auto left = line_of(node->left, counter), right = line_of(node->right, counter);
  if (!left || !right) return std::nullopt;
  switch (node->op) {
    case BinaryOp::Add: return Line{left->factor + right->factor, left->fixed + right->fixed};
    case BinaryOp::Sub: return Line{left->factor - right->factor, left->fixed - right->fixed};
    case BinaryOp::Mul:
      if (left->factor == 0) return Line{left->fixed * right->factor, left->fixed * right->fixed};
      if (right->factor == 0) return Line{left->factor * right->fixed, left->fixed * right->fixed};
      return std::nullopt;
    default: return std::nullopt;
  }
}

class IndexCheck {
 public:
  IndexCheck(Context& context, const ProgramRoots& roots, const Written& written)
      : context_(context), roots_(roots), written_(written) {}

  void run() {
    for (size_t n = 0; n < context_.program.functions.size(); ++n)
      if (roots_.alive[n])
        checked::walk_statements(context_.program.functions[n].body, [&](const checked::Stmt& stmt) {
          const auto* loop = std::get_if<checked::For>(&stmt.node);
          const auto counter = loop == nullptr ? std::nullopt : counter_of(*loop);
          if (!counter || leaves(*loop->body)) return;
          counter_ = *counter;
          always(loop->body);
        });
  }

 private:
  static bool leaves(const checked::Stmt& body) {
    bool out = false;
    checked::walk_statements(const_cast<checked::Stmt*>(&body), [&](const checked::Stmt& stmt) {
      out = out || std::holds_alternative<checked::Break>(stmt.node) || std::holds_alternative<checked::Continue>(stmt.node) ||
            std::holds_alternative<checked::Return>(stmt.node);
    });
    return out;
  }

  const Variable* variable_of(int64_t number) const {
    for (const Variable& variable : context_.scope.variables())
      if (variable.storage != Storage::Alias && number >= int64_t{variable.number} &&
          number < int64_t{variable.number} + variable.type.size())
        return &variable;
    return nullptr;
  }

  // for (i = FIRST; i < LIMIT; i++), of a variable of one task that the body does not write.
  std::optional<Counter> counter_of(const checked::For& loop) const {
    const auto* init = loop.init != nullptr ? std::get_if<checked::Assign>(&loop.init->node) : nullptr;
    const auto* test = loop.condition != nullptr ? std::get_if<checked::Binary>(&loop.condition->node) : nullptr;
    const auto* step = loop.step != nullptr ? std::get_if<checked::Step>(&loop.step->node) : nullptr;
    if (init == nullptr || init->op || init->target.offset != nullptr || test == nullptr || step == nullptr || step->place.offset != nullptr)
      return std::nullopt;
    const auto number = static_cast<uint32_t>(init->target.number);
    const int32_t* first = constant_value(init->value);
    const int32_t* limit = constant_value(test->right);
    const auto* load = std::get_if<checked::Load>(&test->left->node);
    const bool own = load != nullptr && load->place.offset == nullptr && static_cast<uint32_t>(load->place.number) == number &&
                     static_cast<uint32_t>(step->place.number) == number;
    if (first == nullptr || limit == nullptr || !own || is_of_others(number)) return std::nullopt;
    Numbers changed;
    written_.add(*loop.body, changed);
    if (changed.test(number)) return std::nullopt;
    const bool up = step->delta > 0;
    int64_t last = *limit;
    if (test->op == (up ? BinaryOp::Lt : BinaryOp::Gt))
      last -= step->delta;
    else if (test->op != (up ? BinaryOp::Le : BinaryOp::Ge))
      return std::nullopt;
    if (up ? last < *first : last > *first) return std::nullopt;
    return Counter{number, *first, last};
  }

  bool is_of_others(uint32_t number) const {
    const Variable* variable = variable_of(number);
    const auto found = context_.accesses.find(number);
    if (variable == nullptr || found == context_.accesses.end() || !found->second.takers.empty() || context_.raw_names.contains(number)) return true;
    std::optional<size_t> only;
    for (const AccessPlace& writer : found->second.writers)
      for (const size_t root : roots_.of[writer.function]) {
        if (only && *only != root) return true;
        only = root;
      }
    return false;
  }

  // What each turn does.
  void always(const checked::StmtPtr& stmt) {
    if (const auto* node = std::get_if<checked::ExprStmt>(&stmt->node)) always(node->expr);
    if (const auto* node = std::get_if<checked::If>(&stmt->node)) always(node->condition);
    if (const auto* node = std::get_if<checked::While>(&stmt->node)) always(node->condition);
    if (const auto* node = std::get_if<checked::Switch>(&stmt->node)) always(node->value);
    if (const auto* node = std::get_if<checked::Block>(&stmt->node))
      for (const checked::StmtPtr& part : node->body) always(part);
  }

  void always(const ExprPtr& expr) {
    if (expr == nullptr) return;
    if (const auto* node = std::get_if<checked::Load>(&expr->node)) place(node->place, expr->span);
    if (const auto* node = std::get_if<checked::Step>(&expr->node)) place(node->place, expr->span);
    if (const auto* node = std::get_if<checked::Unary>(&expr->node)) always(node->operand);
    if (const auto* node = std::get_if<checked::Conditional>(&expr->node)) always(node->condition);
    if (const auto* node = std::get_if<checked::Assign>(&expr->node)) place(node->target, expr->span), always(node->value);
    if (const auto* node = std::get_if<checked::Comma>(&expr->node)) always(node->left), always(node->right);
    if (const auto* node = std::get_if<checked::Binary>(&expr->node)) {
      always(node->left);
      if (node->op != BinaryOp::LogicalAnd && node->op != BinaryOp::LogicalOr) always(node->right);
    }
    if (const auto* node = std::get_if<checked::SystemCall>(&expr->node))
      for (const checked::Argument& argument : node->arguments)
        if (const ExprPtr* value = std::get_if<ExprPtr>(&argument)) always(*value);
  }

  // One turn reaches an array, another one what is beside it.
  void place(const checked::Place& at, Span span) {
    always(at.offset);
    const auto line = at.offset == nullptr ? std::nullopt : line_of(at.offset, counter_.number);
    if (!line || line->factor == 0) return;
    const int64_t first = at.number + line->fixed + line->factor * counter_.first;
    const int64_t last = at.number + line->fixed + line->factor * counter_.last;
    const Variable* begins = variable_of(first);
    const Variable* ends = variable_of(last);
    const Variable* array = begins != nullptr && begins->type.count != 0 ? begins : ends;
    if (begins == ends || array == nullptr || array->type.count == 0) return;
    if (!told_.insert(span.begin.value).second) return;
    context_.diagnostics
        .report(Diag::IndexBeyond, span,
                {array->name, fmt::format("{}", array->type.count - 1), fmt::format("{}", array == begins ? counter_.last : counter_.first)})
        .notes.push_back({array->span, "declared here"});
  }

  Context& context_;
  const ProgramRoots& roots_;
  const Written& written_;
  Counter counter_{};
  std::set<uint32_t> told_;
};

}  // namespace

void check_indexes(Context& context, const ProgramRoots& roots, const Written& written) { IndexCheck(context, roots, written).run(); }

}  // namespace ipos::compiler
