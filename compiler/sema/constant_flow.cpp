// Abstract execution: a state holds a set of values for each variable that is followed; where ways meet, states are joined.
#include "compiler/sema/constant_flow.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "compiler/ast/walk.hpp"
#include "compiler/sema/expressions.hpp"
#include "compiler/sema/fold.hpp"

namespace ipos::compiler {
namespace {

using ast::Overloaded;
using checked::ExprPtr;

constexpr uint32_t kMostNodes = 300'000;  // ours: a program of 16384 words, and loops and calls several times

// No condition, or one that is always true.
bool endless(const ExprPtr& condition) {
  const int32_t* known = constant_value(condition);
  return condition == nullptr || (known != nullptr && *known != 0);
}

}  // namespace

ConstantFlow::Set ConstantFlow::at(uint32_t number) const {
  const uint32_t slot = number < slots_.size() ? slots_[number] : kNotFollowed;
  return slot < state_.values.size() ? state_.values[slot] : KnownValues::kAny;
}

// What several roots write, or others may, stays what it is.
void ConstantFlow::store(uint32_t number, Set value) {
  const uint32_t slot = number < slots_.size() ? slots_[number] : kNotFollowed;
  if (slot >= state_.values.size() || pinned_[slot] || !std::has_single_bit(writers_[slot]) || writers_[slot] >> 63 != 0) return;
  state_.values[slot] = value;
}

void ConstantFlow::forget(uint32_t number, uint32_t count) {
  feeds_ += number <= kWatchdog && kWatchdog < number + count;
  for (uint32_t n = number; n < number + count && n < slots_.size(); ++n) store(n, KnownValues::kAny);
}

// Through a pointer: only variables whose numbers are taken can be meant, and those are not known anyway.
void ConstantFlow::forget(const std::optional<NumberRange>& within) {
  if (within) forget(within->low, within->size());
}

void ConstantFlow::forget_all() {
  ++feeds_;
  for (const uint32_t number : numbers_) store(number, KnownValues::kAny);
  state_.defined.clear();
}

void ConstantFlow::join(State& into, const State& from) {
  if (!from.reached) return;
  if (!into.reached) {
    into = from;
    return;
  }
  for (size_t slot = 0; slot < into.values.size(); ++slot)
    into.values[slot] = numbers_[slot] == kWatchdog ? join_watchdog(into.values[slot], from.values[slot])
                                                    : sets_.join(into.values[slot], from.values[slot]);
  std::erase_if(into.defined, [&](const Defined& one) {
    return std::find(from.defined.begin(), from.defined.end(), one) == from.defined.end();
  });
}

void ConstantFlow::run(const Visit& visit, const VisitUnfed& unfed) {
  visit_ = &visit;
  unfed_ = &unfed;
  budget_ = kMostNodes;
  running_.assign(program_.functions.size(), false);
  for (root_ = 0; root_ < roots_.roots.size(); ++root_) {
    state_ = {true, std::vector<Set>(numbers_.size()), {}};
    for (size_t slot = 0; slot < numbers_.size(); ++slot) {
      const uint64_t own = uint64_t{1} << std::min<size_t>(root_, 63);
      const bool begins = writers_[slot] == own || (root_ == 0 && writers_[slot] == 0);
      state_.values[slot] = pinned_[slot] ? KnownValues::kAny : begins ? at_first_[slot] : all_[slot];
    }
    frames_.clear();
    call(roots_.roots[root_].function);
    if (root_ == 0) tell_unfed(at(kWatchdog), {});
  }
}

void ConstantFlow::call(size_t function) {
  if (!relevant_[function]) return;
  if (running_[function]) return forget_all();
  running_[function] = true;
  const size_t caller = std::exchange(function_, function);
  State outer = std::exchange(returns_, nowhere());
  std::vector<Frame> frames = std::exchange(frames_, {});
  const size_t exits = exits_;
  run(program_.functions[function].body);
  join(state_, returns_);
  returns_ = std::move(outer);
  frames_ = std::move(frames);
  exits_ = exits;
  function_ = caller;
  running_[function] = false;
}

void ConstantFlow::run(const checked::StmtPtr& stmt) {
  if (stmt == nullptr || budget_ == 0) return;
  const auto leave = [&](State& to) {
    join(to, state_);
    state_.reached = false;
  };
  std::visit(Overloaded{
                 [&](const checked::ExprStmt& node) { value_of(node.expr); },
                 [&](const checked::Block& node) {
                   for (const checked::StmtPtr& part : node.body) run(part);
                 },
                 [&](const checked::If& node) {
                   value_of(node.condition);
                   State before = state_;
                   run(node.then);
                   std::swap(state_, before);
                   run(node.otherwise);
                   join(state_, before);
                 },
                 [&](const checked::While& node) { loop({node.condition, nullptr, nullptr, node.body, stmt->span}); },
                 [&](const checked::DoWhile& node) { loop({nullptr, node.condition, nullptr, node.body, stmt->span}); },
                 [&](const checked::For& node) {
                   value_of(node.init);
                   loop({node.condition, nullptr, node.step, node.body, stmt->span});
                 },
                 [&](const checked::Switch& node) { choose(node); },
                 [&](const checked::CaseLabel&) {
                   for (auto frame = frames_.rbegin(); frame != frames_.rend(); ++frame)
                     if (frame->entry != nullptr) return join(state_, *frame->entry);
                 },
                 [&](const checked::Break&) { leave(frames_.back().breaks); },
                 [&](const checked::Continue&) {
                   for (auto frame = frames_.rbegin(); frame != frames_.rend(); ++frame)
                     if (frame->entry == nullptr) return leave(frame->continues);
                 },
                 [&](const checked::Return&) {
                   ++exits_;
                   leave(returns_);
                 },
             },
             stmt->node);
}

void ConstantFlow::loop(const Loop& parts) {
  State head = state_;
  const Set watchdog = at(kWatchdog);
  const size_t feeds = feeds_, exits = exits_;
  for (bool first = true;; first = false) {
    frames_.push_back({nowhere(), nowhere(), nullptr});
    value_of(parts.before);
    State left = parts.after == nullptr && !endless(parts.before) ? state_ : nowhere();
    run(parts.body);
    join(state_, frames_.back().continues);
    if (parts.after != nullptr) {
      value_of(parts.after);
      if (!endless(parts.after)) left = state_;
    }
    value_of(parts.step);
    join(left, frames_.back().breaks);
    frames_.pop_back();
    if (first && head.reached && !left.reached && feeds_ == feeds && exits_ == exits) tell_unfed(watchdog, parts.place);
    State next = head;
    join(next, state_);
    if (next == head || budget_ == 0) {
      state_ = std::move(left);
      return;
    }
    head = next;
    state_ = std::move(next);
  }
}

void ConstantFlow::choose(const checked::Switch& node) {
  value_of(node.value);
  const State entry = state_;
  frames_.push_back({nowhere(), nowhere(), &entry});
  state_.reached = false;
  run(node.body);
  join(state_, frames_.back().breaks);
  frames_.pop_back();
  if (!node.otherwise) join(state_, entry);
}

ConstantFlow::Set ConstantFlow::value_of(const checked::Assign& node, Span span) {
  value_of(node.target.offset);
  Set value = value_of(node.value);
  if (node.target.offset != nullptr) {
    forget(node.within);
    return KnownValues::kAny;
  }
  const auto number = static_cast<uint32_t>(node.target.number);
  const int32_t* constant = constant_value(node.value);
  const KnownValue* right = sets_.only(value);
  if (node.op) {
    const KnownValue* left = only(number);
    const auto result = left != nullptr && right != nullptr ? fold(*node.op, left->value, right->value) : std::nullopt;
    value = result ? sets_.of({*result, span}) : KnownValues::kAny;
  } else if (constant != nullptr || (right != nullptr && !right->assigned())) {
    value = sets_.of({right->value, span});
  }
  number == kWatchdog ? set_watchdog(value) : store(number, value);
  return value;
}

ConstantFlow::Set ConstantFlow::value_of(const ExprPtr& expr) {
  if (expr == nullptr || budget_ == 0) return KnownValues::kAny;
  --budget_;
  const auto either = [&](const State& other) { join(state_, other); };
  return std::visit(
      Overloaded{
          [&](const checked::Constant& node) { return sets_.of({node.value, expr->span}); },
          [&](const checked::Load& node) {
            value_of(node.place.offset);
            return node.place.offset == nullptr ? at(static_cast<uint32_t>(node.place.number)) : KnownValues::kAny;
          },
          [&](const checked::Unary& node) {
            const KnownValue* known = sets_.only(value_of(node.operand));
            if (known == nullptr) return KnownValues::kAny;
            const int32_t value = known->value;
            const int32_t result = node.op == checked::UnaryOp::Minus    ? *fold(ast::BinaryOp::Sub, 0, value)
                                   : node.op == checked::UnaryOp::BitNot ? ~value
                                                                         : value == 0;
            return sets_.of({result, expr->span});
          },
          [&](const checked::Step& node) {
            value_of(node.place.offset);
            const auto number = static_cast<uint32_t>(node.place.number);
            if (node.place.offset != nullptr)
              forget(node.within);
            else
              forget(number, 1);
            return KnownValues::kAny;
          },
          [&](const checked::Binary& node) {
            const Set left = value_of(node.left);
            const bool short_cut = node.op == ast::BinaryOp::LogicalAnd || node.op == ast::BinaryOp::LogicalOr;
            Set right = KnownValues::kAny;
            if (short_cut && has_effect(*node.right)) {
              const State before = state_;
              right = value_of(node.right);
              either(before);
            } else {
              right = value_of(node.right);
            }
            const KnownValue* a = sets_.only(left);
            const KnownValue* b = sets_.only(right);
            const auto result = a != nullptr && b != nullptr ? fold(node.op, a->value, b->value) : std::nullopt;
            return result ? sets_.of({*result, expr->span}) : KnownValues::kAny;
          },
          [&](const checked::Conditional& node) {
            value_of(node.condition);
            State before = state_;
            const Set then = value_of(node.then);
            std::swap(state_, before);
            const Set otherwise = value_of(node.otherwise);
            either(before);
            return sets_.join(then, otherwise);
          },
          [&](const checked::Assign& node) { return value_of(node, expr->span); },
          [&](const checked::Comma& node) {
            value_of(node.left);
            return value_of(node.right);
          },
          [&](const checked::CopyBlock& node) {
            std::vector<Set> values;
            for (uint32_t n = 0; n < node.count; ++n) values.push_back(at(node.source + n));
            for (uint32_t n = 0; n < node.count; ++n) store(node.target + n, values[n]);
            return KnownValues::kAny;
          },
          [&](const checked::Call& node) {
            call(node.function);
            return KnownValues::kAny;
          },
          [&](const checked::SystemCall& node) {
            Set last = KnownValues::kAny;
            for (const checked::Argument& argument : node.arguments)
              if (const ExprPtr* value = std::get_if<ExprPtr>(&argument)) last = value_of(*value);
            command(*expr, node, last);
            return KnownValues::kAny;
          }},
      expr->node);
}

}  // namespace ipos::compiler
