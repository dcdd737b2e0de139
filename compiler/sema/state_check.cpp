// Only globals without a fixed number are looked at, whose number nobody takes: what others may write is not known.
#include "compiler/sema/state_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "compiler/sema/command_writes.hpp"
#include "compiler/sema/expressions.hpp"
#include "compiler/sema/fold.hpp"
#include "compiler/sema/walk.hpp"
#include "compiler/sema/written.hpp"

namespace ipos::compiler {
namespace {

using checked::ExprPtr;

// What the program assigns to a variable.
struct Assigned {
  bool computed = false;  // something else than constants
  std::vector<std::pair<int32_t, Span>> constants;

  bool has(int32_t value) const {
    return std::any_of(constants.begin(), constants.end(), [&](const auto& one) { return one.first == value; });
  }
};

class StateCheck {
 public:
  StateCheck(Context& context, const ProgramRoots& roots, const Written& written)
      : context_(context), roots_(roots), written_(written), by_root_(roots.roots.size()) {
    for (const Variable& variable : context.scope.variables())
      if (variable.storage == Storage::Global)
        for (uint32_t n = variable.number; n < variable.number + variable.type.size() && n < kMaxNumbers; ++n)
          own_.set(n, n > kLastNonVolatile);
    for (const auto& [number, all] : context.accesses)
      if (number < kMaxNumbers && !all.takers.empty()) own_.reset(number);
    for (const auto& [number, span] : context.raw_names)
      if (number < kMaxNumbers) own_.reset(number);
    for (const Contents& contents : context.contents)
      for (const checked::Expr* expr : contents.calls)
        if (const auto* call = std::get_if<checked::SystemCall>(&expr->node); call != nullptr && call->opcode == vm::Opcode::Scom)
          if (const OrderBlock orders = order_block(*call); orders.result && std::get<int32_t>(call->arguments[0]) == kTransmitAcyclic)
            own_.reset(orders.first + orders.size - 1);  // its result changes when the telegram is sent
    for (size_t root = 0; root < by_root_.size(); ++root) by_root_[root] = written_.of(roots.roots[root].function);
  }

  void run() {
    const checked::Program& program = context_.program;
    for (size_t n = 0; n < program.functions.size(); ++n)
      if (roots_.alive[n])
        for (const checked::Expr* expr : context_.contents[n].expressions) collect(*expr);
    for (size_t n = 0; n < program.functions.size(); ++n) {
      if (!roots_.alive[n]) continue;
      function_ = n;
      checked::walk_statements(program.functions[n].body, [&](const checked::Stmt& stmt) {
        if (const auto* node = std::get_if<checked::While>(&stmt.node)) endless(node->condition, *node->body, nullptr);
        if (const auto* node = std::get_if<checked::DoWhile>(&stmt.node)) endless(node->condition, *node->body, nullptr);
        if (const auto* node = std::get_if<checked::For>(&stmt.node)) {
          if (!never(*node)) endless(node->condition, *node->body, node->step);
        }
        if (const auto* node = std::get_if<checked::Switch>(&stmt.node)) note_switch(*node);
      });
    }
    for (const auto& [number, cases] : switches_) check_states_of(number, cases);
  }

 private:
  struct Cases {
    std::vector<const checked::Switch*> all;
    bool otherwise = false;
  };

  void collect(const checked::Expr& expr) {
    const auto computed = [&](uint32_t number) { assigned_[number].computed = true; };
    const auto place = [&](const checked::Place& at, const std::optional<NumberRange>& within) {
      if (at.offset == nullptr) return computed(static_cast<uint32_t>(at.number));
      for (uint32_t n = within ? within->low : 1; n <= (within ? within->high : 0); ++n) computed(n);
    };
    if (const auto* node = std::get_if<checked::Step>(&expr.node)) place(node->place, node->within);
    if (const auto* node = std::get_if<checked::Assign>(&expr.node)) {
      const int32_t* constant = node->op || node->target.offset != nullptr ? nullptr : constant_value(node->value);
      if (constant == nullptr)
        place(node->target, node->within);
      else
        assigned_[static_cast<uint32_t>(node->target.number)].constants.emplace_back(*constant, expr.span);
    }
    if (const auto* node = std::get_if<checked::CopyBlock>(&expr.node))
      for (uint32_t n = 0; n < node->count; ++n) computed(node->target + n);
    if (const auto* node = std::get_if<checked::SystemCall>(&expr.node))
      written_blocks(*node, [&](uint32_t first, uint32_t count) {
        for (uint32_t n = first; n < first + count; ++n) computed(n);
      });
  }

  std::string name_of(uint32_t number) const {
    for (const Variable& variable : context_.scope.variables()) {
      if (number < variable.number || number >= variable.number + variable.type.size()) continue;
      if (variable.type.scalar()) return variable.name;
      if (variable.type.structure != nullptr && variable.type.count == 0)
        for (const StructMember& member : variable.type.structure->members)
          if (member.offset == number - variable.number)
            return fmt::format("{}.{}", variable.name, member.names.front());
      return variable.name;
    }
    return fmt::format("H{}", number);
  }

  // for (i = 10; i < 5; ...): the condition is false at first.
  bool never(const checked::For& node) {
    const auto* init = node.init != nullptr ? std::get_if<checked::Assign>(&node.init->node) : nullptr;
    const auto* test = node.condition != nullptr ? std::get_if<checked::Binary>(&node.condition->node) : nullptr;
    if (init == nullptr || init->op || init->target.offset != nullptr || test == nullptr || !is_comparison(test->op)) return false;
    const auto* load = std::get_if<checked::Load>(&test->left->node);
    const int32_t* first = constant_value(init->value);
    const int32_t* limit = constant_value(test->right);
    if (load == nullptr || first == nullptr || limit == nullptr || load->place.offset != nullptr ||
        load->place.number != init->target.number || !own_.test(static_cast<size_t>(load->place.number)))
      return false;
    if (fold(test->op, *first, *limit) != 0) return false;
    context_.diagnostics.report(Diag::LoopNeverRuns, node.condition->span,
                                {name_of(static_cast<uint32_t>(load->place.number)), fmt::format("{}", *first)});
    return true;
  }

  // Nothing that the condition reads changes while the loop runs.
  void endless(const ExprPtr& condition, const checked::Stmt& body, const ExprPtr& step) {
    if (condition == nullptr || has_effect(*condition)) return;
    Numbers read;
    bool known = true;
    checked::walk(condition, [&](const checked::Expr& expr) {
      const auto* load = std::get_if<checked::Load>(&expr.node);
      if (load == nullptr) return;
      known = known && load->place.offset == nullptr && own_.test(static_cast<size_t>(load->place.number));
      if (known) read.set(static_cast<size_t>(load->place.number));
    });
    if (!known || read.none() || leaves(body)) return;
    Numbers changed;
    written_.add(body, changed);
    if (step != nullptr) written_.add(*step, changed);
    for (size_t root = 0; root < by_root_.size(); ++root) {
      const auto& own = roots_.of[function_];
      if (own.size() != 1 || own.front() != root) changed |= by_root_[root];
    }
    if ((read & changed).any()) return;
    std::string names;
    for (uint32_t n = 0; n < kMaxNumbers; ++n) {
      if (!read.test(n)) continue;
      if (assigned_.find(n) == assigned_.end()) return;  // nobody writes it at all, which W0257 says
      names += (names.empty() ? "'" : ", '") + name_of(n) + "'";
    }
    context_.diagnostics.report(Diag::LoopNeverEnds, condition->span, {names});
  }

  // By break or return; a break of a switch or loop within does not leave.
  static bool leaves(const checked::Stmt& body) {
    if (std::holds_alternative<checked::Break>(body.node) || std::holds_alternative<checked::Return>(body.node)) return true;
    bool out = false;
    const auto inner = [&](const checked::StmtPtr& part) { out = out || (part != nullptr && leaves(*part)); };
    if (const auto* node = std::get_if<checked::Block>(&body.node))
      for (const checked::StmtPtr& part : node->body) inner(part);
    if (const auto* node = std::get_if<checked::If>(&body.node)) inner(node->then), inner(node->otherwise);
    const checked::StmtPtr own = loop_body(body);
    if (own != nullptr)
      checked::walk_statements(own, [&](const checked::Stmt& stmt) {
        out = out || std::holds_alternative<checked::Return>(stmt.node);
      });
    return out;
  }
  static checked::StmtPtr loop_body(const checked::Stmt& stmt) {
    if (const auto* node = std::get_if<checked::While>(&stmt.node)) return node->body;
    if (const auto* node = std::get_if<checked::DoWhile>(&stmt.node)) return node->body;
    if (const auto* node = std::get_if<checked::For>(&stmt.node)) return node->body;
    if (const auto* node = std::get_if<checked::Switch>(&stmt.node)) return node->body;
    return nullptr;
  }

  void note_switch(const checked::Switch& node) {
    const auto* load = std::get_if<checked::Load>(&node.value->node);
    if (load == nullptr || load->place.offset != nullptr || !own_.test(static_cast<size_t>(load->place.number))) return;
    Cases& cases = switches_[static_cast<uint32_t>(load->place.number)];
    cases.all.push_back(&node);
    cases.otherwise = cases.otherwise || node.otherwise.has_value();
  }

  void check_states_of(uint32_t number, const Cases& cases) {
    const Assigned& assigned = assigned_[number];
    if (assigned.computed || assigned.constants.empty()) return;
    for (const checked::Switch* node : cases.all)
      for (const auto& [value, label] : node->cases)
        if (value != 0 && !assigned.has(value))
          context_.diagnostics.report(Diag::CaseNeverAssigned, place_of(*node, label),
                                      {name_of(number), fmt::format("{}", value)});
    if (cases.otherwise) return;
    std::vector<int32_t> told;
    for (const auto& [value, span] : assigned.constants) {
      const bool handled = std::any_of(cases.all.begin(), cases.all.end(), [&, wanted = value](const checked::Switch* node) {
        return std::any_of(node->cases.begin(), node->cases.end(), [&](const auto& row) { return row.first == wanted; });
      });
      if (handled || std::find(told.begin(), told.end(), value) != told.end()) continue;
      told.push_back(value);
      context_.diagnostics.report(Diag::StateWithoutCase, span, {name_of(number), fmt::format("{}", value)});
    }
  }

  // Of a label, which is a statement of the switch's own, not of one within it.
  static Span place_of(const checked::Switch& node, size_t label) {
    Span found{};
    const auto look = [&](const auto& self, const checked::StmtPtr& stmt) -> void {
      if (stmt == nullptr) return;
      if (const auto* own = std::get_if<checked::CaseLabel>(&stmt->node); own != nullptr && own->label == label) found = stmt->span;
      if (const auto* part = std::get_if<checked::Block>(&stmt->node))
        for (const checked::StmtPtr& inner : part->body) self(self, inner);
      if (const auto* part = std::get_if<checked::If>(&stmt->node)) self(self, part->then), self(self, part->otherwise);
      if (!std::holds_alternative<checked::Switch>(stmt->node)) self(self, loop_body(*stmt));
    };
    look(look, node.body);
    return found;
  }

  Context& context_;
  const ProgramRoots& roots_;
  const Written& written_;
  std::vector<Numbers> by_root_;
  Numbers own_;  // globals that only the program's own text writes
  std::map<uint32_t, Assigned> assigned_;
  std::map<uint32_t, Cases> switches_;
  size_t function_ = 0;
};

}  // namespace

void check_states(Context& context, const ProgramRoots& roots, const Written& written) {
  StateCheck(context, roots, written).run();
}

}  // namespace ipos::compiler
